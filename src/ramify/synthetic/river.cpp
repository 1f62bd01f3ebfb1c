// SPDX-License-Identifier: GPL-3.0-or-later
// A silty river and its creeks in forest, seen from far above.
#include <algorithm>
#include <cmath>

#include "ramify/image/filter.h"
#include "ramify/image/sample.h"
#include "ramify/synthetic/branch_field.h"
#include "ramify/synthetic/noise.h"
#include "ramify/synthetic/scene.h"
#include "ramify/synthetic/tree.h"

namespace ramify {
namespace {

constexpr double kBankReach = 60.0;  // px at scale 1 on which the river shapes its banks

// The root is the mouth, where the river is widest; tips lie upstream.
TreePlan river_plan(Size size, Rng rng) {
  const double s = scale_of(size), w = size.width, h = size.height;
  TreePlan plan;
  plan.size = size;
  plan.clearance = 8.0 * s;
  plan.thinnest = 0.9;
  plan.radius_noise = 0.12;
  const bool right = rng.uniform() < 0.5;
  const double heading = (right ? 0.0 : kPi) + rng.uniform(-0.35, 0.35);
  // Aimed so that it crosses the middle of the picture.
  const double reach = 0.5 * w + 30.0 * s;
  const double y = 0.5 * h - reach * std::sin(heading) + 0.08 * h * rng.normal();
  SyntheticRoot mouth;
  mouth.start = Vec2(right ? -30.0 * s : w + 30.0 * s, y);
  mouth.heading = heading;
  mouth.radius = 23.0 * s;
  mouth.shortest = 0.9 * w;
  mouth.tip_share = 0.4;
  mouth.course = {.bend_length = 330.0 * s, .bend_angle = 0.62, .ripple_length = 80.0 * s, .ripple_angle = 0.16,
                  .homing = 0.004 / s, .home = heading};
  plan.roots.push_back(mouth);
  const auto winding = [s](double length, double bend, double ripple) {
    return TreeCourse{.bend_length = length * s, .bend_angle = bend, .ripple_length = 0.32 * length * s, .ripple_angle = ripple};
  };
  const TreeCourse tributary = winding(100.0, 0.75, 0.25), creek = winding(52.0, 0.75, 0.3), rill = winding(34.0, 0.7, 0.3);
  plan.levels.push_back({.count = 10, .angle_low = 0.6, .angle_high = 1.25, .length_low = 0.45, .length_high = 1.0,
                         .ratio_low = 0.10, .ratio_high = 0.30, .tip_share = 0.2, .shortest = 110.0 * s, .whole = 0.45,
                         .alternate = 0.75, .first = 0.06, .last = 0.95, .course = tributary});
  plan.levels.push_back({.count = 32, .angle_low = 0.55, .angle_high = 1.25, .length_low = 0.3, .length_high = 0.8,
                         .ratio_low = 0.12, .ratio_high = 0.5, .tip_share = 0.3, .shortest = 50.0 * s, .whole = 0.45,
                         .alternate = 0.6, .first = 0.08, .last = 0.95, .course = creek});
  plan.levels.push_back({.count = 52, .angle_low = 0.55, .angle_high = 1.3, .length_low = 0.25, .length_high = 0.7,
                         .ratio_low = 0.3, .ratio_high = 0.65, .tip_share = 0.5, .shortest = 24.0 * s, .whole = 0.45,
                         .alternate = 0.6, .first = 0.1, .last = 0.95, .course = rill});
  return plan;
}

ColorImage forest(Size size, const Image<BranchSample>& field, const Vec2& sun, const Rng& rng) {
  const double s = scale_of(size);
  const ScalarImage hills = power_noise(size, {260.0 * s, 4.0, 3.4}, rng.child("hills"));
  ScalarImage valleys(size);  // creases where the field changes its sign: a landscape cut by water
  for (std::size_t i = 0; i < valleys.pixels().size(); ++i) valleys.pixels()[i] = std::sqrt(0.02f + std::fabs(hills.pixels()[i]));
  const ScalarImage shade = relief_shade(valleys, static_cast<float>(2.4 * s), sun);
  const ScalarImage stands = power_noise(size, {240.0 * s, 4.0, 2.5}, rng.child("stands"));
  const ScalarImage wet = power_noise(size, {340.0 * s, 6.0, 2.6}, rng.child("wet"));
  const ScalarImage crowns = power_noise(size, {7.0, 2.0, 1.2}, rng.child("crowns"));
  const ScalarImage canopy = relief_shade(crowns, 0.07f, sun);
  return painted(size, [&](int x, int y) {
    const BranchSample& at = field(x, y);
    const float away = at.branch == kNone ? static_cast<float>(kBankReach * s) : std::max(0.0f, at.distance);
    const float bank = std::exp(-away / static_cast<float>(7.0 * s + 0.9 * at.radius)) * smooth_step(-1.2f, 1.2f, stands(x, y) + crowns(x, y) * 0.3f);
    const float meadow = smooth_step(0.8f, 2.2f, stands(x, y) + 0.5f * bank + 0.15f * crowns(x, y));
    const float bog = smooth_step(0.3f, 1.8f, wet(x, y) - 0.3f * stands(x, y));
    const float crease = smooth_step(0.28f, 0.0f, std::fabs(hills(x, y)));
    const Rgb dark{0.090f, 0.140f, 0.088f}, light{0.178f, 0.222f, 0.118f}, marsh{0.125f, 0.150f, 0.118f}, riparian{0.262f, 0.275f, 0.158f};
    Rgb ground = mix(dark, light, std::clamp(0.35f + 0.20f * stands(x, y), 0.0f, 1.0f));
    ground = mix(ground, marsh, 0.7f * bog);
    ground = mix(ground, riparian, 0.45f * meadow + 0.30f * bank);
    return (std::clamp(shade(x, y), 0.6f, 1.5f) * canopy(x, y) * (1.0f + 0.085f * crowns(x, y)) * (1.0f - 0.14f * crease)) * ground;
  });
}

// How silty the water is, 0 … 1: by width, and near a mouth like the river it flows into.
float silt_of(const BranchSample& at, const std::vector<AnnotatedBranch>& branches, double s) {
  const auto by_width = [s](double radius) { return std::sqrt(std::clamp(radius / (13.0 * s), 0.0, 1.0)); };
  double silt = by_width(at.radius);
  const auto& parent = branches[at.branch].parent;
  if (parent) {
    const double there = branches[parent->branch].radii[parent->point];
    silt += (by_width(there) - silt) * std::exp(-at.along / (1.3 * there + 10.0 * s));
  }
  return static_cast<float>(silt);
}

ColorImage water(Size size, const Image<BranchSample>& field, const std::vector<AnnotatedBranch>& branches, const Rng& rng) {
  const double s = scale_of(size);
  // Streaks: a texture laid along the flow, stretched several times.
  const Size strip{1024, 256};
  const ScalarImage streaks = power_noise(strip, {110.0, 3.0, 2.5}, rng.child("streaks"));
  const ScalarImage tone = power_noise(size, {260.0 * s, 8.0 * s, 2.5}, rng.child("tone"));
  const ScalarImage ripple = power_noise(size, {10.0, 2.0, 1.5}, rng.child("ripple"));
  return painted(size, [&](int x, int y) {
    const BranchSample& at = field(x, y);
    if (at.branch == kNone) return Rgb{};
    const double u = std::fmod(at.along / (4.0 * s) + 37.0 * at.branch, strip.width - 1.0);
    const double v = 128.0 + 60.0 * at.across / (20.0 * s);
    const float streak = sample_bilinear(streaks, Vec2(u, v));
    const Rgb creek{0.290f, 0.262f, 0.180f}, silt{0.545f, 0.432f, 0.305f};
    const float shallow = smooth_step(-0.5f * at.radius, 0.0f, at.distance);
    const Rgb body = mix(creek, silt, silt_of(at, branches, s));
    return (1.0f + 0.040f * streak + 0.045f * tone(x, y) + 0.010f * ripple(x, y) + 0.04f * shallow) * body;
  });
}

// Creeks come out of the forest bit by bit: 0.25 at a free tip, 1 further down.
float visibility(const BranchSample& at, const std::vector<AnnotatedBranch>& branches, double s) {
  const AnnotatedBranch& branch = branches[at.branch];
  if (branch.leaves_frame.value_or(false)) return 1.0f;
  const float left = 2.0f * static_cast<float>(branch.points.size()) - at.along;
  return 0.25f + 0.75f * smooth_step(-4.0f, static_cast<float>(45.0 * s), left);
}

}  // namespace

Scene draw_river(Size size, const Rng& rng, const Monitor& monitor) {
  const double s = scale_of(size);
  Scene scene;
  scene.polarity = Polarity::Bright;
  scene.light = Vec3(-0.6, -0.5, 0.62);
  scene.branches = draw_tree(river_plan(size, rng.child("plan")), rng.child("tree"), monitor);
  monitor.report(0.3);
  const Image<BranchSample> field = branch_field(skeleton_of(size, scene.branches), kBankReach * s);
  const ColorImage land = forest(size, field, scene.light.head<2>(), rng.child("forest"));
  monitor.report(0.6);
  const ColorImage wet = water(size, field, scene.branches, rng.child("water"));
  const ScalarImage sand = power_noise(size, {60.0 * s, 5.0 * s, 2.2}, rng.child("sand"));
  scene.color = painted(size, [&](int x, int y) {
    const BranchSample& at = field(x, y);
    if (at.branch == kNone) return land(x, y);
    // Trees between the water and the sun throw a thin shadow onto the bank; here and there lies pale mud.
    const float sunward = static_cast<float>(at.outward_x() * scene.light.x() + at.outward_y() * scene.light.y());
    const float rim = std::exp(-0.5f * std::pow((at.distance - 1.2f) / 1.0f, 2.0f)) * std::clamp(0.5f + 0.6f * sunward, 0.0f, 1.0f);
    const float mud = smooth_step(0.7f, 1.8f, sand(x, y)) * smooth_step(3.0f, 9.0f, at.radius) *
                      std::exp(-std::max(0.0f, at.distance) / static_cast<float>(1.6 * s)) * 0.6f;
    const Rgb bank = mix((1.0f - 0.16f * rim) * land(x, y), Rgb{0.46f, 0.40f, 0.29f}, mud);
    return mix(bank, wet(x, y), coverage(at.distance, 0.42f) * visibility(at, scene.branches, s));
  });
  scene.color = photograph(scene.color, {0.45, 0.008, 0.5, 0.5, 0.06}, rng.child("camera"));
  return scene;
}

}  // namespace ramify
