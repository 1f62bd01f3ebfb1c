// SPDX-License-Identifier: GPL-3.0-or-later
// Washes over each other: water that ran out of the strokes, pale and wide; the strokes; their shaded side once more.
// Each is one wet layer, so branches that overlap within it run together; layers darken each other as glazes do. What
// water does to pigment is made where pixels are (wash.h).
#include <algorithm>
#include <cmath>

#include "ramify/core/random.h"
#include "ramify/geometry/polyline.h"
#include "ramify/paint/palette.h"
#include "ramify/paint/styles.h"

namespace ramify {
namespace {

constexpr double kSwell = 0.22;        // share of the radius by which water spreads and draws back
constexpr double kWave = 7.0;          // px or radii, whichever is more, from swell to swell
constexpr double kRun = 110.0;         // px from where water runs out to where it does not
constexpr double kThick = 2.2;         // px, radius from which a branch gets the second wash

// Smooth noise along a line, -1..1: values at whole numbers, joined by cosines.
double noise_at(std::uint64_t seed, double t) {
  const double whole = std::floor(t), part = 0.5 - 0.5 * std::cos(kPi * (t - whole));
  const auto value = [&](double k) { return 2.0 * hash01(seed, static_cast<std::uint64_t>(static_cast<std::int64_t>(k) + (std::int64_t{1} << 40))) - 1.0; };
  return (1.0 - part) * value(whole) + part * value(whole + 1.0);
}

// The stroke as water leaves it: radii that swell and shrink, `factor` times as wide, moved by `shift` radii.
Stroke washed(const Stroke& stroke, std::uint64_t seed, double factor, const Vec2& shift) {
  Stroke out = stroke;
  const std::vector<double> arcs = arc_lengths(stroke.points);
  for (std::size_t i = 0; i < out.points.size(); ++i) {
    const double wave = std::max(kWave, kWave * 0.5 * stroke.radii[i]);
    out.radii[i] *= factor * (1.0 + kSwell * noise_at(seed, arcs[i] / wave));
    out.points[i] += stroke.radii[i] * shift;
  }
  return out;
}

// The part of a stroke outside its parent's body, where a rim of pigment can dry.
Stroke beyond_parent(Stroke stroke) {
  const auto drop = static_cast<std::ptrdiff_t>(std::min<std::size_t>(static_cast<std::size_t>(std::max(0, stroke.rim)), stroke.points.size() - 1));
  stroke.points.erase(stroke.points.begin(), stroke.points.begin() + drop);
  stroke.radii.erase(stroke.radii.begin(), stroke.radii.begin() + drop);
  stroke.births.erase(stroke.births.begin(), stroke.births.begin() + drop);
  stroke.rim = 0;
  return stroke;
}

// Water that ran out of a stroke in places.
Stroke flooded(const Stroke& stroke, std::uint64_t seed) {
  Stroke out = stroke;
  const std::vector<double> arcs = arc_lengths(stroke.points);
  for (std::size_t i = 0; i < out.points.size(); ++i) {
    const double run = 0.5 + 0.5 * noise_at(seed, arcs[i] / kRun), side = noise_at(seed + 1, 0.7 * arcs[i] / kRun);
    out.radii[i] = out.radii[i] * (1.1 + 0.8 * run) + 6.5 * run * run * run + 0.5;
    out.points[i] += run * Vec2(2.5 * side, 3.0 * run);  // and downwards
  }
  return out;
}

}  // namespace

std::vector<Layer> watercolor_layers(const PaintScene& scene, const std::vector<Stroke>& strokes, const Monitor& monitor) {
  Layer water{"water", {}, Blend::Wash, 2.2, 0.55}, wash{"wash", {}, Blend::Wash, 1.4, 0.95},
      glaze{"second wash", {}, Blend::Wash, 1.0, 0.5};
  int deepest = 1;
  for (const Stroke& stroke : strokes) deepest = std::max(deepest, stroke.order);
  const double tolerance = scene.options.tolerance;
  for (std::size_t s = strokes.size(); s-- > 0;) {  // main branches on top
    monitor.check();
    const Stroke& stroke = strokes[s];
    if (stroke.points.empty()) continue;
    const std::uint64_t seed = Rng(scene.seed).child("wash", s).next();
    const double tone = static_cast<double>(stroke.order) / deepest + 0.25 * noise_at(seed, 0.5);
    const Rgb color = color_along(scene.colors, tone), dark = mix(color, scene.colors.front(), 0.7);
    const auto add = [&](Layer& layer, const Stroke& shape, const Rgb& paint) {
      Shape out = stroke_shape(shape, paint, tolerance);
      if (!out.loops.empty()) layer.shapes.push_back(std::move(out));
    };
    add(water, flooded(stroke, seed + 2), mix(color, scene.colors.back(), 0.6f));
    add(wash, washed(stroke, seed, 1.3, Vec2::Zero()), color);
    const double widest = *std::max_element(stroke.radii.begin(), stroke.radii.end());
    if (widest > kThick) add(glaze, washed(beyond_parent(stroke), seed + 1, 0.55, Vec2(0.32, 0.24)), dark);
  }
  std::vector<Layer> layers;
  for (Layer* layer : {&water, &wash, &glaze}) {
    if (!layer->shapes.empty()) layers.push_back(std::move(*layer));
  }
  return layers;
}

}  // namespace ramify
