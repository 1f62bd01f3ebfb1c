// SPDX-License-Identifier: GPL-3.0-or-later
// The verbs that look at things: compare, convert, info.
#include <algorithm>
#include <memory>

#include "commands.h"
#include "outputs.h"
#include "ramify/core/atomic_file.h"
#include "ramify/core/json.h"
#include "ramify/core/version.h"
#include "ramify/exemplar/annotation.h"
#include "ramify/image/image_io.h"
#include "ramify/recipe/comparison.h"
#include "ramify/recipe/exemplar_source.h"
#include "ramify/recipe/recipe.h"
#include "ramify/skeleton/branches.h"
#include "ramify/skeleton/skeleton_io.h"
#include "ramify/style/style.h"

namespace ramify::app {
namespace {

bool is_picture_file(const std::string& path) {
  const std::string text = read_file(path, std::size_t{1} << 31);
  return text.find('\0') != std::string::npos;  // every picture format here is binary, every other input is text
}

Json size_json(Size size) { return Json::Array{size.width, size.height}; }

Json skeleton_facts(const Skeleton& skeleton) {
  const BranchTree tree = branch_tree(skeleton);
  double length = 0.0, radius = 0.0, low = 0.0, high = 0.0;
  int roots = 0, order = 0;
  for (const Branch& branch : tree.branches) {
    length += branch.length;
    roots += branch.parent == kNone;
    order = std::max(order, branch.order);
  }
  for (const Node& node : skeleton.nodes()) {
    radius += node.radius / skeleton.count();
    low = low == 0.0 ? node.radius : std::min(low, node.radius);
    high = std::max(high, node.radius);
  }
  return Json::Object{{"canvas_px", size_json(skeleton.size)},
                      {"nodes", skeleton.count()},
                      {"branches", static_cast<int>(tree.branches.size())},
                      {"roots", roots},
                      {"highest_order", order},
                      {"loop_links", static_cast<int>(skeleton.loop_links.size())},
                      {"length_px", length},
                      {"furcations_per_1000_px", length > 0 ? 1000.0 * (static_cast<int>(tree.branches.size()) - roots) / length : 0.0},
                      {"radius_mean_px", radius},
                      {"radius_range_px", Json::Array{low, high}}};
}

Json style_facts(const Skeleton& skeleton, const Monitor& monitor) {
  const Style style = learn_style(skeleton, LearnStyleOptions{}, monitor);
  return Json::Object{{"feature_size_px", style.feature_size}, {"step_px", style.step},
                      {"extension_m", style.bending.extension}, {"history_k", style.bending.history},
                      {"branch_spacing_px", style.hierarchy.spacing},
                      {"furcations_seen", style.furcation.positives}, {"furcation_auc", style.furcation.auc}};
}

Json annotation_facts(const Annotation& annotation, const std::string& kind, const Monitor& monitor) {
  const Skeleton skeleton = skeleton_from_annotation(annotation);
  Json::Object facts{{"kind", kind}, {"photo", annotation.photo_file}, {"photo_sha256", annotation.photo_sha256},
                     {"regions", static_cast<int>(annotation.regions.size())}, {"skeleton", skeleton_facts(skeleton)}};
  try {
    facts.push_back({"style", style_facts(skeleton, monitor)});
  } catch (const InputError& error) {
    facts.push_back({"style", std::string(error.what())});
  }
  return facts;
}

Json builtin_facts(const std::string& argument, const Monitor& monitor) {
  ExemplarRequest request;
  request.argument = argument;
  const Exemplar exemplar = load_exemplar(request, monitor).exemplar;
  return annotation_facts(exemplar.annotation, "built-in exemplar", monitor);
}

Json picture_facts(const std::string& path, const LoadLimits& limits, const Monitor& monitor) {
  const LoadedImage image = load_image(path, limits);
  for (const std::string& warning : image.warnings) monitor.note(warning);
  Json::Object facts{{"kind", "picture"}, {"size_px", size_json(image.color.size())}, {"bits", image.bits},
                     {"alpha", !image.alpha.empty()}, {"sha256", image.sha256}};
  const auto text = image.texts.find("ramify-recipe");
  if (text != image.texts.end()) {
    const Recipe recipe = parse_recipe(text->second, path);
    Json::Array inputs;
    for (const RecipeInput& input : recipe.inputs) inputs.push_back(input.role + ": " + input.file);
    facts.push_back({"recipe", Json::Object{{"version", recipe.version}, {"verb", recipe.verb},
                                            {"seed", std::to_string(recipe.seed)}, {"inputs", inputs}}});
  }
  return facts;
}

Json limit_facts() {
  const LoadLimits limits;
  return Json::Object{{"version", RAMIFY_VERSION}, {"pixels", limits.pixels},
                      {"picture_file_bytes", static_cast<double>(limits.file_bytes)},
                      {"skeleton_file_bytes", static_cast<double>(kSkeletonFileLimit)}, {"json_depth", JsonLimits{}.depth}};
}

// JSON members as "name: value" lines, objects indented.
void print_lines(const Json::Object& object, const std::string& indent, std::string& out) {
  for (const JsonMember& member : object) {
    const auto* inner = std::get_if<Json::Object>(&member.value.value);
    const auto* text = std::get_if<std::string>(&member.value.value);
    out += indent + member.key + ":" + (inner ? "\n" : " " + (text ? printable(*text, 400) : json_text(member.value)));
    if (inner) print_lines(*inner, indent + "  ", out);
    else if (out.back() != '\n') out += "\n";
  }
}

std::string facts_text(const Json& facts, bool json) {
  if (json) return json_text(facts) + "\n";
  std::string out;
  print_lines(std::get<Json::Object>(facts.value), "", out);
  return out;
}

}  // namespace

void add_info(CLI::App& root, Chosen& chosen) {
  struct Arguments {
    std::string input;
    bool limits = false;
  };
  const auto a = std::make_shared<Arguments>();
  CLI::App* app = root.add_subcommand("info", "What is in a picture, annotation, skeleton or built-in exemplar; limits; version");
  app->add_option("input", a->input, "Picture, annotation, skeleton or builtin:KIND");
  app->add_flag("--limits", a->limits, "Show the limits instead");
  add_shared(*app, chosen.shared);
  app->footer("Examples:\n  ramify info river.ramify.json\n  ramify info out.png --json");
  app->callback([&chosen, a] {
    if (a->input.empty() && !a->limits) throw CLI::RequiredError("input");
    chosen.work = [&chosen, a](const Monitor& monitor) {
      check_outputs(chosen.shared, {}, {a->input});
      Json facts;
      if (a->limits) facts = limit_facts();
      else if (is_builtin(a->input)) facts = builtin_facts(a->input, monitor);
      else if (is_picture_file(a->input)) facts = picture_facts(a->input, chosen.shared.load_limits(), monitor);
      else if (is_annotation_file(a->input)) facts = annotation_facts(load_annotation(a->input), "annotation", monitor);
      else {
        LoadedSkeleton loaded = load_skeleton(a->input);
        for (const std::string& note : loaded.notes) monitor.note(note);
        facts = Json::Object{{"kind", "skeleton"}, {"skeleton", skeleton_facts(loaded.skeleton)}};
      }
      return Outcome{{}, {}, facts_text(facts, chosen.shared.json)};
    };
  });
}

void add_convert(CLI::App& root, Chosen& chosen) {
  struct Arguments {
    std::string input, output;
  };
  const auto a = std::make_shared<Arguments>();
  CLI::App* app = root.add_subcommand("convert", "Skeletons, annotations and pictures from one format to another");
  app->add_option("input", a->input, "Skeleton (.json .swc .svg), annotation (.ramify.json) or picture")->required();
  app->add_option("-o,--output", a->output, "File to write; the ending says the format")->required()->type_name("FILE");
  add_shared(*app, chosen.shared);
  app->footer("Examples:\n  ramify convert neuron.swc -o neuron.svg\n  ramify convert river.ramify.json -o river.swc\n"
              "  ramify convert photo.tif -o photo.png");
  app->callback([&chosen, a] {
    chosen.work = [&chosen, a](const Monitor& monitor) {
      check_outputs(chosen.shared, {a->output}, {a->input});
      if (chosen.shared.no_clobber && file_exists(a->output)) return Outcome{{}, {a->output}, ""};
      if (is_picture_file(a->input)) {
        check_image_name(a->output);
        const LoadedImage image = load_image(a->input, chosen.shared.load_limits());
        for (const std::string& warning : image.warnings) monitor.note(warning);
        SaveOptions save;
        save.bits = fitting_bits(a->output, image.bits);
        if (image.alpha.empty()) save_image(a->output, image.color, save);
        else save_image(a->output, image.color, image.alpha, save);
      } else {
        if (has_extension(a->output, kPictureExtensions)) {
          throw InputError(printable(a->input, 300), "is no picture; skeletons and annotations become .json, .swc, .svg or .geojson");
        }
        check_skeleton_name(a->output);
        const LoadedSkeleton loaded = load_any_skeleton(a->input);
        for (const std::string& note : loaded.notes) monitor.note(note);
        save_skeleton(loaded.skeleton, a->output);
      }
      return Outcome{{a->output}, {}, ""};
    };
  });
}

void add_compare(CLI::App& root, Chosen& chosen) {
  const auto request = std::make_shared<ComparisonRequest>();
  const auto output = std::make_shared<std::string>();
  CLI::App* app = root.add_subcommand("compare", "How alike two are: histograms on top of each other, figures of quality");
  app->add_option("first", request->first, "Exemplar, picture with recipe, or skeleton (the measure)")->required();
  app->add_option("second", request->second, "Exemplar, picture with recipe, or skeleton (what is judged)")->required();
  app->add_option("-o,--output", *output, "Report to write (.html .svg .json)")->required()->type_name("FILE");
  app->add_option("--inputs", request->inputs, "Folder that holds the inputs of a picture's recipe, found there by content; "
                  "may be given again")->type_name("FOLDER")->expected(1)->take_all();
  add_shared(*app, chosen.shared);
  app->footer("Examples:\n  ramify compare river.ramify.json new.png -o report.html\n"
              "  ramify compare neuron.swc grown.swc -o histograms.svg");
  app->callback([&chosen, request, output] {
    chosen.work = [&chosen, request, output](const Monitor& monitor) {
      check_extension("output", *output, {".html", ".svg", ".json"});
      check_outputs(chosen.shared, {*output}, {request->first, request->second});
      if (chosen.shared.no_clobber && file_exists(*output)) return Outcome{{}, {*output}, ""};
      request->limits = chosen.shared.load_limits();
      write_file(*output, comparison_text(*request, *output, monitor));
      return Outcome{{*output}, {}, ""};
    };
  });
}

}  // namespace ramify::app
