// SPDX-License-Identifier: GPL-3.0-or-later
// Cloud-to-ground lightning at night: light is added in linear light, first the core, then the glow of lens and air.
#include <algorithm>
#include <cmath>

#include "ramify/image/color.h"
#include "ramify/image/filter.h"
#include "ramify/image/sample.h"
#include "ramify/synthetic/branch_field.h"
#include "ramify/synthetic/noise.h"
#include "ramify/synthetic/scene.h"
#include "ramify/synthetic/tree.h"

namespace ramify {
namespace {

constexpr double kDown = 0.5 * kPi;

// Leaders advance in steps: short straight pieces, each turned against the one before.
TreeCourse stepped(double s, double kink, double homing, double home) {
  return {.kink_length = 9.0 * s, .kink_angle = kink, .bend_length = 90.0 * s, .bend_angle = 0.28,
          .ripple_length = 7.0 * s, .ripple_angle = 0.16, .homing = homing / s, .home = home};
}

TreePlan bolt_plan(Size size, double horizon, Rng rng) {
  const double s = scale_of(size), w = size.width;
  TreePlan plan;
  plan.size = size;
  plan.clearance = 3.5 * s;
  plan.murray = 0.35;
  plan.thinnest = 0.7;
  plan.radius_noise = 0.07;
  plan.allowed = [horizon](const Vec2& p) { return p.y() < horizon; };
  const double side = rng.uniform() < 0.5 ? -1.0 : 1.0;
  const double lean = kDown + side * rng.uniform(0.05, 0.3);
  plan.roots.push_back({.start = Vec2(w * (0.5 + side * rng.uniform(0.0, 0.18)), -8.0), .heading = lean,
                        .radius = 3.7 * s, .shortest = 0.9 * horizon, .tip_share = 0.7,
                        .course = stepped(s, 0.42, 0.010, lean)});
  plan.roots.push_back({.start = Vec2(w * (0.5 - side * rng.uniform(0.2, 0.36)), -6.0),
                        .heading = kDown - side * rng.uniform(-0.1, 0.5), .radius = 2.3 * s,
                        .length = horizon * rng.uniform(0.45, 0.8), .tip_share = 0.35,
                        .course = stepped(s, 0.45, 0.008, kDown)});
  plan.levels.push_back({.count = 16, .angle_low = 0.5, .angle_high = 1.05, .length_low = 0.3, .length_high = 0.7,
                         .ratio_low = 0.25, .ratio_high = 0.5, .tip_share = 0.35, .shortest = 40.0 * s,
                         .alternate = 0.6, .first = 0.08, .last = 0.9, .course = stepped(s, 0.48, 0.005, kDown)});
  plan.levels.push_back({.count = 36, .angle_low = 0.45, .angle_high = 1.0, .length_low = 0.2, .length_high = 0.5,
                         .ratio_low = 0.35, .ratio_high = 0.65, .tip_share = 0.45, .shortest = 20.0 * s,
                         .alternate = 0.6, .first = 0.12, .last = 0.92, .course = stepped(s, 0.5, 0.005, kDown)});
  plan.levels.push_back({.count = 44, .angle_low = 0.45, .angle_high = 1.0, .length_low = 0.15,
                         .length_high = 0.45, .ratio_low = 0.5, .ratio_high = 0.8, .tip_share = 0.6,
                         .shortest = 11.0 * s, .alternate = 0.6, .first = 0.15, .last = 0.9,
                         .course = stepped(s, 0.5, 0.004, kDown)});
  return plan;
}

// Encoded brightness of the core: half of its peak exactly at the radius, flatter tops for thicker channels.
float core_profile(const BranchSample& at, float peak) {
  const float power = std::clamp(1.2f + 0.8f * at.radius, 2.0f, 6.0f);
  return peak * std::exp2(-std::pow(std::fabs(at.across) / at.radius, power));
}

ScalarImage core_light(const Image<BranchSample>& field, const std::vector<AnnotatedBranch>& branches, double s,
                       const Rng& rng) {
  const ScalarImage flicker = power_noise(field.size(), {60.0 * s, 12.0 * s, 2.0}, rng);
  ScalarImage core(field.size());
  parallel_for(field.height(), [&](int y) {
    for (int x = 0; x < field.width(); ++x) {
      const BranchSample& at = field(x, y);
      if (at.branch == kNone) continue;
      const AnnotatedBranch& branch = branches[at.branch];
      const float left = 2.0f * static_cast<float>(branch.points.size()) - at.along;
      const float fade = branch.leaves_frame.value_or(false) || left > 60.0f * s ? 1.0f
                             : smooth_step(-4.0f, static_cast<float>(30.0 * s), left) * 0.75f + 0.25f;
      const float level = std::min(1.0f, 0.42f + 0.24f * at.radius / static_cast<float>(s));
      const float peak = std::clamp(level * (1.0f + 0.08f * flicker(x, y)), 0.0f, 1.0f) * fade;
      core(x, y) = linear_from_srgb(core_profile(at, peak));
    }
  }, 8);
  return core;
}

// Height of the skyline (px from the top) in every column: low hills, tree tops, a few buildings.
std::vector<float> skyline(Size size, double horizon, Rng rng) {
  const double s = scale_of(size);
  const LineNoise hills(size.width, 300.0 * s, rng.child("hills")), trees(size.width, 18.0 * s, rng.child("trees")),
      twigs(size.width, 4.0, rng.child("twigs"));
  std::vector<float> top(size.width);
  for (int x = 0; x < size.width; ++x)
    top[x] = static_cast<float>(horizon + s * (6.0 * hills.at(x) - 3.5 * std::fabs(trees.at(x)) - 0.9 * twigs.at(x)));
  for (int i = 0; i < 9; ++i) {
    const int from = rng.below(size.width), wide = static_cast<int>(rng.uniform(7.0, 22.0) * s);
    const float roof = static_cast<float>(horizon - rng.uniform(2.0, 13.0) * s);
    for (int x = from; x < std::min(size.width, from + wide); ++x) top[x] = std::min(top[x], roof);
  }
  return top;
}

// Street lights and windows: small warm points below the skyline, with their glow, in linear light.
ColorImage town_lights(Size size, const std::vector<float>& top, Rng rng) {
  const double s = scale_of(size);
  ColorImage lights(size);
  const int count = static_cast<int>(40 * size.width / (960.0 * s)) + 20;
  const double centre = rng.uniform(0.2, 0.8) * size.width, wide = 0.25 * size.width;
  for (int i = 0; i < count; ++i) {
    const int x = static_cast<int>(rng.uniform() < 0.7 ? centre + wide * rng.normal() : rng.uniform() * size.width);
    if (x < 0 || x >= size.width) continue;
    const int y = static_cast<int>(top[x] + rng.uniform(3.0, 16.0) * s);
    if (y >= size.height) continue;
    const float power = static_cast<float>(0.15 + 2.2 * std::pow(rng.uniform(), 4.0));
    const double tint = rng.uniform();
    lights(x, y) = power * (tint < 0.6 ? Rgb{1.0f, 0.62f, 0.25f} : tint < 0.9 ? Rgb{1.0f, 0.9f, 0.72f}
                                                                            : Rgb{0.6f, 1.0f, 0.8f});
  }
  const ColorImage near = gaussian_blur(lights, 0.75 * s), far = gaussian_blur(lights, 3.0 * s);
  return painted(size, [&](int x, int y) { return 4.5f * near(x, y) + 4.0f * far(x, y); });
}

struct Glow {
  double sigma;  // px at scale 1
  float gain;    // over the plain blur
  Rgb tint;
};

ColorImage glow_of(const ScalarImage& core, double s) {
  const Glow glows[] = {{2.2, 0.30f, {0.85f, 0.75f, 1.0f}},
                        {7.0, 0.30f, {0.55f, 0.52f, 1.0f}},
                        {24.0, 0.40f, {0.38f, 0.42f, 1.0f}},
                        {80.0, 0.85f, {0.36f, 0.42f, 1.0f}}};
  ColorImage sum(core.size());
  for (const Glow& glow : glows) {
    const ScalarImage blurred = gaussian_blur(core, glow.sigma * s);
    for (std::size_t i = 0; i < sum.pixels().size(); ++i)
      sum.pixels()[i] = sum.pixels()[i] + (glow.gain * blurred.pixels()[i]) * glow.tint;
  }
  return sum;
}

// Linear light of the clouds: dim by themselves, lit where the bolt is near.
ColorImage night_sky(Size size, const ScalarImage& core, double horizon, const Rng& rng) {
  const double s = scale_of(size);
  const ScalarImage shape = power_noise(size, {420.0 * s, 3.0, 3.0, 1.7, 1.0}, rng.child("cloud"));
  const ScalarImage dx = power_noise(size, {260.0 * s, 30.0 * s, 2.8}, rng.child("dx"));
  const ScalarImage dy = power_noise(size, {260.0 * s, 30.0 * s, 2.8}, rng.child("dy"));
  const ScalarImage cloud = warped(shape, dx, dy, 13.0 * s);
  const ScalarImage near = gaussian_blur(core, 130.0 * s), far = gaussian_blur(core, 330.0 * s);
  return painted(size, [&](int x, int y) {
    const float up = 1.0f - static_cast<float>(y / horizon);
    const float thick = smooth_step(-1.6f, 2.0f, cloud(x, y) + 0.9f * up);
    const float own = 0.006f + 0.016f * thick + 0.02f * smooth_step(0.25f, -0.1f, up);
    const float lit = (9.0f * near(x, y) + 3.5f * far(x, y)) * (0.10f + 1.25f * thick * thick);
    const Rgb night{0.62f, 0.72f, 1.0f}, violet{0.62f, 0.56f, 1.0f};
    const Rgb ember{0.016f, 0.009f, 0.005f};  // the town's light under the clouds
    const float low = std::exp(-std::max(0.0f, up) * 6.0f);
    return own * night + lit * violet + (low * (0.4f + thick)) * ember;
  });
}

Region below(Size size, const std::vector<float>& top) {
  Region region;
  region.role = RegionRole::Keep;
  for (int x = 0; x < size.width; x += 4) region.polygon.emplace_back(x, top[x] - 1.0);
  region.polygon.emplace_back(size.width - 0.5, top.back() - 1.0);
  region.polygon.emplace_back(size.width - 0.5, size.height - 0.5);
  region.polygon.emplace_back(-0.5, size.height - 0.5);
  return region;
}

}  // namespace

Scene draw_lightning(Size size, const Rng& rng, const Monitor& monitor) {
  const double s = scale_of(size), horizon = 0.93 * size.height;
  Scene scene;
  scene.polarity = Polarity::Glow;
  scene.branches = draw_tree(bolt_plan(size, horizon, rng.child("plan")), rng.child("tree"), monitor);
  monitor.report(0.2);
  const Image<BranchSample> field = branch_field(skeleton_of(size, scene.branches), 6.0 + 4.0 * s);
  const ScalarImage core = core_light(field, scene.branches, s, rng.child("flicker"));
  const ColorImage glow = glow_of(core, s), sky = night_sky(size, core, horizon, rng.child("sky"));
  monitor.report(0.6);
  const std::vector<float> top = skyline(size, horizon, rng.child("skyline"));
  const ColorImage lights = town_lights(size, top, rng.child("lights"));
  const Rgb white{0.97f, 0.95f, 1.0f};
  scene.color = painted(size, [&](int x, int y) {
    const float land = smooth_step(-0.7f, 0.7f, static_cast<float>(y) - top[x]);
    const Rgb air = sky(x, y) + core(x, y) * white;
    const Rgb ground{0.0025f, 0.0028f, 0.0035f};
    const Rgb light = mix(air, ground, land) + (1.0f - 0.75f * land) * glow(x, y) + lights(x, y);
    return Rgb{srgb_from_linear(light.r), srgb_from_linear(light.g), srgb_from_linear(light.b)};
  });
  scene.regions.push_back(below(size, top));
  scene.color = photograph(scene.color, {0.35, 0.007, 0.6, 0.6, 0.25}, rng.child("camera"));
  return scene;
}

}  // namespace ramify
