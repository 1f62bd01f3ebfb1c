// SPDX-License-Identifier: GPL-3.0-or-later
// A leaf held against the light: midrib, side veins, the fine net between them, the toothed margin.
#include <algorithm>
#include <cmath>

#include "ramify/image/filter.h"
#include "ramify/synthetic/branch_field.h"
#include "ramify/synthetic/noise.h"
#include "ramify/synthetic/scene.h"
#include "ramify/synthetic/tree.h"

namespace ramify {
namespace {

// The blade: an axis from its base to its tip, and a half width for every place on it.
struct Leaf {
  Vec2 base, along, side;   // px, unit vectors
  double length = 0.0, width = 0.0, tooth = 0.0;
  double bow = 0.0;         // px, sagitta of the midrib

  Vec2 axis(double t) const { return base + length * t * along + 4.0 * bow * t * (1.0 - t) * side; }

  // px inside the margin, negative outside.
  double inside(const Vec2& p, bool teeth) const {
    const double t = (p - base).dot(along) / length;
    if (t < -0.005 || t > 1.0) return -20.0;
    const double across = std::fabs((p - axis(t)).dot(side));
    const double u = std::max(0.0, t + 0.005);
    double half = width * std::pow(u, 0.62) * std::pow(1.0 - t, 0.78) * 2.6;
    if (teeth) half *= 1.0 - 0.075 * (1.0 - std::fmod(u * tooth, 1.0));
    return half - across;
  }
};

Leaf leaf_of(Size size, Rng rng) {
  Leaf leaf;
  const double w = size.width, h = size.height;
  const bool flip = rng.uniform() < 0.5;
  const double tilt = (flip ? -1.0 : 1.0) * rng.uniform(0.15, 0.38) * std::min(1.0, h / w * 1.5);
  leaf.along = direction_of(tilt);
  leaf.side = perpendicular(leaf.along);
  leaf.length = 0.90 * std::min(w / std::max(0.2, std::fabs(leaf.along.x())), 1.7 * h);
  leaf.base = Vec2(0.5 * w, 0.5 * h) - 0.48 * leaf.length * leaf.along;
  leaf.width = 0.255 * leaf.length * rng.uniform(0.92, 1.1);
  leaf.tooth = std::floor(rng.uniform(22.0, 30.0));
  leaf.bow = leaf.length * rng.uniform(-0.03, 0.03);
  return leaf;
}

TreePlan vein_plan(Size size, const Leaf& leaf) {
  const double s = scale_of(size);
  TreePlan plan;
  plan.size = size;
  plan.clearance = 2.5 * s;
  plan.thinnest = 0.8;
  plan.radius_noise = 0.04;
  plan.allowed = [leaf, s](const Vec2& p) {
    return (p - leaf.base).dot(leaf.along) < 0.0 || leaf.inside(p, true) > 4.0 * s;
  };
  const double axis = angle_of(leaf.along), bend = std::atan(4.0 * leaf.bow / leaf.length);
  const TreeCourse midrib{.bend_length = 300.0 * s, .bend_angle = 0.015, .ripple_length = 40.0 * s, .ripple_angle = 0.012,
                      .homing = std::fabs(bend) > 1e-3 ? 2.0 / leaf.length : 0.0, .home = axis - 1.3 * bend};
  // The petiole enters through the frame.
  const Vec2 back = direction_of(axis + bend);
  double petiole = 0.0;
  while (petiole < 2.0 * size.width && (leaf.base - petiole * back).x() > -10.0 * s &&
         std::fabs((leaf.base - petiole * back).y() - 0.5 * size.height) < 0.5 * size.height + 10.0 * s) petiole += 1.0;
  plan.roots.push_back({.start = leaf.base - petiole * back, .heading = axis + bend, .radius = 6.2 * s,
                        .length = petiole + 0.99 * leaf.length, .tip_share = 0.13, .course = midrib});
  const double first = (petiole + 0.015 * leaf.length) / (petiole + leaf.length);
  const auto curved = [&](double homing) {
    return TreeCourse{.bend_length = 120.0 * s, .bend_angle = 0.08, .ripple_length = 26.0 * s, .ripple_angle = 0.05,
                  .homing = homing / s, .home = axis};
  };
  plan.levels.push_back({.count = 26, .angle_low = 0.75, .angle_high = 0.88, .length_low = 1.0, .length_high = 1.0,
                         .ratio_low = 0.36, .ratio_high = 0.46, .tip_share = 0.3, .shortest = 30.0 * s, .whole = 0.0,
                         .alternate = 1.0, .first = first, .last = 0.96, .irregular = 0.2, .course = curved(0.0013)});
  plan.levels.push_back({.count = 42, .angle_low = 0.95, .angle_high = 1.35, .length_low = 0.5, .length_high = 0.9,
                         .ratio_low = 0.30, .ratio_high = 0.42, .tip_share = 0.8, .shortest = 10.0 * s, .whole = 0.0,
                         .alternate = 0.5, .first = 0.08, .last = 0.85, .on_elders = false, .course = curved(0.0)});
  plan.levels.push_back({.count = 16, .angle_low = 0.8, .angle_high = 1.3, .length_low = 0.3, .length_high = 0.9,
                         .ratio_low = 0.8, .ratio_high = 0.95, .tip_share = 0.9, .shortest = 6.0 * s, .whole = 0.0,
                         .alternate = 0.5, .first = 0.2, .last = 0.85, .on_elders = false, .course = curved(0.0)});
  return plan;
}

}  // namespace

Scene draw_vein(Size size, const Rng& rng, const Monitor& monitor) {
  const double s = scale_of(size);
  const Leaf leaf = leaf_of(size, rng.child("leaf"));
  Scene scene;
  scene.polarity = Polarity::Bright;
  scene.branches = draw_tree(vein_plan(size, leaf), rng.child("tree"), monitor);
  monitor.report(0.3);
  const Image<BranchSample> field = branch_field(skeleton_of(size, scene.branches), 30.0 * s);
  const Image<CellSample> wide = cells(size, 15.0 * s, 0.95, rng.child("wide")), fine = cells(size, 6.0 * s, 0.95, rng.child("fine"));
  const ScalarImage tone = power_noise(size, {300.0 * s, 12.0 * s, 2.8}, rng.child("tone"));
  const ScalarImage pulp = power_noise(size, {6.0, 2.0, 1.6}, rng.child("pulp"));
  const ScalarImage edge = power_noise(size, {30.0 * s, 4.0 * s, 2.2}, rng.child("edge"));
  scene.color = painted(size, [&](int x, int y) {
    const BranchSample& at = field(x, y);
    const float inside = static_cast<float>(leaf.inside(Vec2(x, y), true)) + 0.8f * edge(x, y);
    const float blade = coverage(-inside, 0.7f);
    const CellSample &a = wide(x, y), &b = fine(x, y);
    Rgb color = mix(Rgb{0.225f, 0.385f, 0.085f}, Rgb{0.385f, 0.560f, 0.150f}, std::clamp(0.5f + 0.28f * tone(x, y), 0.0f, 1.0f));
    const float cell = ((a.id >> 8 & 255u) / 255.0f - 0.5f) * 0.12f + ((b.id >> 8 & 255u) / 255.0f - 0.5f) * 0.16f;
    color = (1.0f + cell + 0.045f * pulp(x, y)) * color;
    const float net = 0.50f * std::exp(-0.5f * std::pow(a.border / 1.0f, 2.0f)) + 0.30f * std::exp(-0.5f * std::pow(b.border / 0.75f, 2.0f));
    color = mix(color, Rgb{0.540f, 0.720f, 0.270f}, std::min(1.0f, net));
    color = (1.0f - 0.35f * smooth_step(5.0f, 0.0f, inside)) * color;
    Rgb out = mix(Rgb{0.955f, 0.960f, 0.965f}, color, blade);
    if (at.branch != kNone) {
      const float thick = smooth_step(0.8f, 5.0f, at.radius / static_cast<float>(s));
      const float flank = std::exp(-0.5f * std::pow((at.distance - 1.5f) / (1.0f + 0.25f * at.radius), 2.0f));
      const float pillow = smooth_step(2.0f, static_cast<float>(24.0 * s), at.distance) - 0.5f;
      out = (1.0f + (0.14f * pillow - 0.16f * flank) * blade) * out;
      const float relief = at.across / std::max(1.0f, at.radius);
      const Rgb vein = (1.0f + 0.08f * thick * relief + 0.03f * pulp(x, y)) * mix(Rgb{0.610f, 0.770f, 0.330f}, Rgb{0.760f, 0.780f, 0.400f}, thick);
      out = mix(out, vein, coverage(at.distance, 0.42f));
    }
    return out;
  });
  scene.color = photograph(scene.color, {0.48, 0.007, 0.5, 0.4, 0.05}, rng.child("camera"));
  return scene;
}

}  // namespace ramify
