// SPDX-License-Identifier: GPL-3.0-or-later
// The back of an eye: vessels that spread from the optic disc over orange tissue, seen through a round field.
#include <algorithm>
#include <cmath>

#include "ramify/image/filter.h"
#include "ramify/synthetic/branch_field.h"
#include "ramify/synthetic/noise.h"
#include "ramify/synthetic/scene.h"
#include "ramify/synthetic/tree.h"

namespace ramify {
namespace {

// Landmarks of the fundus, px.
struct Eye {
  Vec2 centre, disc, macula;
  double field = 0.0, disc_radius = 0.0;
  double side = 1.0;  // +1: the macula lies to the right of the disc
};

Eye eye_of(Size size, Rng rng) {
  Eye eye;
  const double w = size.width, h = size.height, s = scale_of(size);
  eye.side = rng.uniform() < 0.5 ? 1.0 : -1.0;
  eye.centre = Vec2(0.5 * w, 0.5 * h);
  eye.field = 0.46 * std::hypot(w, h);
  eye.disc = eye.centre + Vec2(-eye.side * 0.29 * w, h * rng.uniform(-0.05, 0.05));
  eye.macula = eye.centre + Vec2(eye.side * 0.08 * w, h * rng.uniform(0.0, 0.07));
  eye.disc_radius = 44.0 * s;
  return eye;
}

TreePlan vessel_plan(Size size, const Eye& eye, Rng rng) {
  const double s = scale_of(size);
  TreePlan plan;
  plan.size = size;
  plan.clearance = 7.0 * s;
  plan.thinnest = 0.8;
  plan.radius_noise = 0.05;
  plan.hub = true;
  plan.allowed = [eye, s](const Vec2& p) { return (p - eye.macula).norm() > 34.0 * s; };
  plan.seen = [eye](const Vec2& p) { return (p - eye.centre).norm() < eye.field; };
  // Four arcades (two each way bend around the macula), two nasal vessels, two thin ones towards the macula.
  struct Main { double angle, radius, home, homing; };
  const Main mains[] = {{-1.35, 4.6, -0.05, 0.0048}, {1.35, 4.8, 0.05, 0.0048}, {-1.9, 3.2, -2.35, 0.003},
                        {1.85, 3.0, 2.3, 0.003},     {-0.75, 2.2, -0.25, 0.006}, {0.8, 2.2, 0.3, 0.006},
                        {2.75, 2.4, 2.9, 0.002},     {-2.6, 2.0, -2.8, 0.002}};
  for (const Main& main : mains) {
    const auto turned = [&](double angle) { return eye.side > 0 ? angle : kPi - angle; };
    const double angle = turned(main.angle + rng.uniform(-0.12, 0.12));
    const TreeCourse course{.bend_length = 150.0 * s, .bend_angle = 0.17, .ripple_length = 36.0 * s, .ripple_angle = 0.09,
                        .homing = main.homing / s, .home = turned(main.home + rng.uniform(-0.15, 0.15))};
    plan.roots.push_back({.start = eye.disc + 7.0 * s * direction_of(angle), .heading = angle, .radius = main.radius * s,
                          .tip_share = 0.3, .course = course});
  }
  const auto winding = [s](double bend) {
    return TreeCourse{.bend_length = 90.0 * s, .bend_angle = bend, .ripple_length = 22.0 * s, .ripple_angle = 0.13};
  };
  plan.levels.push_back({.count = 18, .angle_low = 0.5, .angle_high = 1.0, .length_low = 0.3, .length_high = 0.7,
                         .ratio_low = 0.35, .ratio_high = 0.65, .tip_share = 0.4, .shortest = 60.0 * s,
                         .alternate = 0.65, .first = 0.12, .last = 0.95, .course = winding(0.3)});
  plan.levels.push_back({.count = 32, .angle_low = 0.5, .angle_high = 1.15, .length_low = 0.25, .length_high = 0.7,
                         .ratio_low = 0.4, .ratio_high = 0.65, .tip_share = 0.5, .shortest = 34.0 * s,
                         .alternate = 0.6, .first = 0.12, .last = 0.95, .course = winding(0.35)});
  plan.levels.push_back({.count = 34, .angle_low = 0.5, .angle_high = 1.2, .length_low = 0.25, .length_high = 0.7,
                         .ratio_low = 0.5, .ratio_high = 0.75, .tip_share = 0.7, .shortest = 22.0 * s,
                         .alternate = 0.6, .first = 0.15, .last = 0.95, .course = winding(0.4)});
  return plan;
}

ColorImage fundus(Size size, const Eye& eye, const Rng& rng) {
  const double s = scale_of(size);
  const ScalarImage shade = power_noise(size, {420.0 * s, 60.0 * s, 3.0}, rng.child("shade"));
  const ScalarImage choroid = power_noise(size, {46.0 * s, 5.0, 2.3, 1.5, 1.0}, rng.child("choroid"));
  const ScalarImage fine = power_noise(size, {7.0, 2.0, 1.6}, rng.child("fine"));
  const ScalarImage cup = power_noise(size, {40.0 * s, 4.0 * s, 2.4}, rng.child("cup"));
  return painted(size, [&](int x, int y) {
    const Vec2 p(x, y);
    const float from_disc = static_cast<float>((p - eye.disc).norm() / s);
    const float from_macula = static_cast<float>((p - eye.macula).norm() / s);
    const float bright = std::exp(-std::pow(from_disc / 190.0f, 1.2f));
    const float dark = std::exp(-0.5f * std::pow(from_macula / 48.0f, 2.0f));
    const float pit = std::exp(-0.5f * std::pow(from_macula / 14.0f, 2.0f));
    Rgb color{0.800f, 0.352f, 0.235f};
    color = mix(color, Rgb{0.885f, 0.490f, 0.330f}, 0.75f * bright);
    color = mix(color, Rgb{0.560f, 0.165f, 0.095f}, 0.62f * dark + 0.2f * pit);
    const float texture = 1.0f + 0.035f * shade(x, y) + 0.016f * choroid(x, y) + 0.008f * fine(x, y);
    color = texture * color;
    color.g *= 1.0f + 0.025f * choroid(x, y);
    // The disc: pale, brighter in its cup, with a soft rim.
    const float rim = static_cast<float>((p - eye.disc).norm() - eye.disc_radius) + 2.0f * cup(x, y);
    const float in_cup = std::exp(-0.5f * std::pow(static_cast<float>((p - eye.disc).norm() / (0.42 * eye.disc_radius)), 2.0f));
    const Rgb disc = mix(Rgb{0.930f, 0.640f, 0.415f}, Rgb{0.985f, 0.900f, 0.690f}, in_cup);
    return mix(color, (1.0f + 0.03f * cup(x, y)) * disc, coverage(rim, static_cast<float>(4.0 * s)));
  });
}

Region field_outside(Size size, const Eye& eye) {
  // The corners as one polygon: the frame, then the circle the other way round.
  Region region;
  region.role = RegionRole::Outside;
  const double right = size.width - 0.5, bottom = size.height - 0.5;
  region.polygon = {{-0.5, -0.5}, {right, -0.5}, {right, bottom}, {-0.5, bottom}, {-0.5, -0.5}};
  for (int i = 0; i <= 180; ++i)
    region.polygon.push_back(eye.centre + eye.field * direction_of(-0.75 * kPi - 2.0 * kPi * i / 180.0));
  return region;
}

// Where all vessels come from; the rim's softness is part of it.
Region disc_landmark(Size size, const Eye& eye) {
  Region region;
  region.role = RegionRole::Landmark;
  for (int i = 0; i < 48; ++i)
    region.polygon.push_back(eye.disc + (eye.disc_radius + 4.0 * scale_of(size)) * direction_of(2.0 * kPi * i / 48.0));
  return region;
}

}  // namespace

Scene draw_vessel(Size size, const Rng& rng, const Monitor& monitor) {
  const double s = scale_of(size);
  const Eye eye = eye_of(size, rng.child("eye"));
  Scene scene;
  scene.polarity = Polarity::Dark;
  scene.branches = draw_tree(vessel_plan(size, eye, rng.child("plan")), rng.child("tree"), monitor);
  monitor.report(0.4);
  const Image<BranchSample> field = branch_field(skeleton_of(size, scene.branches), 10.0 * s);
  const ColorImage tissue = fundus(size, eye, rng.child("tissue"));
  // Every other vessel of the disc is an artery: brighter blood, stronger reflex.
  std::vector<bool> arterial(scene.branches.size());
  for (std::size_t b = 0; b < scene.branches.size(); ++b)
    arterial[b] = scene.branches[b].parent ? arterial[scene.branches[b].parent->branch] : b % 2 == 0;
  const ScalarImage flow = power_noise(size, {70.0 * s, 8.0 * s, 2.4}, rng.child("flow"));
  scene.color = painted(size, [&](int x, int y) {
    const float away = static_cast<float>((Vec2(x, y) - eye.centre).norm());
    const float light = 1.0f - 0.30f * std::pow(away / static_cast<float>(eye.field), 3.5f);
    const float seen = coverage(away - static_cast<float>(eye.field), 1.6f);
    const BranchSample& at = field(x, y);
    Rgb color = tissue(x, y);
    if (at.branch != kNone) {
      // Blood absorbs green and blue; a column of blood is darkest in the middle, where a reflex lies on thick vessels.
      const float thick = smooth_step(0.8f, 4.0f, at.radius / static_cast<float>(s));
      const float round = std::sqrt(std::max(0.0f, 1.0f - std::pow(std::min(1.0f, std::fabs(at.across) / at.radius), 2.0f)));
      const float strength = (0.62f + 0.38f * thick) * (1.0f + 0.06f * flow(x, y));
      const float artery = arterial[at.branch] ? 1.0f : 0.0f;
      const Rgb passed{1.0f - (0.28f - 0.09f * artery) * strength, 1.0f - (0.57f - 0.06f * artery) * strength,
                       1.0f - 0.42f * strength};
      const float inside = coverage(at.distance, 0.45f) * (0.82f + 0.18f * round);
      color = mix(color, color * passed, inside);
      const float reflex = std::exp(-0.5f * std::pow(at.across / (0.22f * at.radius), 2.0f));
      color = color + ((0.06f + 0.07f * artery) * reflex * smooth_step(2.2f, 4.0f, at.radius)) * Rgb{1.0f, 0.75f, 0.6f};
    }
    return mix(Rgb{0.012f, 0.008f, 0.008f}, light * color, seen);
  });
  scene.regions.push_back(field_outside(size, eye));
  scene.regions.push_back(disc_landmark(size, eye));
  scene.color = photograph(scene.color, {0.5, 0.009, 0.55, 0.5, 0.0}, rng.child("camera"));
  return scene;
}

}  // namespace ramify
