// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/paint/paint.h"

#include <algorithm>
#include <set>

#include "ramify/paint/palette.h"
#include "ramify/paint/styles.h"

namespace ramify {
namespace {

constexpr double kRipening = 0.35;  // share of the whole way over which a branch reaches its width

std::string own_palette(PaintStyle style) {
  switch (style) {
    case PaintStyle::Ink: return "black";
    case PaintStyle::Vine: return "spring";
    case PaintStyle::Lightning: return "electric";
    case PaintStyle::Woodcut: return "black";
    case PaintStyle::Watercolor: return "umber";
  }
  return "black";
}

}  // namespace

std::vector<OptionField> describe(PaintOptions& o) {
  return {choice("style", o.style, {"ink", "vine", "lightning", "woodcut", "watercolor"}, "How the skeleton is drawn."),
          text("palette", o.palette, "A palette's name or colours such as #1d3557,#a8dadc, from the trunk outwards; vine: stem, then leaves; "
               "lightning: core to haze; photo = the darkest tones of --over; empty = the style's own."),
          text("background", o.background, "A colour such as #ffffff, or none = transparent."),
          number("width", o.stroke.width, 0.05, 50, "", "Factor on all widths."),
          number("taper", o.stroke.taper, 0, 1, "", "0 = blunt tips, 1 = long fine points."),
          number("smooth", o.stroke.smoothing, 0, 100, "px", "Smooths the lines, standard deviation along them."),
          number("flow", o.stroke.flow, 0, 1, "", "0 = side branches start where the skeleton says, 1 = they leave along their parent."),
          number("tolerance", o.tolerance, 0.01, 10, "px", "How far curves may lie from the outline; larger = fewer nodes."),
          choice("leaf", o.leaf, {"ovate", "lance", "heart", "ivy", "oak", "round"}, "Shape of the leaves."),
          number("leaf-size", o.foliage.size, 0, 10000, "px", "Length of a leaf; 0 = from the space between branches."),
          number("leaf-density", o.foliage.density, 0, 5, "", "How close leaves stand; 0 = none."),
          choice("phyllotaxis", o.foliage.phyllotaxis, {"alternate", "spiral", "opposite"}, "How leaves follow each other along a branch."),
          number("flowers", o.foliage.flowers, 0, 1, "", "Share of the tips that bear a flower."),
          text("flower-color", o.flower_color, "Colour of the petals."),
          number("tendrils", o.foliage.tendrils, 0, 1, "", "Share of the tips that end in a tendril."),
          number("glow", o.glow, 0, 5, "", "Strength of the light around lightning."),
          number("hatching", o.hatching, 0, 1, "", "Lines of the ground around a woodcut; 0 = none."),
          number("pale", o.pale, 0, 1, "", "How far what stands --behind fades into the ground."),
          number("rim", o.rim, 0, 100, "px", "Ground left around what stands before something --behind.")};
}

bool has_effect(PaintStyle style, const std::string& option) {
  static const std::set<std::string> vine{"leaf", "leaf-size", "leaf-density", "phyllotaxis", "flowers", "flower-color", "tendrils"};
  if (vine.count(option) > 0) return style == PaintStyle::Vine;
  if (option == "hatching") return style == PaintStyle::Woodcut;
  if (option == "pale" || option == "rim") return style != PaintStyle::Lightning;
  return option != "glow" || style == PaintStyle::Lightning;
}

PaintScene prepare_painting(const Skeleton& skeleton, const PaintOptions& options, const Rng& rng, const Monitor& monitor,
                            const Mask& shape) {
  if (skeleton.empty()) throw InputError("", "the skeleton has no nodes: there is nothing to paint");
  PaintScene scene;
  scene.size = skeleton.size;
  scene.options = options;
  scene.colors = parse_palette("palette", options.palette.empty() ? own_palette(options.style) : options.palette);
  if (options.background != "none") scene.background = parse_color("background", options.background);
  parse_color("flower-color", options.flower_color);
  scene.seed = rng.child("style").next();
  monitor.check();
  scene.strokes = make_strokes(skeleton, options.stroke);
  monitor.report(0.5);
  scene.reach = growth_reach(scene.strokes);
  if (options.style == PaintStyle::Vine) scene.foliage = place_foliage(scene.strokes, scene.size, options.foliage, rng.child("foliage"), shape);
  for (const Stroke& tendril : scene.foliage.tendrils) scene.reach = std::max(scene.reach, tendril.births.back());
  return scene;
}

namespace {

// The scene's strokes at a moment of its growth, and how far growth has come, px.
struct Moment {
  std::vector<Stroke> strokes;
  double front = 1e30;
};

Moment moment_of(const PaintScene& scene, double growth) {
  if (growth >= 1.0) return {scene.strokes};
  // The front runs on beyond the last tip until the tips have ripened too.
  const double late = std::max(kRipening * scene.reach, 5.0 * scene.foliage.leaf_size);
  const double front = growth * (scene.reach + late);
  return {grown_strokes(scene.strokes, front, kRipening * scene.reach), front};
}

std::vector<Layer> layers_of(const PaintScene& scene, const Moment& moment, const Monitor& monitor) {
  switch (scene.options.style) {
    case PaintStyle::Ink: return ink_layers(scene, moment.strokes, monitor);
    case PaintStyle::Vine: return vine_layers(scene, moment.strokes, moment.front, monitor);
    case PaintStyle::Lightning: return lightning_layers(scene, moment.strokes, monitor);
    case PaintStyle::Woodcut: return woodcut_layers(scene, moment.strokes, monitor);
    case PaintStyle::Watercolor: return watercolor_layers(scene, moment.strokes, monitor);
  }
  return {};
}

// Ground around the strokes, which cuts them out of what stands behind.
Layer rim_layer(const PaintScene& scene, const Moment& moment, const Rgb& color) {
  Layer out;
  out.name = "rim";
  for (const Stroke& stroke : moment.strokes) {
    Shape shape = stroke_shape(stroke, color, scene.options.tolerance, scene.options.rim);
    if (!shape.loops.empty()) out.shapes.push_back(std::move(shape));
  }
  return out;
}

}  // namespace

Drawing draw_painting(const PaintScene& scene, double growth, const Monitor& monitor) {
  Drawing drawing;
  drawing.size = scene.size;
  drawing.background = scene.background;
  const Rgb ground = scene.background.value_or(Rgb{1.0f, 1.0f, 1.0f});
  const auto add = [&](const PaintScene& part, double pale, const std::string& prefix) {
    const Moment moment = moment_of(part, growth);
    std::vector<Layer> layers = layers_of(part, moment, monitor);
    const bool first = drawing.layers.empty();
    if (!first && part.options.style == PaintStyle::Woodcut) std::erase_if(layers, [](const Layer& layer) { return layer.name == "ground"; });
    if (!first && part.options.rim > 0.0) layers.insert(layers.begin(), rim_layer(part, moment, ground));
    for (Layer& layer : layers) {
      layer.name = prefix + layer.name;
      for (Shape& shape : layer.shapes) shape.color = mix(shape.color, ground, pale);
      drawing.layers.push_back(std::move(layer));
    }
  };
  const auto count = static_cast<double>(scene.behind.size());
  for (std::size_t i = 0; i < scene.behind.size(); ++i) {
    add(scene.behind[i], scene.options.pale * (count - static_cast<double>(i)) / count, "behind " + std::to_string(i + 1) + " ");
  }
  add(scene, 0.0, "");
  return drawing;
}

}  // namespace ramify
