// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/compose/light.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "ramify/compose/light_glow.h"
#include "ramify/compose/light_layer.h"
#include "ramify/compose/light_strand.h"
#include "ramify/core/error.h"
#include "ramify/core/parallel.h"
#include "ramify/image/color.h"
#include "ramify/image/filter.h"
#include "ramify/image/sample.h"

using namespace ramify;

namespace {

constexpr Size kCanvas{360, 300};

// A trunk from the top edge downwards that sways, with three children to either side.
Skeleton tree(double phase, double trunk_radius, double child_radius) {
  Skeleton skeleton(kCanvas);
  std::vector<int> trunk;
  for (int i = 0; i <= 65; ++i) {
    const double y = 4.0 * i;
    const Node node{Vec3(180.0 + 14.0 * std::sin(0.035 * y + phase), y, 0.0), trunk_radius,
                    trunk.empty() ? kNone : trunk.back(), 0, 0};
    trunk.push_back(skeleton.append(node));
  }
  for (int child = 0; child < 6; ++child) {
    const double side = child % 2 ? 1.0 : -1.0;
    int parent = trunk[10 + 8 * child];
    const Vec3 base = skeleton[parent].position;
    for (int i = 1; i <= 26; ++i) {
      const double x = 3.5 * i;
      const Vec3 p = base + Vec3(side * x, 0.5 * x + 4.0 * std::sin(0.09 * x + phase + child), 0.0);
      parent = skeleton.append({p, child_radius, parent, 1, 0});
    }
  }
  return skeleton;
}

ScalarImage distance_to_lines(const Skeleton& skeleton) {
  ScalarImage distance(kCanvas, 1e9f);
  for (const Strand& s : make_strands(skeleton)) {
    for (int t = 0; t < s.count(); ++t) {
      for (int y = 0; y < kCanvas.height; ++y) {
        for (int x = 0; x < kCanvas.width; ++x) {
          distance(x, y) = std::min(distance(x, y), static_cast<float>((s.points[t] - Vec2(x, y)).norm()));
        }
      }
    }
  }
  return distance;
}

// A slow slope of tone with grain of about one grey level.
ColorImage ground(float low, float high, std::uint64_t seed) {
  ColorImage image(kCanvas);
  for (int y = 0; y < kCanvas.height; ++y) {
    for (int x = 0; x < kCanvas.width; ++x) {
      const float v = low + (high - low) * static_cast<float>(y) / kCanvas.height +
                      0.004f * static_cast<float>(hash01(seed, x, y) - 0.5);
      image(x, y) = {0.9f * v, v, std::min(1.0f, 1.2f * v)};
    }
  }
  return image;
}

struct Bolt {
  LightScene scene;
  Skeleton skeleton;
  ColorImage light;  // linear light of core and glow
};

// A flash whose glow is exactly a sum of the model's blurs.
Bolt make_bolt() {
  Bolt bolt;
  bolt.skeleton = tree(0.0, 3.5, 1.8);
  const ScalarImage distance = distance_to_lines(bolt.skeleton);
  ColorImage core(kCanvas);
  for (std::size_t i = 0; i < core.pixels().size(); ++i) {
    const float v = std::clamp(3.0f - distance.pixels()[i], 0.0f, 1.0f);
    core.pixels()[i] = {0.8f * v, 0.75f * v, 0.7f * v};
  }
  GlowModel model;
  model.weights = {{{0.1, 0.05, 0.0}, {0.1, 0.2, 0.1}, {0.0, 0.4, 0.3}}};
  const ColorImage glow = render_glow(model, core);
  bolt.scene.plate = ground(0.08f, 0.22f, 1);
  bolt.scene.background = bolt.scene.plate;
  bolt.scene.photo = ColorImage(kCanvas);
  bolt.light = ColorImage(kCanvas);
  for (std::size_t i = 0; i < core.pixels().size(); ++i) {
    bolt.light.pixels()[i] = core.pixels()[i] + glow.pixels()[i];
    for (int c = 0; c < 3; ++c) {
      const float total = linear_from_srgb(bolt.scene.plate.pixels()[i][c]) + bolt.light.pixels()[i][c];
      bolt.scene.photo.pixels()[i][c] = std::min(1.0f, srgb_from_linear(total));
    }
  }
  return bolt;
}

constexpr float kThrough = 0.55f;  // transmission on a vessel's axis

LightScene make_vessels(const Skeleton& skeleton, double radius) {
  LightScene scene;
  scene.plate = ground(0.55f, 0.7f, 2);
  scene.background = scene.plate;
  scene.photo = scene.plate;
  const ScalarImage distance = distance_to_lines(skeleton);
  for (std::size_t i = 0; i < scene.photo.pixels().size(); ++i) {
    const double d = distance.pixels()[i] / radius;
    const double through = std::exp(std::log(kThrough) * std::exp(-0.5 * d * d * d * d));
    if (d < 3.0) scene.photo.pixels()[i] = static_cast<float>(through) * scene.photo.pixels()[i];
  }
  return scene;
}

double quantile(std::vector<double> values, double q) {
  REQUIRE(!values.empty());
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(q * (static_cast<double>(values.size()) - 1.0))];
}

std::vector<double> differences(const ColorImage& a, const ColorImage& b, const ScalarImage& distance, double from,
                                double to) {
  const ColorImage lab_a = lab_from_srgb(gaussian_blur(a, 3.0)), lab_b = lab_from_srgb(gaussian_blur(b, 3.0));
  std::vector<double> out;
  for (std::size_t i = 0; i < distance.pixels().size(); ++i) {
    if (distance.pixels()[i] < from || distance.pixels()[i] >= to) continue;
    out.push_back(delta_e(lab_a.pixels()[i], lab_b.pixels()[i]));
  }
  return out;
}

}  // namespace

TEST_CASE("strands leave their parents at the rim and end free where the branch does") {
  const std::vector<Strand> strands = make_strands(tree(0.0, 8.0, 2.0));
  REQUIRE(strands.size() == 7);
  CHECK(strands[0].parent == kNone);
  CHECK_FALSE(strands[0].open_start);  // enters at the top edge
  CHECK(strands[0].open_end);
  for (std::size_t k = 1; k < strands.size(); ++k) {
    const Strand& child = strands[k];
    REQUIRE(child.parent == 0);
    const Vec2 start = child.points[child.first];
    double gap = 1e9;
    for (const Vec2& p : strands[0].points) gap = std::min(gap, (p - start).norm());
    CHECK(gap == Approx(9.0).margin(1.0));  // the parent's radius and half the child's
    CHECK(child.open_end);
    for (int t = 2; t < child.count() - 1; ++t) CHECK((child.points[t] - child.points[t - 1]).norm() < 1.1);
  }
}

TEST_CASE("an end on another branch is not open") {
  Skeleton skeleton(kCanvas);
  int a = skeleton.append({Vec3(40, 150, 0), 3.0, kNone, 0, 0});
  for (int x = 44; x <= 320; x += 4) a = skeleton.append({Vec3(x, 150, 0), 3.0, a, 0, 0});
  int b = skeleton.append({Vec3(180, 0, 0), 2.0, kNone, 0, 0});
  for (int y = 4; y <= 148; y += 4) b = skeleton.append({Vec3(180, y, 0), 2.0, b, 0, 0});
  const std::vector<Strand> strands = make_strands(skeleton);
  REQUIRE(strands.size() == 2);
  CHECK(strands[0].open_start);
  CHECK(strands[0].open_end);
  CHECK_FALSE(strands[1].open_start);
  CHECK_FALSE(strands[1].open_end);
}

TEST_CASE("the glow fit finds the weights a glow was made with and never goes negative") {
  ColorImage core(kCanvas);
  for (int y = 40; y < 260; ++y)
    for (int x = 178; x < 183; ++x) core(x, y) = {1.0f, 0.8f, 0.6f};
  GlowModel made;
  made.weights = {{{0.3, 0.0, 0.2}, {0.1, 0.2, 0.1}, {0.0, 0.5, 0.0}}};
  const ColorImage glow = render_glow(made, core);
  ScalarImage weight(kCanvas, 1.0f);
  for (int y = 0; y < kCanvas.height; ++y)
    for (int x = 170; x < 191; ++x) weight(x, y) = 0.0f;
  const GlowModel found = fit_glow(core, glow, weight);
  for (int c = 0; c < 3; ++c) {
    for (int k = 0; k < 3; ++k) CHECK(found.weights[c][k] == Approx(made.weights[c][k]).margin(0.02));
  }
  ColorImage ring = glow;  // something no blur of the core can make
  for (Rgb& v : ring.pixels()) v = {std::max(0.0f, 0.02f - v.r), 0.0f, v.b};
  for (const auto& channel : fit_glow(core, ring, weight).weights) {
    for (const double w : channel) CHECK(w >= 0.0);
  }
}

TEST_CASE("a flash on its own skeleton and plate is the photo again") {
  const Bolt bolt = make_bolt();
  const Composite out = compose_light(bolt.scene, bolt.skeleton, bolt.skeleton, CompositeMode::Emit, {}, Rng(1), {});
  const ScalarImage distance = distance_to_lines(bolt.skeleton);
  CHECK(quantile(differences(out.color, bolt.scene.photo, distance, 10.5, 1e6), 0.9) < 3.0);
  CHECK(quantile(differences(out.color, bolt.scene.photo, distance, 0.0, 3.5), 0.5) < 7.0);
  CHECK(quantile(differences(bolt.scene.plate, bolt.scene.photo, distance, 10.5, 30.0), 0.5) > 5.0);  // not for nothing
  CHECK(out.composite == CompositeMode::Emit);
}

TEST_CASE("a flash adds the same light whatever is behind it, but a burnt-out core hides it") {
  Bolt bolt = make_bolt();
  const Skeleton target = tree(1.3, 3.5, 1.8);
  const Composite dim = compose_light(bolt.scene, bolt.skeleton, target, CompositeMode::Emit, {}, Rng(2), {});
  const ColorImage dim_ground = bolt.scene.background;
  bolt.scene.background = ground(0.2f, 0.3f, 9);
  const Composite bright = compose_light(bolt.scene, bolt.skeleton, target, CompositeMode::Emit, {}, Rng(2), {});
  const ScalarImage distance = distance_to_lines(target);
  int compared = 0;
  std::vector<double> core, behind;  // how much brighter on the brighter ground, green
  for (std::size_t i = 0; i < dim_ground.pixels().size(); ++i) {
    const auto linear = [&](const ColorImage& image, int c) { return linear_from_srgb(image.pixels()[i][c]); };
    if (distance.pixels()[i] < 0.7f) {
      core.push_back(linear(bright.color, 1) - linear(dim.color, 1));
      behind.push_back(linear(bolt.scene.background, 1) - linear(dim_ground, 1));
    }
    for (int c = 0; c < 3; ++c) {
      if (bright.color.pixels()[i][c] > 0.99f || dim.color.pixels()[i][c] > 0.99f) continue;
      const float a = linear(dim.color, c) - linear(dim_ground, c);
      const float b = linear(bright.color, c) - linear(bolt.scene.background, c);
      if (a < -1e-4f || b < -1e-4f) FAIL("light was taken away at pixel " << i);
      if (distance.pixels()[i] < 10.0f) continue;
      compared += std::abs(a - b) < 1e-4f;
      if (std::abs(a - b) >= 1e-4f) FAIL("light differs by " << a - b << " at pixel " << i);
    }
  }
  CHECK(compared > 100000);
  REQUIRE(core.size() > 100);
  CHECK(quantile(core, 0.5) < 0.5 * quantile(behind, 0.5));
}

TEST_CASE("the glow of each width is told from that of a thick branch beside it") {
  const Size size{200, 160};
  GlowModel model;
  for (auto& channel : model.weights) channel = {0.2, 0.1, 0.3};
  std::vector<ColorImage> glows;
  for (const int x : {60, 78}) {  // 18 px apart: each lies well within the other's glow
    ColorImage core(size);
    for (int y = 0; y < size.height; ++y) core(x, y) = {1.0f, 0.9f, 0.8f};
    glows.push_back(render_glow(model, core));
  }
  ColorImage light(size);
  for (std::size_t i = 0; i < light.pixels().size(); ++i)
    light.pixels()[i] = 1.4f * glows[0].pixels()[i] + 0.1f * glows[1].pixels()[i];
  const std::vector<double> gains = fit_gains(glows, light, ScalarImage(size, 1.0f));
  REQUIRE(gains.size() == 2);
  CHECK(gains[0] == Approx(1.4).margin(0.15));
  CHECK(gains[1] == Approx(0.1).margin(0.15));
  glows[1] = ColorImage(size);  // nothing to tell it by
  CHECK(fit_gains(glows, light, ScalarImage(size, 1.0f))[1] == Approx(1.0));
}

TEST_CASE("new vessels are as dark as the photo's and lie on the skeleton") {
  const double radius = 3.0;
  const Skeleton own = tree(0.0, radius, radius), target = tree(2.1, radius, radius);
  const LightScene scene = make_vessels(own, radius);
  const Composite out = compose_light(scene, own, target, CompositeMode::Absorb, {}, Rng(3), {});
  const ScalarImage own_distance = distance_to_lines(own), distance = distance_to_lines(target);
  std::vector<double> through, beside;
  int sourced = 0, axis = 0;
  for (const Strand& s : make_strands(target)) {
    for (int t = s.first + 6; t < s.count() - 20; t += 2) {
      if (s.points[t].y() > kCanvas.height - 10) continue;
      const int x = static_cast<int>(std::lround(s.points[t].x())), y = static_cast<int>(std::lround(s.points[t].y()));
      through.push_back(out.color(x, y).g / scene.background(x, y).g);
      ++axis;
      if (out.owner(x, y) == kNone) continue;
      const Vec2 from = out.source(x, y).cast<double>();
      sourced +=
          own_distance.clamped(static_cast<int>(std::lround(from.x())), static_cast<int>(std::lround(from.y()))) < 2.0f;
    }
  }
  for (std::size_t i = 0; i < distance.pixels().size(); ++i) {
    if (distance.pixels()[i] > 16.0f)
      beside.push_back(std::abs(out.color.pixels()[i].g - scene.background.pixels()[i].g));
  }
  CHECK(quantile(through, 0.5) == Approx(kThrough).margin(0.05));
  CHECK(quantile(through, 0.9) < kThrough + 0.15);
  CHECK(sourced > 0.95 * axis);
  CHECK(quantile(beside, 1.0) == 0.0);
}

TEST_CASE("vessels keep their width and a free tip fades") {
  const double radius = 3.0;
  const Skeleton own = tree(0.0, radius, radius), target = tree(2.1, radius, radius);
  const LightScene scene = make_vessels(own, radius);
  const Composite out = compose_light(scene, own, target, CompositeMode::Absorb, {}, Rng(4), {});
  const auto through = [&](const Vec2& p) {
    return sample_bilinear(out.color, p).g / sample_bilinear(scene.background, p).g;
  };
  std::vector<double> widths;
  for (const Strand& s : make_strands(target)) {
    for (int t = s.first + 12; t < s.count() - 24; t += 3) {
      const double half = 0.5 * (1.0 + through(s.points[t]));
      for (const double side : {-1.0, 1.0}) {
        double u = 0.0;
        while (u < 8.0 && through(s.points[t] + side * u * s.normals[t]) < half) u += 0.1;
        widths.push_back(u);
      }
    }
    if (s.parent != kNone) CHECK(through(s.points.back()) > 0.95);
  }
  const double made = radius * std::pow(-2.0 * std::log(std::log(0.5 * (1.0 + kThrough)) / std::log(kThrough)), 0.25);
  CHECK(quantile(widths, 0.5) == Approx(made).epsilon(0.1));
}

TEST_CASE("sources near home can be banned") {
  const Skeleton own = tree(0.0, 3.0, 3.0);
  const LightScene scene = make_vessels(own, 3.0);
  ComposeOptions options;
  options.leave_out = 40.0;
  const Composite out = compose_light(scene, own, own, CompositeMode::Absorb, options, Rng(5), {});
  int owned = 0, near = 0;
  for (int y = 0; y < kCanvas.height; ++y) {
    for (int x = 0; x < kCanvas.width; ++x) {
      if (out.owner(x, y) == kNone) continue;
      ++owned;
      near += (out.source(x, y).cast<double>() - Vec2(x, y)).norm() < 20.0;
    }
  }
  REQUIRE(owned > 1000);
  CHECK(near < 0.05 * owned);
  CHECK(quantile(differences(out.color, scene.photo, distance_to_lines(own), 0.0, 6.0), 0.5) < 4.0);
}

TEST_CASE("a stroke touches its parent though the parent's light is narrower than its width") {
  // The photo's trunk is 7 px wide; drawn twice as wide at most, it cannot fill a new one of 18 px.
  const Bolt bolt = make_bolt();
  const Skeleton target = tree(1.0, 9.0, 1.8);
  const Composite out = compose_light(bolt.scene, bolt.skeleton, target, CompositeMode::Emit, {}, Rng(8), {});
  const std::vector<Strand> strands = make_strands(target);
  for (std::size_t k = 1; k < strands.size(); ++k) {
    std::vector<double> light;  // along the child, from the parent's centre line on
    for (int t = 0; t < 45; ++t) {
      const Vec2 p = strands[k].points[t];
      light.push_back(luma(sample_bilinear(out.color, p)) - luma(sample_bilinear(bolt.scene.background, p)));
    }
    const double usual = quantile({light.begin() + 20, light.end()}, 0.5);
    CHECK(*std::min_element(light.begin(), light.begin() + 20) > 0.6 * usual);
  }
}

namespace {

constexpr double kThick = 12.0;  // px, radius
constexpr double kBright = 8.0;  // px, half width of what shines in it

// Straight strokes from edge to edge at these places.
Skeleton upright_strokes(const std::vector<double>& places) {
  Skeleton skeleton(kCanvas);
  for (const double x : places) {
    int parent = kNone;
    for (int y = 0; y < kCanvas.height; y += 4) parent = skeleton.append({Vec3(x, y, 0.0), kThick, parent, 0, 0});
  }
  return skeleton;
}

// A thick stroke in the middle with hairs on its right, 2 px wide, that reach 13 px beyond its rim.
Bolt hairy_bolt() {
  Bolt bolt;
  bolt.skeleton = upright_strokes({180.0});
  ColorImage core(kCanvas), light(kCanvas);
  for (int y = 0; y < kCanvas.height; ++y) {
    for (int x = 0; x < kCanvas.width; ++x) {
      const float v = std::clamp(static_cast<float>(kBright + 0.5 - std::abs(x - 180.0)), 0.0f, 1.0f);
      core(x, y) = {0.8f * v, 0.75f * v, 0.7f * v};
      if (x > 180 && x < 205 && y % 12 < 2) light(x, y) = {0.5f, 0.5f, 0.5f};
    }
  }
  bolt.scene.plate = ground(0.08f, 0.1f, 1);
  bolt.scene.background = bolt.scene.plate;
  bolt.scene.photo = ColorImage(kCanvas);
  for (std::size_t i = 0; i < core.pixels().size(); ++i) {
    for (int c = 0; c < 3; ++c) {
      const float added = std::max(core.pixels()[i][c], light.pixels()[i][c]);
      const float total = linear_from_srgb(bolt.scene.plate.pixels()[i][c]) + added;
      bolt.scene.photo.pixels()[i][c] = std::min(1.0f, srgb_from_linear(total));
    }
  }
  return bolt;
}

}  // namespace

TEST_CASE("a thick stroke has even edges where hairs leave the one it is copied from") {
  const Bolt bolt = hairy_bolt();
  const Composite result = compose_light(bolt.scene, bolt.skeleton, upright_strokes({120.0}), CompositeMode::Emit, {}, Rng(1), {});
  const auto uneven = [](const ColorImage& image, double middle) {
    std::vector<double> light;
    for (int y = 20; y < kCanvas.height - 20; ++y) {
      for (const double side : {-1.0, 1.0}) {
        for (double d = 1.2 * kThick; d < 1.8 * kThick; d += 1.0) {
          light.push_back(linear_from_srgb(luma(image(static_cast<int>(middle + side * d), y))));
        }
      }
    }
    return quantile(light, 0.98) - quantile(light, 0.5);
  };
  REQUIRE(uneven(bolt.scene.photo, 180.0) > 0.3);
  CHECK(uneven(result.color, 120.0) < 0.05);
}

TEST_CASE("what shows beside a stroke before a bright cloud is no light of its own") {
  const std::vector<Strand> strands = make_strands(upright_strokes({180.0}));
  for (const float behind : {0.1f, 0.75f}) {
    const ColorImage plate(kCanvas, {behind, behind, behind});
    ColorImage photo = plate;
    for (int y = 0; y < kCanvas.height; ++y) {
      for (int x = 0; x < kCanvas.width; ++x) {
        if (std::abs(x - 180.0) < 3.0 * kThick && y % 20 < 2) photo(x, y).r += 0.2f;
        if (std::abs(x - 180.0) < kThick) photo(x, y) = {0.98f, 0.97f, 0.95f};
      }
    }
    const LightLayer layer = make_light_layer(photo, plate, strands, CompositeMode::Emit, true);
    double beside = 0.0;
    for (int y = 100; y < 200; y += 20) beside += 0.2 * layer.value(180 + static_cast<int>(1.8 * kThick), y).r;
    CAPTURE(behind);
    if (behind < 0.5f) {
      CHECK(beside > 0.005);
    } else {
      CHECK(beside == 0.0);
    }
    CHECK(layer.value(180, 150).r > 0.5f);
  }
}

TEST_CASE("no line runs along the rim of a stroke whose light is narrower than its width") {
  const std::vector<Strand> strands = make_strands(upright_strokes({180.0}));
  LightLayer layer;
  layer.mode = CompositeMode::Emit;
  layer.glow_model.weights = {{{0.0, 0.0, 0.0}, {0.1, 0.1, 0.1}, {0.9, 0.9, 0.9}}};
  ColorImage value(kCanvas, {0.05f, 0.05f, 0.05f}), core(kCanvas);  // some halo everywhere
  for (int y = 0; y < kCanvas.height; ++y) {
    for (int x = 0; x < kCanvas.width; ++x) {
      if (std::abs(x - 180.0) <= kBright) core(x, y) = value(x, y) = {0.8f, 0.75f, 0.7f};
    }
  }
  const ColorImage result = apply_light(layer, ground(0.08f, 0.1f, 1), value, core, kept_glow_share(strands, kCanvas),
                                        ScalarImage(kCanvas));
  for (int x = 180 + static_cast<int>(kBright) + 1; x < 180 + 30; ++x) {
    CAPTURE(x);
    CHECK(luma(result(x + 1, 150)) - luma(result(x, 150)) < 0.006);
  }
}

TEST_CASE("what stands in front hides the light") {
  Bolt bolt = make_bolt();
  bolt.scene.front = Mask(kCanvas, 0);
  for (int y = 200; y < kCanvas.height; ++y)
    for (int x = 0; x < kCanvas.width; ++x) bolt.scene.front(x, y) = 255;
  const Composite out =
      compose_light(bolt.scene, bolt.skeleton, tree(0.7, 3.5, 1.8), CompositeMode::Emit, {}, Rng(6), {});
  for (int x = 0; x < kCanvas.width; ++x) {
    CHECK(out.owner(x, 250) == kNone);
    for (int c = 0; c < 3; ++c) CHECK(out.color(x, 250)[c] == Approx(bolt.scene.background(x, 250)[c]).margin(1e-4));
  }
}

TEST_CASE("light is the same for any number of threads and differs between seeds") {
  const Bolt bolt = make_bolt();
  const Skeleton target = tree(1.0, 3.5, 1.8);
  const auto make = [&](int threads, int seed) {
    set_thread_count(threads);
    return compose_light(bolt.scene, bolt.skeleton, target, CompositeMode::Emit, {}, Rng(seed), {});
  };
  const Composite one = make(1, 7), two = make(2, 7), eight = make(8, 7), other = make(2, 8);
  set_thread_count(0);
  CHECK(one.color == two.color);
  CHECK(one.color == eight.color);
  CHECK(one.owner == eight.owner);
  CHECK_FALSE(one.color == other.color);
}

TEST_CASE("a photo without anything to copy is refused") {
  const Skeleton own = tree(0.0, 3.0, 3.0);
  LightScene scene = make_vessels(own, 3.0);
  scene.unusable = Mask(kCanvas, 255);
  CHECK_THROWS_AS(compose_light(scene, own, own, CompositeMode::Absorb, {}, Rng(1), {}), InputError);
}
