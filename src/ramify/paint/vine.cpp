// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>

#include "ramify/geometry/polyline.h"
#include "ramify/paint/palette.h"
#include "ramify/paint/styles.h"

namespace ramify {
namespace {

const Rgb kDark{0.07f, 0.07f, 0.05f}, kPale{1.0f, 0.98f, 0.86f};
const Vec2 kLight(-0.55, -0.83);   // unit; the same as on leaves
constexpr double kUnfolding = 5.0; // blade lengths of way that a leaf takes to its full size

double unfolded(double way) {
  const double t = std::clamp(way, 0.0, 1.0);
  return t * t * (3.0 - 2.0 * t);
}

// Stems: bark on thick ones, green on thin ones.
struct StemColors {
  Rgb body, rim, shine;
};

StemColors stem_colors(const PaintScene& scene, const Stroke& stroke, double thickest) {
  const Rgb bark = scene.colors.front(), leaf = scene.colors[std::min<std::size_t>(1, scene.colors.size() - 1)];
  const double radius = stroke.radii[stroke.radii.size() / 3];
  const double woody = std::clamp(std::sqrt(radius / std::max(thickest, 1e-9)) * 1.4 - 0.2, 0.0, 1.0);
  const Rgb body = mix(mix(leaf, bark, 0.35), bark, woody);
  return {body, mix(body, kDark, 0.55), mix(body, kPale, 0.3)};
}

// A streak of light along the side that faces it; nothing on strokes too thin to show it.
Stroke shine_of(const Stroke& stroke) {
  Stroke out;
  const std::vector<Vec2> way = tangents(stroke.points);
  for (std::size_t i = 0; i < stroke.points.size(); ++i) {
    const double radius = stroke.radii[i];
    if (static_cast<int>(i) < stroke.rim || radius < 1.3) {
      if (out.points.empty()) continue;
      break;
    }
    const Vec2 normal = perpendicular(way[i]);
    const double facing = normal.dot(kLight);  // slides over the back of the stem instead of jumping sides
    out.points.push_back(stroke.points[i] + 0.48 * radius * facing * normal);
    out.radii.push_back(0.13 * radius);
    out.births.push_back(stroke.births[i]);
  }
  const std::size_t n = out.points.size();
  if (n < 6) return {};
  for (std::size_t i = 0; i < n; ++i) {
    const double end = std::min({static_cast<double>(i), static_cast<double>(n - 1 - i), 0.3 * static_cast<double>(n)}) / (0.3 * static_cast<double>(n));
    out.radii[i] = std::max(0.05, out.radii[i] * std::sqrt(end));
  }
  return out;
}

LeafColors leaf_colors(const PaintScene& scene, double tone) {
  std::vector<Rgb> leaves(scene.colors.begin() + (scene.colors.size() > 1 ? 1 : 0), scene.colors.end());
  const Rgb blade = color_along(leaves, tone);
  return {blade, mix(blade, kDark, 0.2), mix(blade, kPale, 0.38), mix(blade, kDark, 0.55)};
}

// The stalk goes under the stems, the blade into `layer`.
void append_leaf(const PaintScene& scene, const Leaf& leaf, double front, Layer& stalks, Layer& layer) {
  const double open = unfolded((front - leaf.birth) / (kUnfolding * scene.foliage.leaf_size));
  if (open <= 0.02) return;
  LeafPose pose = leaf.pose;
  pose.size *= open;
  pose.base = leaf.stem + open * (leaf.pose.base - leaf.stem);
  const LeafColors colors = leaf_colors(scene, leaf.tone);
  Stroke stalk;
  const double wide = std::max(0.35, 0.022 * pose.size);
  for (int i = 0; i <= 4; ++i) {
    stalk.points.push_back(leaf.stem + (pose.base - leaf.stem) * (i / 4.0));
    stalk.radii.push_back(wide * (1.3 - 0.3 * i / 4.0));
  }
  stalks.shapes.push_back(stroke_shape(stalk, mix(colors.shade, scene.colors.front(), 0.4), scene.options.tolerance));
  for (Shape& shape : leaf_shapes(scene.options.leaf, pose, colors)) layer.shapes.push_back(std::move(shape));
}

void append_stems(const PaintScene& scene, const std::vector<Stroke>& strokes, const Monitor& monitor, std::vector<Layer>& layers) {
  double thickest = 0.0;
  for (const Stroke& stroke : scene.strokes) thickest = std::max(thickest, stroke.radii[stroke.radii.size() / 3]);
  int deepest = 0;
  for (const Stroke& stroke : strokes) deepest = std::max(deepest, stroke.order);
  Layer rims{"stem rims", {}}, bodies{"stems", {}}, shines{"light on stems", {}};
  for (int order = deepest; order >= 0; --order) {
    for (std::size_t s = 0; s < strokes.size(); ++s) {
      monitor.check();
      const Stroke& stroke = strokes[s];
      if (stroke.order != order || stroke.points.empty()) continue;
      const StemColors colors = stem_colors(scene, scene.strokes[s], thickest);
      const double tolerance = scene.options.tolerance;
      const double rim = std::clamp(0.22 * stroke.radii[stroke.radii.size() / 2], 0.3, 1.1);
      rims.shapes.push_back(stroke_shape(stroke, colors.rim, tolerance, rim));
      bodies.shapes.push_back(stroke_shape(stroke, colors.body, tolerance));
      const Stroke shine = shine_of(stroke);
      if (!shine.points.empty()) shines.shapes.push_back(stroke_shape(shine, colors.shine, tolerance));
    }
  }
  for (Layer* layer : {&rims, &bodies, &shines}) {
    if (!layer->shapes.empty()) layers.push_back(std::move(*layer));
  }
}

}  // namespace

std::vector<Layer> vine_layers(const PaintScene& scene, const std::vector<Stroke>& strokes, double front, const Monitor& monitor) {
  std::vector<Layer> layers;
  Layer behind{"leaves behind", {}}, leaves{"leaves", {}}, flowers{"flowers", {}}, stalks{"stalks", {}}, tendrils{"tendrils", {}};
  for (const Leaf& leaf : scene.foliage.leaves) append_leaf(scene, leaf, front, stalks, leaf.behind ? behind : leaves);
  const LeafColors fresh = leaf_colors(scene, 0.5);
  for (const Stroke& tendril : grown_strokes(scene.foliage.tendrils, front, 0.0)) {
    if (tendril.points.size() < 2) continue;
    tendrils.shapes.push_back(stroke_shape(tendril, fresh.shade, scene.options.tolerance));
  }
  const Rgb petal = parse_color("flower-color", scene.options.flower_color), heart{0.96f, 0.78f, 0.25f};
  for (const Flower& flower : scene.foliage.flowers) {
    const double open = unfolded((front - flower.birth) / (kUnfolding * scene.foliage.leaf_size));
    if (open <= 0.02) continue;
    for (Shape& shape : flower_shapes(flower.centre, open * flower.radius, flower.angle, petal, heart)) flowers.shapes.push_back(std::move(shape));
  }
  if (!behind.shapes.empty()) layers.push_back(std::move(behind));
  if (!stalks.shapes.empty()) layers.push_back(std::move(stalks));
  if (!tendrils.shapes.empty()) layers.push_back(std::move(tendrils));
  append_stems(scene, strokes, monitor, layers);
  if (!leaves.shapes.empty()) layers.push_back(std::move(leaves));
  if (!flowers.shapes.empty()) layers.push_back(std::move(flowers));
  return layers;
}

}  // namespace ramify
