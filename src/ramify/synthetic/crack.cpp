// SPDX-License-Identifier: GPL-3.0-or-later
// Cracks in a weathered concrete wall, lit from the side.
#include <algorithm>
#include <cmath>

#include "ramify/image/filter.h"
#include "ramify/synthetic/branch_field.h"
#include "ramify/synthetic/noise.h"
#include "ramify/synthetic/scene.h"
#include "ramify/synthetic/tree.h"

namespace ramify {
namespace {

TreePlan crack_plan(Size size, Rng rng) {
  const double s = scale_of(size), w = size.width, h = size.height;
  TreePlan plan;
  plan.size = size;
  plan.clearance = 9.0 * s;
  plan.thinnest = 0.8;
  plan.radius_noise = 0.28;
  const auto jagged = [s](double kink, double homing, double home) {
    return TreeCourse{.kink_length = 12.0 * s, .kink_angle = kink, .bend_length = 170.0 * s, .bend_angle = 0.25,
                  .ripple_length = 6.0 * s, .ripple_angle = 0.20, .homing = homing / s, .home = home};
  };
  const bool flip = rng.uniform() < 0.5;
  const double heading = (flip ? kPi : 0.0) + rng.uniform(-0.3, 0.3);
  plan.roots.push_back({.start = Vec2(flip ? w + 8.0 : -8.0, h * rng.uniform(0.35, 0.65)), .heading = heading,
                        .radius = 4.6 * s, .shortest = 0.9 * w, .tip_share = 0.35,
                        .course = jagged(0.42, 0.006, heading)});
  const double second = kPi * 0.5 + rng.uniform(-0.4, 0.4);
  plan.roots.push_back({.start = Vec2(w * (flip ? rng.uniform(0.15, 0.4) : rng.uniform(0.6, 0.85)), -8.0),
                        .heading = second, .radius = 2.8 * s, .tip_share = 0.4,
                        .course = jagged(0.45, 0.006, second)});
  plan.levels.push_back({.count = 10, .angle_low = 0.5, .angle_high = 1.2, .length_low = 0.35, .length_high = 0.9,
                         .ratio_low = 0.35, .ratio_high = 0.65, .tip_share = 0.3, .shortest = 60.0 * s,
                         .alternate = 0.75, .first = 0.08, .last = 0.92, .course = jagged(0.45, 0, 0)});
  plan.levels.push_back({.count = 20, .angle_low = 0.5, .angle_high = 1.25, .length_low = 0.25, .length_high = 0.7,
                         .ratio_low = 0.4, .ratio_high = 0.7, .tip_share = 0.4, .shortest = 35.0 * s,
                         .alternate = 0.6, .first = 0.1, .last = 0.92, .course = jagged(0.5, 0, 0)});
  plan.levels.push_back({.count = 26, .angle_low = 0.5, .angle_high = 1.3, .length_low = 0.2, .length_high = 0.6,
                         .ratio_low = 0.5, .ratio_high = 0.8, .tip_share = 0.6, .shortest = 20.0 * s,
                         .alternate = 0.6, .first = 0.1, .last = 0.92, .course = jagged(0.5, 0, 0)});
  return plan;
}

// Air bubbles at the surface of the concrete: small round holes, dark, with a bright rim away from the light.
ScalarImage pores(Size size, const Vec2& sun, Rng rng) {
  const double s = scale_of(size);
  ScalarImage shade(size);
  const int count = static_cast<int>(150.0 * size.width * size.height / (960.0 * 640.0 * s * s));
  for (int i = 0; i < count; ++i) {
    const Vec2 at(rng.uniform() * size.width, rng.uniform() * size.height);
    const double radius = s * (0.6 + 2.4 * std::pow(rng.uniform(), 5.0)), depth = rng.uniform(0.25, 1.0);
    const int reach = static_cast<int>(2.0 * radius + 3.0);
    for (int y = static_cast<int>(at.y()) - reach; y <= at.y() + reach; ++y)
      for (int x = static_cast<int>(at.x()) - reach; x <= at.x() + reach; ++x) {
        if (!shade.contains(x, y)) continue;
        const Vec2 offset = Vec2(x, y) - at;
        const float hole = coverage(static_cast<float>(offset.norm() - radius), 0.6f);
        const float towards = static_cast<float>(offset.dot(sun) / std::max(radius, 0.5));
        const float rim = std::exp(-0.5f * std::pow(static_cast<float>(offset.norm() - radius - 0.7) / 0.7f, 2.0f));
        shade(x, y) += static_cast<float>(depth) * (-0.42f * hole * (1.0f + 0.5f * towards) - 0.10f * rim * towards);
      }
  }
  return shade;
}

ColorImage concrete(Size size, const Vec2& sun, const Rng& rng) {
  const double s = scale_of(size);
  const ScalarImage stains = power_noise(size, {360.0 * s, 8.0 * s, 2.7}, rng.child("stains"));
  const ScalarImage tint = power_noise(size, {300.0 * s, 6.0 * s, 2.6}, rng.child("tint"));
  const ScalarImage streaks = power_noise(size, {70.0 * s, 2.0, 2.2, 0.55, 7.0}, rng.child("streaks"));
  const ScalarImage blotch = power_noise(size, {40.0 * s, 3.0, 2.2}, rng.child("blotch"));
  const ScalarImage height = power_noise(size, {90.0 * s, 2.0, 3.0}, rng.child("height"));
  const ScalarImage shade = relief_shade(height, static_cast<float>(0.20 * s), sun);
  const ScalarImage sandy = power_noise(size, {5.0, 2.0, 1.4}, rng.child("sand"));
  const ScalarImage holes = pores(size, sun, rng.child("pores"));
  return painted(size, [&](int x, int y) {
    const float damp = smooth_step(0.6f, 2.2f, stains(x, y) + 0.4f * blotch(x, y));
    const float lime = smooth_step(1.2f, 2.6f, streaks(x, y) + 0.5f * tint(x, y));
    float light = 1.0f + 0.045f * stains(x, y) + 0.022f * streaks(x, y) + 0.020f * blotch(x, y) +
                  0.026f * sandy(x, y) - 0.13f * damp + 0.09f * lime;
    light = light * shade(x, y) + 0.8f * holes(x, y);
    const Rgb base = mix(Rgb{0.600f, 0.598f, 0.560f}, Rgb{0.615f, 0.580f, 0.520f},
                         std::clamp(0.5f + 0.3f * tint(x, y), 0.0f, 1.0f));
    return std::max(0.05f, light) * base;
  });
}

}  // namespace

Scene draw_crack(Size size, const Rng& rng, const Monitor& monitor) {
  const double s = scale_of(size);
  Scene scene;
  scene.polarity = Polarity::Dark;
  scene.light = Vec3(-0.55, -0.65, 0.52);
  const Vec2 sun = scene.light.head<2>().normalized();
  scene.branches = draw_tree(crack_plan(size, rng.child("plan")), rng.child("tree"), monitor);
  monitor.report(0.3);
  const Image<BranchSample> field = branch_field(skeleton_of(size, scene.branches), 14.0 * s + 4.0);
  const ColorImage wall = concrete(size, sun, rng.child("concrete"));
  monitor.report(0.7);
  const Image<CellSample> rubble = cells(size, 4.2 * s, 0.9, rng.child("rubble"));
  const ScalarImage dust = power_noise(size, {14.0 * s, 2.0, 1.8}, rng.child("dust"));
  const ScalarImage worn = power_noise(size, {50.0 * s, 5.0 * s, 2.2}, rng.child("worn"));
  scene.color = painted(size, [&](int x, int y) {
    const BranchSample& at = field(x, y);
    if (at.branch == kNone) return wall(x, y);
    // +1 on the side of the crack whose rim faces the light, -1 on the other.
    const float facing = static_cast<float>(-(at.outward_x() * sun.x() + at.outward_y() * sun.y()));
    const float deep = smooth_step(0.0f, -0.8f * at.radius, at.distance);
    const CellSample& stone = rubble(x, y);
    const float chunk = smooth_step(0.3f, 1.2f, stone.border) * ((stone.id >> 8 & 255u) / 255.0f);
    const float fill = smooth_step(2.4f, 5.0f, at.radius) * smooth_step(0.45f, 0.9f, chunk);
    Rgb inside = mix(Rgb{0.250f, 0.232f, 0.205f}, Rgb{0.120f, 0.110f, 0.098f}, deep);
    inside = mix(inside, (0.45f + 0.4f * chunk) * wall(x, y), 0.75f * fill);
    inside = (1.0f + 0.10f * dust(x, y) + 0.22f * facing * (1.0f - deep)) * inside;
    // Into hair cracks light still reaches; where they close up they are hardly darker than the wall.
    const float open = smooth_step(0.5f, 3.2f, at.radius / static_cast<float>(s));
    inside = mix((0.56f - 0.07f * worn(x, y)) * wall(x, y), inside, 0.25f + 0.75f * open);
    const float lip = std::exp(-0.5f * std::pow((at.distance - 1.3f) / (0.9f + 0.12f * at.radius), 2.0f));
    const float soil = std::exp(-std::max(0.0f, at.distance) / static_cast<float>(3.5 * s)) * smooth_step(-0.6f, 1.4f, worn(x, y));
    const float strength = 0.5f + 0.5f * smooth_step(-1.0f, 1.0f, worn(x, y));
    const Rgb outside = (1.0f + 0.13f * lip * strength * facing - 0.10f * soil) * wall(x, y);
    return mix(outside, inside, coverage(at.distance, 0.35f));
  });
  scene.color = photograph(scene.color, {0.42, 0.010, 0.3, 0.45, 0.08}, rng.child("camera"));
  return scene;
}

}  // namespace ramify
