// SPDX-License-Identifier: GPL-3.0-or-later
// Thin washes: a first one over everything, pale and a little wider than the branches, pigment that gathered along its rim,
// and a second, darker one on the shaded side of what is thick. Every wash is one layer with one opacity, so that branches
// which overlap within it do not darken each other.
#include <algorithm>
#include <cmath>

#include "ramify/core/random.h"
#include "ramify/geometry/polyline.h"
#include "ramify/paint/palette.h"
#include "ramify/paint/styles.h"

namespace ramify {
namespace {

constexpr double kSwell = 0.16;        // share of the radius by which water spreads and draws back
constexpr double kWave = 7.0;          // px or radii, whichever is more, from swell to swell
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

// What lies between a shape's outline and the same shape drawn in by `width`: the inner loop runs the other way.
Shape rim(const Stroke& stroke, const Rgb& color, double tolerance, double width) {
  Shape outer = stroke_shape(stroke, color, tolerance), inner = stroke_shape(stroke, color, tolerance, -width);
  for (const std::vector<CubicBezier>& loop : inner.loops) {
    std::vector<CubicBezier> back;
    for (auto curve = loop.rbegin(); curve != loop.rend(); ++curve) back.push_back({(*curve)[3], (*curve)[2], (*curve)[1], (*curve)[0]});
    outer.loops.push_back(std::move(back));
  }
  return outer;
}

}  // namespace

std::vector<Layer> watercolor_layers(const PaintScene& scene, const std::vector<Stroke>& strokes, const Monitor& monitor) {
  Layer wash, edge, glaze;
  wash.name = "wash";
  edge.name = "pigment";
  glaze.name = "second wash";
  wash.opacity = 0.62;
  edge.opacity = 0.28;
  glaze.opacity = 0.4;
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
    const Stroke first = washed(stroke, seed, 1.08, Vec2::Zero());
    Shape shape = stroke_shape(first, color, tolerance);
    if (!shape.loops.empty()) wash.shapes.push_back(std::move(shape));
    const double widest = *std::max_element(stroke.radii.begin(), stroke.radii.end());
    if (widest > 1.0) {
      Shape ring = rim(beyond_parent(first), dark, tolerance, std::clamp(0.25 * widest, 0.4, 1.4));
      if (!ring.loops.empty()) edge.shapes.push_back(std::move(ring));
    }
    if (widest > kThick) {
      Shape shade = stroke_shape(washed(beyond_parent(stroke), seed + 1, 0.55, Vec2(0.32, 0.24)), dark, tolerance);
      if (!shade.loops.empty()) glaze.shapes.push_back(std::move(shade));
    }
  }
  std::vector<Layer> layers;
  for (Layer* layer : {&wash, &glaze, &edge}) {
    if (!layer->shapes.empty()) layers.push_back(std::move(*layer));
  }
  return layers;
}

}  // namespace ramify
