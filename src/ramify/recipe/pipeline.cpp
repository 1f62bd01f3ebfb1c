// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/recipe/pipeline.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <sstream>

#include "ramify/compose/placement.h"
#include "ramify/core/atomic_file.h"
#include "ramify/core/parallel.h"
#include "ramify/core/version.h"
#include "ramify/geometry/polyline.h"
#include "ramify/geometry/svg_path.h"
#include "ramify/growth/restyle.h"
#include "ramify/image/filter.h"
#include "ramify/image/image_io.h"
#include "ramify/image/sample.h"
#include "ramify/paint/drawing.h"
#include "ramify/recipe/canvas.h"
#include "ramify/skeleton/skeleton_io.h"

namespace ramify {
namespace fs = std::filesystem;
namespace {

// "x,y[,direction_deg[,radius]] …"
std::vector<GrowthRoot> parse_roots(const std::string& text) {
  std::vector<GrowthRoot> roots;
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    std::vector<double> values;
    std::istringstream parts(word);
    for (std::string part; std::getline(parts, part, ',');) {
      double value = 0.0;
      if (!parse_number(part, value)) values.clear(), values.resize(9);
      values.push_back(value);
    }
    if (values.size() < 2 || values.size() > 4 || (values.size() == 4 && values[3] <= 0.0)) {
      throw OptionError("roots", "'" + printable(word, 60) + "'", "expected x,y or x,y,direction_deg or x,y,direction_deg,radius in px");
    }
    GrowthRoot root;
    root.position = Vec2(values[0], values[1]);
    if (values.size() > 2) root.direction = wrap_angle(values[2] * kPi / 180.0);
    if (values.size() > 3) root.radius = values[3];
    roots.push_back(root);
  }
  return roots;
}

std::string hash_of(const std::string& path) { return sha256_hex(read_file(path, std::size_t{1} << 30)); }

void add_input(LoadedRequest& loaded, const std::string& role, const std::string& path) {
  loaded.inputs.push_back({role, fs::path(path).filename().string(), hash_of(path)});
  loaded.files.push_back(path);
}

ScalarImage load_map(const std::string& path, Size size, const LoadLimits& limits, const Monitor& monitor) {
  const ScalarImage map = load_scalar(path, limits);
  if (map.size() == size) return map;
  monitor.note(printable(path) + ": resized from " + std::to_string(map.width()) + "x" + std::to_string(map.height()) + " to the canvas");
  return resize(map, size);
}

// The paths of a drawing, on the canvas.
std::vector<std::vector<Vec2>> load_guide_paths(const std::string& path, Size canvas, const Monitor& monitor) {
  const SvgDrawing drawing = parse_svg(read_file(path, 64u << 20), printable(path, 300));
  std::vector<std::vector<Vec2>> paths;
  for (const SvgPath& candidate : drawing.paths) {
    if (candidate.points.size() >= 2) paths.push_back(candidate.points);
  }
  if (paths.empty()) throw InputError(printable(path, 300), "holds no path to follow");
  if (drawing.size.width > 0 && drawing.size != canvas) {
    monitor.note(printable(path) + ": scaled from its viewBox of " + std::to_string(drawing.size.width) + "x" +
                 std::to_string(drawing.size.height) + " to the canvas");
    const Vec2 scale(static_cast<double>(canvas.width) / drawing.size.width, static_cast<double>(canvas.height) / drawing.size.height);
    for (std::vector<Vec2>& points : paths) {
      for (Vec2& p : points) p = p.cwiseProduct(scale);
    }
  }
  return paths;
}

void load_guides(LoadedRequest& loaded, const Monitor& monitor) {
  const PictureRequest& request = loaded.request;
  GrowthTarget& target = loaded.target;
  if (!request.density.empty()) {
    target.density = load_map(request.density, target.size, request.limits, monitor);
    for (const float value : target.density.pixels()) {
      if (!std::isfinite(value)) throw InputError(printable(request.density, 300), "holds values that are not numbers");
    }
    const auto white = [](float v) { return v > 8.0f / 255.0f; };
    if (std::none_of(target.density.pixels().begin(), target.density.pixels().end(), white)) {
      throw InputError(printable(request.density, 300), "is all black: there is nothing to grow; paint white where branches shall be");
    }
    add_input(loaded, "density", request.density);
  }
  if (request.guide.empty()) return;
  if (fs::path(request.guide).extension() == ".svg") {
    target.guide_paths = load_guide_paths(request.guide, target.size, monitor);
  } else {
    target.guide_map = load_map(request.guide, target.size, request.limits, monitor);
  }
  add_input(loaded, "guide", request.guide);
}

// A mirrored ground is grown on unmirrored, as the style was learnt, and the result is mirrored.
template <class T>
Image<T> mirrored(const Image<T>& image) {
  Image<T> out(image.size());
  for (int y = 0; y < image.height(); ++y) std::reverse_copy(image.row(y), image.row(y) + image.width(), out.row(y));
  return out;
}

GrowthTarget mirrored(const GrowthTarget& target) {
  const double right = target.size.width - 1.0;
  GrowthTarget out = target;
  for (GrowthRoot& root : out.roots) {
    root.position.x() = right - root.position.x();
    if (root.direction) root.direction = wrap_angle(kPi - *root.direction);
  }
  for (std::vector<Vec2>& path : out.guide_paths) {
    for (Vec2& p : path) p.x() = right - p.x();
  }
  out.density = mirrored(target.density);
  out.guide_map = mirrored(target.guide_map);
  out.outside = mirrored(target.outside);
  out.obstacles = mirrored(target.obstacles);
  return out;
}

Skeleton mirrored(Skeleton skeleton) {
  for (int i = 0; i < skeleton.count(); ++i) {
    Vec3 p = skeleton[i].position;
    p.x() = skeleton.size.width - 1.0 - p.x();
    skeleton.set_position(i, p);
  }
  return skeleton;
}

// Growth leaves what lies outside the habitat, and what is kept as it is, like the frame: of the photo, 255.
Mask no_habitat(const Habitat& habitat) {
  Mask map = habitat.outside;
  for (std::size_t i = 0; i < map.pixels().size(); ++i) {
    if (habitat.role.pixels()[i] == static_cast<std::uint8_t>(RegionRole::Keep)) map.pixels()[i] = 255;
  }
  return map;
}

// Which nodes lie on a landmark, and which where the habitat ends. A landmark is touched by a
// branch's rim; a border is met a little before it: annotations stop short of a field's rim.
std::vector<NodePlace> node_places(const Skeleton& skeleton, const Habitat& habitat) {
  std::vector<NodePlace> places(static_cast<std::size_t>(skeleton.count()), NodePlace::Ground);
  const ScalarImage to_border = distance_to(habitat.outside);
  Mask landmark(habitat.role.size(), 0);
  for (std::size_t i = 0; i < landmark.pixels().size(); ++i) {
    if (habitat.role.pixels()[i] == static_cast<std::uint8_t>(RegionRole::Landmark)) landmark.pixels()[i] = 255;
  }
  const ScalarImage to_landmark = distance_to(landmark);
  constexpr double kShort = 8.0;  // px
  for (int i = 0; i < skeleton.count(); ++i) {
    const int x = static_cast<int>(std::lround(skeleton[i].xy().x())), y = static_cast<int>(std::lround(skeleton[i].xy().y()));
    if (to_landmark.clamped(x, y) <= skeleton[i].radius) {
      places[static_cast<std::size_t>(i)] = NodePlace::Landmark;
    } else if (to_border.clamped(x, y) <= skeleton[i].radius + kShort) {
      places[static_cast<std::size_t>(i)] = NodePlace::Border;
    }
  }
  return places;
}

// Where the photo lies on the canvas as growth sees it: never mirrored.
std::optional<KeptGround> kept_ground(const BackgroundPlan& plan, int photo_width) {
  if (plan.mode == BackgroundMode::New) return std::nullopt;
  KeptGround kept{plan.scale, plan.shift};
  if (plan.flipped) kept.shift.x() = plan.canvas.width - 1.0 - plan.shift.x() - plan.scale * (photo_width - 1.0);
  return kept;
}

bool has_habitat(const Habitat& habitat, const BackgroundPlan& plan) {
  return !habitat.role.empty() && plan.mode != BackgroundMode::New;
}

// A painted map means what it shows: the photo is moved to where its habitat lies under the paint.
void move_under_paint(BackgroundPlan& plan, const LoadedRequest& loaded, const Monitor& monitor) {
  if (loaded.target.density.empty() || loaded.skeleton || !has_habitat(loaded.scene.habitat, plan)) return;
  const double lost = move_under(plan, no_habitat(loaded.scene.habitat), loaded.target.density);
  if (lost < 0.02) return;
  monitor.note(
      number_text(std::round(100.0 * lost)) +
      " % of what is painted lies where the photo has no branches (below a skyline, beyond a rim) and stays empty");
}

Skeleton grow_on_plan(const LoadedRequest& loaded, const BackgroundPlan& plan, const Rng& rng, const Monitor& monitor) {
  GrowthTarget target = loaded.target;
  if (has_habitat(loaded.scene.habitat, plan)) target.outside = on_canvas(no_habitat(loaded.scene.habitat), plan);
  target.kept = kept_ground(plan, loaded.source.exemplar.photo.color.width());
  const GrowOptions& options = loaded.request.options.grow;
  if (!plan.flipped) return grow_from_style(loaded.style, target, options, rng, monitor);
  return mirrored(grow_from_style(loaded.style, mirrored(target), options, rng, monitor));
}

Recipe make_recipe(const LoadedRequest& loaded, std::uint64_t seed) {
  StageOptions options = loaded.request.options;
  return {RAMIFY_VERSION, loaded.request.verb, seed, loaded.inputs, option_values(describe(options))};
}

}  // namespace

std::vector<OptionField> describe(StageOptions& options) {
  std::vector<OptionField> fields{text("size", options.size, "Canvas, WIDTHxHEIGHT in px."),
                                  text("roots", options.roots, "Where branches start."),
                                  number("depth", options.depth, 0, 32, "bits", "Bits a channel.")};
  for (const auto& part : {describe(options.learn), describe(options.grow), describe(options.fit), describe(options.compose)}) {
    fields.insert(fields.end(), part.begin(), part.end());
  }
  return fields;
}

void check_request(PictureRequest& request) {
  check_options(describe(request.options));
  if (!request.options.size.empty()) check_canvas(parse_canvas(request.options.size), request.limits);
  parse_roots(request.options.roots);
  check_fit(request.options.fit);
  for (const std::string& path : {request.skeleton, request.density, request.guide, request.exemplar.regions}) {
    if (!path.empty() && !fs::exists(path)) throw InputError(printable(path, 300), "no such file");
  }
  const int depth = request.options.depth;
  if (depth != 0 && depth != 8 && depth != 16 && depth != 32) {
    throw OptionError("depth", std::to_string(depth), "expected 8, 16 or 32");
  }
}

LoadedRequest load_request(const PictureRequest& request, const Monitor& monitor) {
  const CancelScope scope(monitor);
  LoadedRequest loaded;
  loaded.request = request;
  check_request(loaded.request);
  loaded.source = load_exemplar(request.exemplar, monitor.stage("exemplar", 0.0, 0.2));
  loaded.inputs = loaded.source.inputs;
  loaded.files = loaded.source.files;
  Size size = loaded.source.exemplar.photo.color.size();
  if (!request.skeleton.empty()) {
    LoadedSkeleton file = load_skeleton(request.skeleton);
    for (const std::string& note : file.notes) monitor.note(note);
    loaded.skeleton = std::move(file.skeleton);
    if (loaded.skeleton->size.width > 0) size = loaded.skeleton->size;
    add_input(loaded, "skeleton", request.skeleton);
  }
  if (!request.options.size.empty()) size = parse_canvas(request.options.size);
  if (loaded.skeleton) {
    loaded.skeleton->size = size;
    if (loaded.skeleton->empty()) throw InputError(printable(request.skeleton, 300), "holds no branch to render");
    const bool held = !request.options.size.empty();
    loaded.skeleton = fit_skeleton(std::move(*loaded.skeleton), loaded.source.exemplar.skeleton, request.options.fit, held, monitor);
    size = loaded.skeleton->size;
  }
  check_canvas(size, request.limits);
  loaded.target.size = size;
  loaded.target.roots = parse_roots(request.options.roots);
  load_guides(loaded, monitor);
  const Exemplar& exemplar = loaded.source.exemplar;
  if (request.verb == "grow") {
    loaded.scene.habitat = find_habitat(exemplar, HabitatOptions{}, Rng(0).child("scene").child("habitat"), monitor.stage("habitat", 0.2, 0.9));
  } else {
    loaded.scene = prepare_scene(exemplar, loaded.request.options.compose, monitor.stage("scene", 0.2, 0.9));
  }
  if (!loaded.skeleton || request.options.fit.restyle > 0.0) {
    loaded.style = learn_style(exemplar.skeleton, request.options.learn, monitor.stage("learn", 0.9, 1.0),
                               node_places(exemplar.skeleton, loaded.scene.habitat));
  }
  return loaded;
}

Picture make_picture(const LoadedRequest& loaded, std::uint64_t seed, const Monitor& monitor) {
  const CancelScope scope(monitor);
  const StageOptions& options = loaded.request.options;
  const Exemplar& exemplar = loaded.source.exemplar;
  const bool picture_wanted = loaded.request.verb != "grow";
  const Rng rng(seed);
  BackgroundPlan plan;
  plan.canvas = loaded.target.size;
  if (picture_wanted) {
    plan = plan_scene_background(exemplar, loaded.scene, loaded.target.size, options.compose, rng.child("plan"));
  }
  move_under_paint(plan, loaded, monitor);
  Picture picture;
  picture.recipe = make_recipe(loaded, seed);
  if (loaded.skeleton) {
    picture.skeleton = restyle_skeleton(*loaded.skeleton, loaded.style, options.fit.restyle, rng.child("restyle"), monitor.stage("restyle", 0.0, 0.1));
  } else {
    picture.skeleton = grow_on_plan(loaded, plan, rng.child("grow"), monitor.stage("grow", 0.0, 0.1));
  }
  // What is told and masked is what is drawn: widths are fitted here, not in the compositor.
  if (picture_wanted && !loaded.skeleton) picture.skeleton = match_radii(picture.skeleton, loaded.scene.library);
  if (picture_wanted) {
    picture.composite = compose_image(exemplar, loaded.scene, plan, picture.skeleton, options.compose, rng.child("compose"),
                                      monitor.stage("compose", 0.1, 0.95));
  }
  return picture;
}

Recipe load_recipe(const std::string& path, const LoadLimits& limits) {
  if (is_json_file(path)) return parse_recipe(read_file(path, 1u << 24), printable(path, 300));
  const std::string bytes = read_file(path, limits.file_bytes);
  if (bytes.starts_with("<?xml") && !recipe_of_svg(bytes).empty()) return parse_recipe(recipe_of_svg(bytes), printable(path, 300));
  const LoadedImage image = load_image(path, limits);
  const auto text = image.texts.find("ramify-recipe");
  if (text != image.texts.end()) return parse_recipe(text->second, printable(path, 300));
  const std::string beside = path + ".recipe.json";
  if (fs::exists(beside)) return parse_recipe(read_file(beside, 1u << 24), printable(beside, 300));
  throw InputError(printable(path, 300), "holds no ramify recipe: it was not made by ramify, or another program saved it since");
}

PictureRequest request_from_recipe(const Recipe& recipe, const std::vector<std::string>& folders) {
  PictureRequest request;
  request.verb = recipe.verb;
  for (OptionField& field : describe(request.options)) {
    const auto value = recipe.options.find(field.name);
    if (value != recipe.options.end()) set_text(field, value->second);
  }
  for (const RecipeInput& input : recipe.inputs) {
    const std::string path = find_input(input, folders);
    if (input.role == "exemplar") request.exemplar.argument = path;
    if (input.role == "photo") {
      request.exemplar.photo = path;
      request.exemplar.allow_other_photo = true;  // the recipe says which photo was used, whatever the annotation says
    }
    if (input.role == "annotation") request.exemplar.annotation = path;
    if (input.role == "regions") request.exemplar.regions = path;
    if (input.role == "density") request.density = path;
    if (input.role == "guide") request.guide = path;
    if (input.role == "skeleton") request.skeleton = path;
  }
  return request;
}

LoadedRequest load_recipe_request(const Recipe& recipe, const std::vector<std::string>& folders, const LoadLimits& limits,
                                  const Monitor& monitor) {
  PictureRequest request = request_from_recipe(recipe, folders);
  request.limits = request.exemplar.limits = limits;
  LoadedRequest loaded = load_request(request, monitor);
  loaded.inputs = recipe.inputs;
  return loaded;
}

}  // namespace ramify
