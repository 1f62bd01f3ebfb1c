// SPDX-License-Identifier: GPL-3.0-or-later
// A bright core in air that glows: light falls off over about ten core widths (PICTURES 4), weak branches glow less.
#include <algorithm>
#include <cmath>

#include "ramify/paint/palette.h"
#include "ramify/paint/styles.h"

namespace ramify {
namespace {

struct Ring {
  const char* name;
  double factor, grow;  // radius of what is blurred: factor * radius + grow * main radius
  double blur;          // main radii
  double strength;
  double color;         // along the palette
};

// From the sky's haze to the core.
constexpr Ring kRings[] = {{"haze", 1.0, 9.0, 11.0, 0.05, 1.0},
                           {"glow", 1.2, 2.6, 3.4, 0.12, 0.85},
                           {"corona", 1.3, 0.35, 0.8, 0.4, 0.5},
                           {"core", 1.0, 0.0, 0.0, 1.0, 0.0}};

// The radius of a main channel: nine tenths of the structure are thinner. What is thicker still, such as knots in a
// traced photo, is drawn hardly thicker, as light has no mass.
double main_radius(const PaintScene& scene) {
  std::vector<double> radii;
  for (const Stroke& stroke : scene.strokes) radii.insert(radii.end(), stroke.radii.begin(), stroke.radii.end());
  const auto at = radii.begin() + static_cast<std::ptrdiff_t>(9 * radii.size() / 10);
  std::nth_element(radii.begin(), at, radii.end());
  return std::max({0.8, *at, 0.0012 * std::hypot(scene.size.width, scene.size.height)});
}

double core_radius(double radius, double main) { return radius < main ? radius : main * (1.0 + 0.25 * std::log(radius / main)); }

}  // namespace

std::vector<Layer> lightning_layers(const PaintScene& scene, const std::vector<Stroke>& strokes, const Monitor& monitor) {
  const double main = main_radius(scene);
  std::vector<Layer> layers;
  for (const Ring& ring : kRings) {
    const bool core = ring.blur == 0.0;
    if (!core && scene.options.glow <= 0.0) continue;
    Layer layer{ring.name, {}, Blend::Add, ring.blur * main};
    for (std::size_t s = 0; s < strokes.size(); ++s) {
      monitor.check();
      if (strokes[s].points.empty()) continue;
      const std::vector<double>& radii = scene.strokes[s].radii;
      const double bright = std::clamp(std::pow(radii[radii.size() / 3] / main, 0.8), 0.1, 1.0);
      Stroke stroke = strokes[s];
      for (double& radius : stroke.radii) radius = ring.factor * core_radius(radius, main);
      Shape shape = stroke_shape(stroke, color_along(scene.colors, ring.color), scene.options.tolerance * (core ? 1.0 : 4.0),
                                 ring.grow * main * (0.25 + 0.75 * bright));
      shape.opacity = std::min(1.0, ring.strength * (core ? 0.35 + 0.65 * bright : bright * scene.options.glow));
      if (!shape.loops.empty()) layer.shapes.push_back(std::move(shape));
    }
    layers.push_back(std::move(layer));
  }
  return layers;
}

}  // namespace ramify
