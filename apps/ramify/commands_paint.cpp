// SPDX-License-Identifier: GPL-3.0-or-later
// The verbs that draw: paint (skeletons) and figure (trees that fill a shape).
#include <algorithm>
#include <memory>

#include "commands.h"
#include "outputs.h"
#include "presets.h"
#include "ramify/paint/palette.h"
#include "ramify/recipe/figure.h"
#include "ramify/recipe/painting.h"
#include "ramify/skeleton/skeleton_io.h"

namespace ramify::app {
namespace {

const std::vector<std::string> kFigureSkeletons{".json", ".swc", ".geojson"};
const std::vector<std::string> kPaintings{".svg", ".png", ".jpg", ".jpeg", ".tif", ".tiff", ".exr", ".webp"};

struct PaintArguments {
  PaintingRequest request;
  FieldFlags flags;
  std::string output, preset;
};

struct FigureArguments : PaintArguments {
  FigureRequest figure;  // its painting is `request`
  std::string skeleton_file;
};

std::string palette_names() {
  std::string line = "palettes:  ";
  for (const Palette& palette : named_palettes()) line += " " + palette.name;
  return line + "\n";
}

Outcome list_presets(bool json) {
  return {{}, {}, preset_list(paint_presets(), json) + (json ? "" : palette_names())};
}

// A photo below takes the place of the preset's paper; what `kept` names stays as it is.
void apply(const CLI::App& app, PaintArguments& a, std::vector<std::string> kept = {}) {
  if (a.preset.empty()) return;
  std::vector<OptionField> fields = describe(a.request.options);
  if (!a.request.over.empty()) kept.push_back("background");
  std::erase_if(fields, [&](const OptionField& field) { return std::find(kept.begin(), kept.end(), field.name) != kept.end(); });
  apply_preset(paint_presets(), a.preset, app, std::move(fields));
}

bool is_given(const CLI::App& app, const std::string& name) {
  const CLI::Option* option = app.get_option_no_throw("--" + name);
  return option && option->count() > 0;
}

void check_effects(const CLI::App& app, PaintArguments& a) {
  PaintingOptions& o = a.request.options;
  std::string style;
  for (const OptionField& field : describe(o.paint)) {
    if (field.name == "style") style = get_text(field);
    if (is_given(app, field.name) && !has_effect(o.paint.style, field.name)) {
      throw OptionError(field.name, get_text(field), "has no effect on --style " + style);
    }
  }
  for (const char* name : {"frames", "fps", "hold"}) {
    if (is_given(app, name) && !o.animate) throw OptionError(name, "", "has no effect without --animate");
  }
  for (const char* name : {"pale", "rim"}) {
    if (is_given(app, name) && a.request.behind.empty()) throw OptionError(name, "", "has no effect without --behind");
  }
  const std::string kind = extension_of(a.output);
  for (const char* name : {"fps", "hold"}) {
    if (is_given(app, name) && kind != ".webp") throw OptionError(name, "", "has no effect on numbered frames; write a .webp");
  }
}

Outcome paint_frames(const LoadedPainting& painting, const std::string& output, const SharedOptions& shared,
                     const Monitor& monitor) {
  Outcome outcome;
  const PaintingOptions& options = painting.request.options;
  for (int i = 0; i < options.frames; ++i) {
    monitor.report(static_cast<double>(i) / options.frames);
    const std::string path = numbered(output, i);
    check_outputs(shared, {path}, painting.files);
    if (shared.no_clobber && file_exists(path)) {
      outcome.skipped.push_back(path);
      continue;
    }
    save_painting(painting, growth_of_frame(options, i), path, monitor);
    outcome.outputs.push_back(path);
  }
  return outcome;
}

bool makes_frames(const PaintArguments& a) { return a.request.options.animate && extension_of(a.output) != ".webp"; }

Outcome save(const PaintArguments& a, const LoadedPainting& painting, const SharedOptions& shared, const Monitor& monitor) {
  if (!shared.debug_dir.empty()) save_painting(painting, 1.0, shared.debug_dir + "/painting.svg", monitor);
  if (makes_frames(a)) return paint_frames(painting, a.output, shared, monitor);
  if (a.request.options.animate) save_animation(painting, a.output, monitor);
  else save_painting(painting, a.request.options.growth, a.output, monitor);
  return {{a.output}, {}, ""};
}

Outcome paint(PaintArguments& a, const SharedOptions& shared, const Monitor& monitor) {
  if (a.preset == "list") return list_presets(shared.json);
  check_extension("output", a.output, kPaintings);
  a.request.limits = shared.load_limits();
  check_painting(a.request, a.output);
  std::vector<std::string> inputs{a.request.skeleton};
  inputs.insert(inputs.end(), a.request.behind.begin(), a.request.behind.end());
  for (const std::string& picture : {a.request.over, a.request.fill}) {
    if (!picture.empty()) inputs.push_back(picture);
  }
  check_outputs(shared, {a.output}, inputs);
  if (!makes_frames(a) && shared.no_clobber && file_exists(a.output)) return {{}, {a.output}, ""};
  if (!shared.debug_dir.empty()) make_folder(shared.debug_dir);
  const LoadedPainting painting = load_painting(a.request, shared.seed, monitor.stage("load", 0.0, 0.3));
  return save(a, painting, shared, monitor.stage("paint", 0.3, 1.0));
}

bool is_figure_skeleton(const std::string& path) {
  return std::find(kFigureSkeletons.begin(), kFigureSkeletons.end(), extension_of(path)) != kFigureSkeletons.end();
}

void check_figure_effects(const CLI::App& app, FigureArguments& a) {
  const auto refuse = [&](const std::string& name, const std::string& why) {
    if (is_given(app, name)) throw OptionError(name, "", "has no effect " + why);
  };
  const FigureOptionsAll& o = a.figure.options;
  if (is_given(app, "text") && !a.figure.bitmap.empty()) throw OptionError("text", "", "has no effect beside a bitmap; give one of them");
  for (const char* name : {"font", "text-size", "baseline"}) {
    if (!a.figure.bitmap.empty()) refuse(name, "on a bitmap");
  }
  if (a.figure.bitmap.empty()) refuse("invert", "on text");
  if (o.figure.cells == FigureCellKind::Geodesic) refuse("border-points", "on --cells geodesic");
  if (o.figure.join == FigureJoin::Apart) refuse("bridge", "without --join bridges");
  if (o.figure.lines == FigureLines::Straight) refuse("curl", "on --lines straight");
  if (!is_figure_skeleton(a.output)) return;
  for (const OptionField& field : describe(a.request.options)) refuse(field.name, "on a skeleton; write a picture or .svg");
  for (const char* name : {"preset", "over", "fill", "skeleton"}) refuse(name, "on a skeleton; write a picture or .svg");
}

Outcome figure(FigureArguments& a, const SharedOptions& shared, const Monitor& monitor) {
  if (a.preset == "list") return list_presets(shared.json);
  std::vector<std::string> kinds = kPaintings;
  kinds.insert(kinds.end(), kFigureSkeletons.begin(), kFigureSkeletons.end());
  check_extension("output", a.output, kinds);
  if (!a.skeleton_file.empty()) check_skeleton_name(a.skeleton_file);
  const bool skeleton = is_figure_skeleton(a.output);
  a.request.limits = shared.load_limits();
  check_options(describe(a.figure.options));
  if (!skeleton) check_painting(a.request, a.output);
  a.figure.painting = a.request;
  std::vector<std::string> inputs, outputs{a.output};
  for (const std::string& input : {a.figure.bitmap, a.request.over, a.request.fill}) {
    if (!input.empty()) inputs.push_back(input);
  }
  if (!a.skeleton_file.empty()) outputs.push_back(a.skeleton_file);
  check_outputs(shared, outputs, inputs);
  if (!makes_frames(a) && shared.no_clobber && std::all_of(outputs.begin(), outputs.end(), file_exists)) return {{}, outputs, ""};
  const LoadedFigure loaded = load_figure(a.figure, shared.seed, monitor.stage("figure", 0.0, 0.6));
  check_outputs(shared, outputs, loaded.files);
  if (!shared.debug_dir.empty()) {
    make_folder(shared.debug_dir);
    save_figure_intermediates(loaded.figure, shared.debug_dir);
  }
  if (skeleton) {
    save_skeleton(loaded.figure.skeleton, a.output);
    return {{a.output}, {}, ""};
  }
  const Monitor part = monitor.stage("paint", 0.6, 1.0);
  Outcome outcome = save(a, paint_figure(a.figure, loaded, part), shared, part);
  if (!a.skeleton_file.empty()) {
    save_skeleton(loaded.figure.skeleton, a.skeleton_file);
    outcome.outputs.push_back(a.skeleton_file);
  }
  return outcome;
}

void add_painting_options(CLI::App& app, PaintArguments& a) {
  app.add_option("--preset", a.preset, "Settings that go well together; list shows them all")->type_name("NAME|list");
  app.add_option("--over", a.request.over, "Paint on this photo; light is added to it")->type_name("IMAGE");
  app.add_option("--fill", a.request.fill, "Picture of the canvas that shows in the branches, such as one by ramify render")->type_name("IMAGE");
  const std::vector<OptionField> all = describe(a.request.options), style = describe(a.request.options.paint);
  a.flags.add(app, style, "Style");
  a.flags.add(app, std::vector<OptionField>(all.begin() + static_cast<std::ptrdiff_t>(style.size()), all.end()), "Output");
}

}  // namespace

void add_paint(CLI::App& root, Chosen& chosen) {
  const auto a = std::make_shared<PaintArguments>();
  CLI::App* app = root.add_subcommand("paint", "Draw a skeleton: ink, vine, lightning; SVG, picture or animation");
  app->add_option("skeleton", a->request.skeleton, "Skeleton (.json .swc .svg) or annotation (.ramify.json)");
  app->add_option("-o,--output", a->output, "Drawing or picture to write (.svg .png .jpg .tif .exr .webp)")->type_name("FILE");
  app->add_option("--behind", a->request.behind, "Skeletons on the same canvas that stand behind, the farthest first")->type_name("FILE…");
  add_painting_options(*app, *a);
  add_shared(*app, chosen.shared);
  app->footer("Examples:\n  ramify paint tree.json --preset ivy -o ivy.svg\n"
              "  ramify paint bolt.swc --style lightning --over night.jpg -o night_bolt.png\n"
              "  ramify paint roots.ramify.json --preset sepia --scale 4 --depth 16 -o print.png\n"
              "  ramify paint tree.json --preset blossom --animate --frames 90 -o growing.webp\n"
              "  ramify paint --preset list");
  app->callback([&chosen, a, app] {
    if (a->preset != "list") {
      if (a->request.skeleton.empty()) throw CLI::RequiredError("skeleton");
      if (a->output.empty()) throw CLI::RequiredError("--output");
      apply(*app, *a);
      check_effects(*app, *a);
    }
    chosen.work = [&chosen, a](const Monitor& m) { return paint(*a, chosen.shared, m); };
  });
}

void add_figure(CLI::App& root, Chosen& chosen) {
  const auto a = std::make_shared<FigureArguments>();
  a->request.options = figure_painting();
  CLI::App* app = root.add_subcommand("figure", "Grow a tree that fills a shape or a text; SVG, picture, animation or skeleton");
  app->add_option("bitmap", a->figure.bitmap, "Picture whose black is filled; or --text");
  app->add_option("-o,--output", a->output, "Drawing or picture (.svg .png .jpg .tif .exr .webp), or skeleton (.json .swc .geojson)")
      ->type_name("FILE");
  app->add_option("--skeleton", a->skeleton_file, "Also write the skeleton (.json .swc .svg .geojson)")->type_name("FILE");
  a->flags.add(*app, describe(a->figure.options), "Figure");
  add_painting_options(*app, *a);
  add_shared(*app, chosen.shared);
  app->footer("Examples:\n  ramify figure --text Bridges -o bridges.svg\n"
              "  ramify figure horse.png --points 4000 --preset vine -o horse.png\n"
              "  ramify figure --text \"Wood\\nWind\" --baseline --join bridges --animate -o wood.webp\n"
              "  ramify figure heart.png -o heart.json && ramify render builtin:lightning heart.json -o heart_bolt.png");
  app->callback([&chosen, a, app] {
    if (a->preset != "list") {
      if (a->figure.bitmap.empty() && !is_given(*app, "text")) throw CLI::RequiredError("a bitmap or --text");
      if (a->output.empty()) throw CLI::RequiredError("--output");
      apply(*app, *a, {"smooth", "flow"});
      check_figure_effects(*app, *a);
      check_effects(*app, *a);
    }
    chosen.work = [&chosen, a](const Monitor& m) { return figure(*a, chosen.shared, m); };
  });
}

}  // namespace ramify::app
