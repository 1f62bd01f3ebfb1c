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
  plan.radius_noise = 0.08;
  const bool right = rng.uniform() < 0.5;
  const double heading = (right ? 0.0 : kPi) + rng.uniform(-0.35, 0.35);
  const double y = h * (0.5 - 0.9 * std::sin(heading)) + 0.1 * h * rng.normal();
  plan.roots.push_back({Vec2(right ? -26.0 * s : w + 26.0 * s, y), heading, 19.0 * s, 1e9, 0.4,
                        {0.0, 0.0, 330.0 * s, 0.62, 80.0 * s, 0.16, 0.004 / s, heading}});
  const Course tributary{0.0, 0.0, 130.0 * s, 0.62, 34.0 * s, 0.22, 0.0, 0.0};
  const Course creek{0.0, 0.0, 70.0 * s, 0.65, 18.0 * s, 0.3, 0.0, 0.0};
  const Course rill{0.0, 0.0, 40.0 * s, 0.6, 12.0 * s, 0.3, 0.0, 0.0};
  plan.levels.push_back({8, 0.6, 1.25, 0.35, 0.8, 0.2, 0.42, 0.3, 90.0 * s, 0.75, 0.06, 0.95, 0.9, tributary});
  plan.levels.push_back({22, 0.6, 1.3, 0.25, 0.7, 0.28, 0.55, 0.35, 40.0 * s, 0.6, 0.08, 0.95, 0.9, creek});
  plan.levels.push_back({34, 0.6, 1.3, 0.2, 0.6, 0.4, 0.7, 0.5, 20.0 * s, 0.6, 0.1, 0.95, 0.9, rill});
  return plan;
}

ColorImage forest(Size size, const Image<BranchSample>& field, const Vec2& sun, const Rng& rng) {
  const double s = scale_of(size);
  const ScalarImage hills = power_noise(size, {300.0 * s, 8.0 * s, 3.2}, rng.child("hills"));
  const ScalarImage shade = relief_shade(hills, static_cast<float>(2.2 * s), sun);
  const ScalarImage stands = power_noise(size, {220.0 * s, 6.0, 2.4}, rng.child("stands"));
  const ScalarImage wet = power_noise(size, {340.0 * s, 10.0, 2.6}, rng.child("wet"));
  const ScalarImage crowns = power_noise(size, {9.0, 2.0, 1.6}, rng.child("crowns"));
  const ScalarImage canopy = relief_shade(crowns, 0.10f, sun);
  return painted(size, [&](int x, int y) {
    const BranchSample& at = field(x, y);
    const float away = at.branch == kNone ? static_cast<float>(kBankReach * s) : std::max(0.0f, at.distance);
    const float bank = std::exp(-away / static_cast<float>(9.0 * s + 0.8 * at.radius));
    const float meadow = smooth_step(0.9f, 2.0f, stands(x, y) + 0.8f * bank);
    const float bog = smooth_step(0.4f, 1.8f, wet(x, y) - 0.3f * stands(x, y));
    const Rgb dark{0.098f, 0.165f, 0.082f}, light{0.205f, 0.262f, 0.115f}, marsh{0.135f, 0.175f, 0.120f},
        riparian{0.245f, 0.285f, 0.130f};
    Rgb ground = mix(dark, light, std::clamp(0.35f + 0.22f * stands(x, y), 0.0f, 1.0f));
    ground = mix(ground, marsh, 0.7f * bog);
    ground = mix(ground, riparian, 0.55f * meadow + 0.25f * bank);
    return (shade(x, y) * canopy(x, y) * (1.0f + 0.055f * crowns(x, y))) * ground;
  });
}

ColorImage water(Size size, const Image<BranchSample>& field, const Rng& rng) {
  const double s = scale_of(size);
  // Streaks: a texture laid along the flow, stretched ten times.
  const Size strip{1024, 256};
  const ScalarImage streaks = power_noise(strip, {120.0, 4.0, 2.6}, rng.child("streaks"));
  const ScalarImage tone = power_noise(size, {300.0 * s, 20.0 * s, 2.6}, rng.child("tone"));
  const ScalarImage ripple = power_noise(size, {10.0, 2.0, 1.5}, rng.child("ripple"));
  return painted(size, [&](int x, int y) {
    const BranchSample& at = field(x, y);
    if (at.branch == kNone) return Rgb{};
    const double u = std::fmod(at.along / (7.0 * s) + 37.0 * at.branch, strip.width - 1.0);
    const double v = 128.0 + 60.0 * at.across / (20.0 * s);
    const float streak = sample_bilinear(streaks, Vec2(u, v));
    const float depth = std::clamp(at.radius / static_cast<float>(14.0 * s), 0.0f, 1.0f);
    const Rgb creek{0.330f, 0.300f, 0.205f}, silt{0.535f, 0.430f, 0.300f};
    const float shallow = smooth_step(-0.45f * at.radius, 0.0f, at.distance);
    const Rgb body = mix(creek, silt, std::sqrt(depth));
    return (1.0f + 0.045f * streak + 0.04f * tone(x, y) + 0.008f * ripple(x, y) + 0.05f * shallow) * body;
  });
}

}  // namespace

Scene draw_river(Size size, const Rng& rng, const Monitor& monitor) {
  const double s = scale_of(size);
  Scene scene;
  scene.polarity = Polarity::Bright;
  scene.light = Vec3(-0.6, -0.5, 0.62);
  scene.branches = draw_tree(river_plan(size, rng.child("plan")), rng.child("tree"), monitor);
  monitor.report(0.3);
  const Image<BranchSample> field = branch_field(size, scene.branches, kBankReach * s);
  const ColorImage land = forest(size, field, scene.light.head<2>(), rng.child("forest"));
  monitor.report(0.6);
  const ColorImage wet = water(size, field, rng.child("water"));
  const ScalarImage sand = power_noise(size, {80.0 * s, 8.0 * s, 2.2}, rng.child("sand"));
  scene.color = painted(size, [&](int x, int y) {
    const BranchSample& at = field(x, y);
    if (at.branch == kNone) return land(x, y);
    // Trees on the bank shade a thin line; here and there a bar of pale sand.
    const float rim = std::exp(-0.5f * std::pow((at.distance - 1.6f) / 1.2f, 2.0f));
    const float bar = smooth_step(0.9f, 1.6f, sand(x, y)) * smooth_step(3.0f, 8.0f, at.radius) *
                      smooth_step(2.5f, 0.5f, std::fabs(at.distance - 1.5f));
    Rgb bank = (1.0f - 0.28f * rim) * land(x, y);
    bank = mix(bank, Rgb{0.62f, 0.56f, 0.43f}, 0.8f * bar);
    return mix(bank, wet(x, y), coverage(at.distance, 0.5f));
  });
  scene.color = photograph(scene.color, {0.55, 0.007, 0.5, 0.5, 0.06}, rng.child("camera"));
  return scene;
}

}  // namespace ramify
