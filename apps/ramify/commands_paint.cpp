// SPDX-License-Identifier: GPL-3.0-or-later
// The verb that draws skeletons: paint.
#include <memory>

#include "commands.h"
#include "outputs.h"
#include "presets.h"
#include "ramify/paint/palette.h"
#include "ramify/recipe/painting.h"
#include "ramify/skeleton/skeleton_io.h"

namespace ramify::app {
namespace {

const std::vector<std::string> kPaintings{".svg", ".png", ".jpg", ".jpeg", ".tif", ".tiff", ".exr", ".webp"};

struct PaintArguments {
  PaintingRequest request;
  FieldFlags flags;
  std::string output, preset;
};

std::vector<Preset> presets() {
  std::vector<Preset> out;
  for (const PaintPreset& preset : paint_presets()) out.push_back({preset.name, preset.about, preset.options});
  return out;
}

std::string palette_names() {
  std::string line = "palettes:  ";
  for (const Palette& palette : named_palettes()) line += " " + palette.name;
  return line + "\n";
}

// A photo below takes the place of the preset's paper.
void apply(const CLI::App& app, PaintArguments& a) {
  if (a.preset.empty()) return;
  std::vector<OptionField> fields = describe(a.request.options);
  if (!a.request.over.empty()) std::erase_if(fields, [](const OptionField& field) { return field.name == "background"; });
  apply_preset(presets(), a.preset, app, std::move(fields));
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
  const std::string kind = extension_of(a.output);
  for (const char* name : {"fps", "hold"}) {
    if (is_given(app, name) && kind != ".webp") throw OptionError(name, "", "has no effect on numbered frames; write a .webp");
  }
}

Outcome paint_frames(const LoadedPainting& painting, const std::string& output, bool no_clobber, const Monitor& monitor) {
  Outcome outcome;
  const PaintingOptions& options = painting.request.options;
  for (int i = 0; i < options.frames; ++i) {
    monitor.report(static_cast<double>(i) / options.frames);
    const std::string path = numbered(output, i);
    check_outputs({path}, painting.files);
    if (no_clobber && file_exists(path)) {
      outcome.skipped.push_back(path);
      continue;
    }
    save_painting(painting, growth_of_frame(options, i), path, monitor);
    outcome.outputs.push_back(path);
  }
  return outcome;
}

Outcome paint(PaintArguments& a, const SharedOptions& shared, const Monitor& monitor) {
  if (a.preset == "list") return {{}, {}, preset_list(presets(), shared.json) + (shared.json ? "" : palette_names())};
  check_extension("output", a.output, kPaintings);
  a.request.limits = shared.load_limits();
  check_painting(a.request, a.output);
  std::vector<std::string> inputs{a.request.skeleton};
  if (!a.request.over.empty()) inputs.push_back(a.request.over);
  check_outputs({a.output}, inputs);
  const bool frames = a.request.options.animate && extension_of(a.output) != ".webp";
  if (!frames && shared.no_clobber && file_exists(a.output)) return {{}, {a.output}, ""};
  const LoadedPainting painting = load_painting(a.request, shared.seed, monitor.stage("load", 0.0, 0.3));
  if (!shared.debug_dir.empty()) {
    make_folder(shared.debug_dir);
    save_painting(painting, 1.0, shared.debug_dir + "/painting.svg", monitor);
  }
  const Monitor part = monitor.stage("paint", 0.3, 1.0);
  if (frames) return paint_frames(painting, a.output, shared.no_clobber, part);
  if (a.request.options.animate) save_animation(painting, a.output, part);
  else save_painting(painting, a.request.options.growth, a.output, part);
  return {{a.output}, {}, ""};
}

}  // namespace

void add_paint(CLI::App& root, Chosen& chosen) {
  const auto a = std::make_shared<PaintArguments>();
  CLI::App* app = root.add_subcommand("paint", "Draw a skeleton: ink, vine, lightning; SVG, picture or animation");
  app->add_option("skeleton", a->request.skeleton, "Skeleton (.json .swc .svg) or annotation (.ramify.json)");
  app->add_option("-o,--output", a->output, "Drawing or picture to write (.svg .png .jpg .tif .exr .webp)")->type_name("FILE");
  app->add_option("--preset", a->preset, "Settings that go well together; list shows them all")->type_name("NAME|list");
  app->add_option("--over", a->request.over, "Paint on this photo; light is added to it")->type_name("IMAGE");
  const std::vector<OptionField> all = describe(a->request.options), style = describe(a->request.options.paint);
  a->flags.add(*app, style, "Style");
  a->flags.add(*app, std::vector<OptionField>(all.begin() + static_cast<std::ptrdiff_t>(style.size()), all.end()), "Output");
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

}  // namespace ramify::app
