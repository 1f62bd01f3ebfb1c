// SPDX-License-Identifier: GPL-3.0-or-later
// The verbs that make pictures and skeletons: synth, grow, render, replay.
#include <algorithm>
#include <memory>

#include "commands.h"
#include "outputs.h"
#include "progress.h"
#include "ramify/core/version.h"
#include "ramify/image/image_io.h"
#include "ramify/recipe/figure.h"
#include "ramify/recipe/moss.h"
#include "ramify/recipe/outputs.h"
#include "ramify/recipe/painting.h"
#include "ramify/recipe/pipeline.h"
#include "ramify/recipe/recipe.h"

namespace ramify::app {
namespace {

const std::vector<std::string> kReplayed{".png", ".jpg", ".jpeg", ".tif", ".tiff", ".exr", ".webp", ".svg"};
const std::vector<std::string> kSkeletons{".json", ".swc", ".svg", ".geojson"};

// Everything the three verbs can be told; each shows only what has an effect on it.
struct PictureArguments {
  PictureRequest request;
  FieldFlags flags;
  int count = 1;
  std::string output, skeleton_file, mask_file, radius_file, report_file;
};

void add_exemplar_options(CLI::App& app, PictureArguments& a) {
  app.add_option("exemplar", a.request.exemplar.argument, "NAME.ramify.json, builtin:KIND, or a photo with --annotation")
      ->required();
  app.add_option("--annotation", a.request.exemplar.annotation,
                 "Annotation or skeleton of the photo (.json, .swc), or auto to trace it")->type_name("FILE|auto");
  app.add_option("--regions", a.request.exemplar.regions,
                 "Grey map of the photo: 0 ignore, 64 outside, 128 keep, 192 landmark, 255 habitat")->type_name("PNG");
}

void add_growth_options(CLI::App& app, PictureArguments& a) {
  app.add_option("--density", a.request.density, "Painted map: white is grown and filled, black never entered")
      ->type_name("IMAGE");
  app.add_option("--guide", a.request.guide, "Courses that main branches follow: paths (.svg; a path that starts on another forks from it) or white on black")
      ->type_name("SVG|IMAGE");
  std::vector<OptionField> fields = describe(a.request.options.learn);
  for (OptionField& field : describe(a.request.options.grow)) fields.push_back(field);
  fields.push_back(text("roots", a.request.options.roots, "Where branches start: \"x,y[,direction_deg[,radius]] …\" in px."));
  a.flags.add(app, fields, "Structure");
}

void add_count(CLI::App& app, PictureArguments& a) {
  std::vector<OptionField> fields{number("count", a.count, 1, 100000, "N", "How many; picture i has seed S+i and a number in its name.")};
  a.flags.add(app, fields, "Output");
}

void add_picture_options(CLI::App& app, PictureArguments& a) {
  a.flags.add(app, describe(a.request.options.compose), "Picture");
  a.flags.add(app, {number("depth", a.request.options.depth, 0, 32, "bits", "8, 16 or 32 bits a channel; 0 = the photo's.")}, "Output");
  app.add_option("--mask", a.mask_file, "Also write the exact branch mask (.png)")->type_name("FILE")->group("Output");
  app.add_option("--radius-map", a.radius_file, "Also write the 16-bit radius map, 1/256 px (.png)")->type_name("FILE")->group("Output");
  app.add_option("--report", a.report_file, "Also write a report beside the exemplar (.html)")->type_name("FILE")->group("Output");
}

std::vector<std::string> all_outputs(const PictureArguments& a) {
  std::vector<std::string> out;
  for (const std::string* path : {&a.output, &a.skeleton_file, &a.mask_file, &a.radius_file, &a.report_file}) {
    if (!path->empty()) out.push_back(*path);
  }
  return out;
}

void check_names(const PictureArguments& a, const std::vector<std::string>& main_kinds) {
  check_extension("output", a.output, main_kinds);
  const int depth = a.request.options.depth;
  if ((depth == 8 || depth == 16 || depth == 32) && fitting_bits(a.output, depth) != depth) {
    throw OptionError("depth", std::to_string(depth), extension_of(a.output) + " pictures have " + std::to_string(fitting_bits(a.output, depth)) +
                      " bits; choose that depth or another format");
  }
  if (!a.skeleton_file.empty()) check_extension("skeleton", a.skeleton_file, kSkeletons);
  if (!a.mask_file.empty()) check_extension("mask", a.mask_file, {".png"});
  if (!a.radius_file.empty()) check_extension("radius-map", a.radius_file, {".png"});
  if (!a.report_file.empty()) check_extension("report", a.report_file, {".html"});
}

Outcome make_all(PictureArguments& a, const SharedOptions& shared, const std::string& verb,
                 const std::vector<std::string>& main_kinds, const Monitor& monitor) {
  check_names(a, main_kinds);
  a.request.verb = verb;
  a.request.limits = shared.load_limits();
  a.request.exemplar.allow_other_photo = shared.allow_other_photo;
  a.request.exemplar.limits = shared.load_limits();
  check_request(a.request);
  const auto named = [&](int i) {
    PictureArguments one = a;
    for (std::string* path : {&one.output, &one.skeleton_file, &one.mask_file, &one.radius_file, &one.report_file}) {
      if (!path->empty() && a.count > 1) *path = numbered(*path, i);
    }
    return one;
  };
  check_outputs(shared, all_outputs(named(0)), {});
  if (!shared.debug_dir.empty()) make_folder(shared.debug_dir);
  const LoadedRequest loaded = load_request(a.request, monitor.stage("load", 0.0, a.count == 1 ? 0.3 : 0.3 / a.count));
  Outcome outcome;
  for (int i = 0; i < a.count; ++i) {
    const PictureArguments one = named(i);
    const std::string debug_folder = shared.debug_dir.empty() || a.count == 1 ? shared.debug_dir : numbered(shared.debug_dir, i);
    const PictureFiles files{one.output, one.skeleton_file, one.mask_file, one.radius_file, one.report_file, debug_folder};
    const std::vector<std::string> outputs = all_outputs(one);
    check_outputs(shared, outputs, loaded.files);
    if (shared.no_clobber && std::all_of(outputs.begin(), outputs.end(), file_exists)) {
      outcome.skipped.insert(outcome.skipped.end(), outputs.begin(), outputs.end());
      continue;
    }
    if (!files.debug_folder.empty()) make_folder(files.debug_folder);
    const double start = a.count == 1 ? 0.3 : 0.3 / a.count;  // what is prepared once weighs less the more pictures
    const double from = start + (1.0 - start) * i / a.count, to = start + (1.0 - start) * (i + 1) / a.count;
    const Monitor part = a.count == 1 ? monitor.stage(verb, from, to) : monitor.stage(verb + " " + std::to_string(i + 1) + "/" + std::to_string(a.count), from, to);
    const Picture picture = make_picture(loaded, shared.seed + static_cast<std::uint64_t>(i), part);
    save_picture(loaded, picture, files, part);
    outcome.outputs.insert(outcome.outputs.end(), outputs.begin(), outputs.end());
  }
  return outcome;
}

// A painting as its recipe says, moving or not.
Outcome save_again(const LoadedPainting& painting, const std::string& output, const Monitor& monitor) {
  const PaintingOptions& options = painting.request.options;
  if (options.animate) save_animation(painting, output, monitor);
  else save_painting(painting, options.growth, output, monitor);
  return {{output}, {}, ""};
}

void check_replayed(PaintingRequest& request, const std::string& output, const SharedOptions& shared) {
  request.limits = shared.load_limits();
  check_painting(request, output);
  if (request.options.animate && extension_of(output) != ".webp") {
    throw OptionError("output", "'" + printable(output, 200) + "'", "the recipe is an animation's; the name must end in .webp");
  }
}

Outcome replay_painting(const Recipe& recipe, const std::vector<std::string>& folders, const std::string& output,
                        const SharedOptions& shared, const Monitor& monitor) {
  PaintingRequest request = painting_from_recipe(recipe, folders);
  check_replayed(request, output, shared);
  const LoadedPainting painting = load_painting(request, recipe.seed, monitor.stage("load", 0.0, 0.3));
  check_outputs(shared, {output}, painting.files);
  return save_again(painting, output, monitor.stage("paint", 0.3, 1.0));
}

Outcome replay_figure(const Recipe& recipe, const std::vector<std::string>& folders, const std::string& output, const SharedOptions& shared,
                      const Monitor& monitor) {
  FigureRequest request = figure_from_recipe(recipe, folders);
  check_replayed(request.painting, output, shared);
  const LoadedFigure figure = load_figure(request, recipe.seed, monitor.stage("figure", 0.0, 0.6));
  check_outputs(shared, {output}, figure.files);
  const Monitor part = monitor.stage("paint", 0.6, 1.0);
  return save_again(paint_figure(request, figure, part), output, part);
}

}  // namespace

void add_synth(CLI::App& root, Chosen& chosen) {
  const auto a = std::make_shared<PictureArguments>();
  CLI::App* app = root.add_subcommand("synth", "Make new photographs: learn, grow, render in one go");
  add_exemplar_options(*app, *a);
  app->add_option("-o,--output", a->output, "Picture to write (.png .jpg .tif .exr .webp)")->required()->type_name("FILE");
  a->flags.add(*app, {text("size", a->request.options.size, "Canvas WIDTHxHEIGHT in px; larger means more picture [the exemplar's]")}, "Output");
  add_count(*app, *a);
  app->add_option("--skeleton", a->skeleton_file, "Also write the skeleton (.json .swc .svg .geojson)")->type_name("FILE")->group("Output");
  add_picture_options(*app, *a);
  add_growth_options(*app, *a);
  add_shared(*app, chosen.shared);
  app->footer("Examples:\n  ramify synth builtin:lightning -o bolt.png\n"
              "  ramify synth river.ramify.json --seed 7 --count 9 -o delta.png --mask delta_mask.png\n"
              "  ramify synth photo.jpg --annotation auto --density letter.png -o letters.png");
  app->callback([&chosen, a] {
    chosen.work = [&chosen, a](const Monitor& m) { return make_all(*a, chosen.shared, "synth", kPictureExtensions, m); };
  });
}

void add_grow(CLI::App& root, Chosen& chosen) {
  const auto a = std::make_shared<PictureArguments>();
  CLI::App* app = root.add_subcommand("grow", "Grow new skeletons in the exemplar's style, without a picture");
  add_exemplar_options(*app, *a);
  app->add_option("-o,--output", a->output, "Skeleton to write (.json .swc .svg .geojson)")->required()->type_name("FILE");
  a->flags.add(*app, {text("size", a->request.options.size, "Canvas WIDTHxHEIGHT in px [the exemplar's]")}, "Output");
  add_count(*app, *a);
  add_growth_options(*app, *a);
  add_shared(*app, chosen.shared);
  app->footer("Examples:\n  ramify grow builtin:river --seed 3 -o river.svg\n"
              "  ramify grow river.ramify.json --guide course.svg -o guided.swc");
  app->callback([&chosen, a] {
    chosen.work = [&chosen, a](const Monitor& m) { return make_all(*a, chosen.shared, "grow", kSkeletons, m); };
  });
}

void add_render(CLI::App& root, Chosen& chosen) {
  const auto a = std::make_shared<PictureArguments>();
  CLI::App* app = root.add_subcommand("render", "Dress any skeleton with any exemplar's fragments");
  add_exemplar_options(*app, *a);
  app->add_option("skeleton", a->request.skeleton, "Skeleton to render (.json .swc .svg)")->required();
  app->add_option("-o,--output", a->output, "Picture to write (.png .jpg .tif .exr .webp)")->required()->type_name("FILE");
  a->flags.add(*app, {text("size", a->request.options.size, "Canvas WIDTHxHEIGHT in px [the skeleton's, scaled]")}, "Output");
  a->flags.add(*app, describe(a->request.options.fit), "Fitting the skeleton to the photo");
  add_count(*app, *a);
  app->add_option("--fitted", a->skeleton_file, "Also write the skeleton as it was rendered (.json .swc .svg .geojson)")->type_name("FILE")->group("Output");
  add_picture_options(*app, *a);
  add_shared(*app, chosen.shared);
  app->footer("Examples:\n  ramify render builtin:lightning river.swc -o lightning_river.png\n"
              "  ramify figure --text Storm -o storm.json && ramify render builtin:lightning storm.json --restyle 0.6 -o storm.png\n"
              "  ramify render crack.ramify.json grown.json --background new -o crack.png");
  app->callback([&chosen, a] {
    chosen.work = [&chosen, a](const Monitor& m) { return make_all(*a, chosen.shared, "render", kPictureExtensions, m); };
  });
}

void add_replay(CLI::App& root, Chosen& chosen) {
  struct Arguments {
    std::string input, output;
    std::vector<std::string> inputs;
    bool any_version = false;
  };
  const auto a = std::make_shared<Arguments>();
  CLI::App* app = root.add_subcommand("replay", "Make a picture again from the recipe inside it: the same bytes");
  app->add_option("input", a->input, "A picture made by ramify, its OUT.recipe.json, or a recipe")->required();
  app->add_option("-o,--output", a->output, "Picture to write")->required()->type_name("FILE");
  app->add_option("--inputs", a->inputs, "Folder that holds the inputs of the recipe, found there by content; may be given again "
                  "[the recipe's own folder, then RAMIFY_PHOTOS]")->type_name("FOLDER")->expected(1)->take_all();
  app->add_flag("--any-version", a->any_version, "Go on although another version made it");
  add_shared(*app, chosen.shared);
  app->footer("Example:\n  ramify replay out.png -o again.png && cmp out.png again.png");
  app->callback([&chosen, a] {
    chosen.work = [&chosen, a](const Monitor& monitor) {
      check_extension("output", a->output, kReplayed);
      const SharedOptions& shared = chosen.shared;
      check_outputs(shared, {a->output}, {a->input});
      if (shared.no_clobber && file_exists(a->output)) return Outcome{{}, {a->output}, ""};
      const Recipe recipe = load_recipe(a->input, shared.load_limits());
      if (recipe.version != RAMIFY_VERSION && !a->any_version) {
        throw InputError(printable(a->input, 300), "was made by ramify " + printable(recipe.version, 40) + ", this is " RAMIFY_VERSION
                         "; the bytes may differ, --any-version goes on all the same");
      }
      std::vector<std::string> folders{folder_of(a->input)};
      folders.insert(folders.end(), a->inputs.begin(), a->inputs.end());
      if (recipe.verb == "moss") {
        MossRequest request = moss_from_recipe(recipe, folders);
        request.limits = shared.load_limits();
        check_outputs(shared, {a->output}, {request.picture});
        paint_moss(request, recipe.seed, a->output, monitor);
        return Outcome{{a->output}, {}, ""};
      }
      if (recipe.verb == "figure") return replay_figure(recipe, folders, a->output, shared, monitor);
      if (recipe.verb == "paint") return replay_painting(recipe, folders, a->output, shared, monitor);
      check_extension("output", a->output, kPictureExtensions);
      const LoadedRequest loaded = load_recipe_request(recipe, folders, shared.load_limits(), monitor.stage("load", 0.0, 0.3));
      check_outputs(shared, {a->output}, loaded.files);
      const Picture picture = make_picture(loaded, recipe.seed, monitor.stage(recipe.verb, 0.3, 1.0));
      save_picture(loaded, picture, {a->output, "", "", "", "", ""}, monitor);
      return Outcome{{a->output}, {}, ""};
    };
  });
}

}  // namespace ramify::app
