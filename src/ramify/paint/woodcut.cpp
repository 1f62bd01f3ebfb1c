// SPDX-License-Identifier: GPL-3.0-or-later
// As if cut into a block and printed: branches stand as solid ink with slivers of paper cut out of their lit side along the
// grain, and the ground is what the gouge left of its lines, thinning towards the horizon and keeping clear of the branches.
#include <algorithm>
#include <cmath>

#include "ramify/core/random.h"
#include "ramify/geometry/polyline.h"
#include "ramify/paint/palette.h"
#include "ramify/paint/styles.h"

namespace ramify {
namespace {

constexpr double kThinnestCut = 1.6;   // px, radius of the thinnest branch that is cut into
const Vec2 kLight(-0.8, -0.6);         // where the light comes from
constexpr double kRow = 6.0;           // px from line to line of the ground at 1000 px of canvas
constexpr double kClear = 0.9;         // rows of paper beside a branch

// A sliver along a curve through a, b and c, pointed at both ends, `half` px wide to either side of b.
Shape sliver(const Vec2& a, const Vec2& b, const Vec2& c, double half, const Rgb& color) {
  const Vec2 across = half * perpendicular((c - a).normalized());
  // A quadratic curve through b at its middle, as cubics of the two sides.
  const auto side = [&](const Vec2& from, const Vec2& to, const Vec2& through) {
    const Vec2 control = 2.0 * through - 0.5 * (from + to);
    return CubicBezier{from, from + (2.0 / 3.0) * (control - from), to + (2.0 / 3.0) * (control - to), to};
  };
  Shape out;
  out.color = color;
  out.loops.push_back({side(a, c, b + across), side(c, a, b - across)});
  return out;
}

// The point of a stroke's body at an arc length, `lateral` radii towards the light.
Vec2 in_body(const Stroke& stroke, const std::vector<double>& arcs, const std::vector<Vec2>& along, double arc, double lateral) {
  const auto at = std::lower_bound(arcs.begin(), arcs.end(), arc);
  const std::size_t i = std::min(static_cast<std::size_t>(at - arcs.begin()), arcs.size() - 1);
  Vec2 across = perpendicular(along[i]);
  if (across.dot(kLight) < 0.0) across = -across;
  return stroke.points[i] + lateral * stroke.radii[i] * across;
}

void cut_into(const Stroke& stroke, Rng rng, const Rgb& paper, std::vector<Shape>& out) {
  const auto rim = static_cast<std::size_t>(std::max(0, stroke.rim));
  if (stroke.points.size() < 4 || rim >= stroke.points.size()) return;  // young: still inside its parent
  const std::vector<double> arcs = arc_lengths(stroke.points);
  const std::vector<Vec2> along = tangents(stroke.points);
  double arc = arcs[rim];
  while (arc < arcs.back()) {
    const auto at = static_cast<std::size_t>(std::lower_bound(arcs.begin(), arcs.end(), arc) - arcs.begin());
    const double radius = stroke.radii[std::min(at, arcs.size() - 1)];
    if (radius < kThinnestCut) return;
    // Several lanes side by side, the widest cuts nearest to the light.
    const int lanes = std::clamp(static_cast<int>(radius / 1.3), 1, 7);
    for (int lane = 0; lane < lanes; ++lane) {
      const double length = radius * rng.uniform(1.6, 4.2) + 3.0, lateral = 0.78 - 0.95 * (lane + rng.uniform(0.2, 0.8)) / lanes;
      const double from = arc + radius * rng.uniform(0.0, 1.5), to = from + length;
      if (to > arcs.back() || rng.uniform() > 0.55 + 0.45 * lateral) continue;
      const double half = std::min(0.22 * radius, radius / lanes * rng.uniform(0.16, 0.36) * (0.6 + 0.6 * std::max(0.0, lateral)));
      const double drift = rng.uniform(-0.1, 0.1);
      out.push_back(sliver(in_body(stroke, arcs, along, from, lateral), in_body(stroke, arcs, along, 0.5 * (from + to), lateral),
                           in_body(stroke, arcs, along, to, lateral + drift), half, paper));
    }
    arc += radius * rng.uniform(1.6, 2.6) + 2.0;
  }
}

// 255 where the ground's lines keep away.
Mask kept_clear(const PaintScene& scene, double clear) {
  Mask out(scene.size);
  for (const Stroke& stroke : scene.strokes) {
    for (std::size_t i = 0; i < stroke.points.size(); ++i) {
      const double reach = stroke.radii[i] + clear;
      const Vec2 p = stroke.points[i];
      for (int y = std::max(0, static_cast<int>(p.y() - reach)); y <= std::min<int>(scene.size.height - 1, static_cast<int>(p.y() + reach)); ++y) {
        for (int x = std::max(0, static_cast<int>(p.x() - reach)); x <= std::min<int>(scene.size.width - 1, static_cast<int>(p.x() + reach)); ++x) {
          if ((Vec2(x, y) - p).norm() <= reach) out(x, y) = 255;
        }
      }
    }
  }
  return out;
}

Layer ground(const PaintScene& scene, const Rgb& ink, const Monitor& monitor) {
  Layer out;
  out.name = "ground";
  const double row = kRow * std::max(0.5, std::max(scene.size.width, scene.size.height) / 1000.0);
  const Mask clear = kept_clear(scene, kClear * row);
  const int rows = static_cast<int>(scene.size.height / row);
  for (int r = 0; r < rows; ++r) {
    monitor.check();
    Rng rng = Rng(scene.seed).child("ground", static_cast<std::uint64_t>(r));
    const double y = (r + 0.5) * row, depth = static_cast<double>(r) / rows;
    const double ink_share = scene.options.hatching * (1.0 - 0.75 * depth);  // of the row, and how thick
    const auto taken = [&](double x) { return clear.clamped(static_cast<int>(x), static_cast<int>(y)) != 0; };
    for (double x = rng.uniform(-40.0, 0.0); x < scene.size.width;) {
      if (taken(x)) {
        x += 1.0;
        continue;
      }
      const double longest = row * rng.uniform(6.0, 30.0);
      double end = x;
      while (end < x + longest && end < scene.size.width + 20.0 && !taken(end)) end += 1.0;
      const double half = 0.5 * row * std::min(0.85, ink_share * rng.uniform(0.55, 1.0)) * std::min(1.0, (end - x) / (4.0 * row));
      if (end - x > row && half > 0.12) {
        const Vec2 sway(0.0, 0.25 * row * rng.uniform(-1.0, 1.0));
        out.shapes.push_back(sliver({x, y}, Vec2(0.5 * (x + end), y) + sway, {end, y}, half, ink));
      }
      x = end + row * rng.uniform(0.2, 1.2);
    }
  }
  return out;
}

}  // namespace

std::vector<Layer> woodcut_layers(const PaintScene& scene, const std::vector<Stroke>& strokes, const Monitor& monitor) {
  const Rgb paper = scene.background.value_or(Rgb{1.0f, 1.0f, 1.0f});
  std::vector<Layer> layers;
  if (scene.options.hatching > 0.0) layers.push_back(ground(scene, scene.colors.back(), monitor));
  Layer body, cuts;
  body.name = "branches";
  cuts.name = "cuts";
  for (std::size_t s = 0; s < strokes.size(); ++s) {
    monitor.check();
    Shape shape = stroke_shape(strokes[s], scene.colors.front(), scene.options.tolerance);
    if (shape.loops.empty()) continue;
    body.shapes.push_back(std::move(shape));
    cut_into(strokes[s], Rng(scene.seed).child("cuts", s), paper, cuts.shapes);
  }
  layers.push_back(std::move(body));
  if (!cuts.shapes.empty()) layers.push_back(std::move(cuts));
  return layers;
}

}  // namespace ramify
