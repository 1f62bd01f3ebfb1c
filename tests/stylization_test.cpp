// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/growth/stylization.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "ramify/core/error.h"
#include "ramify/graph/plan.h"
#include "ramify/growth/importance.h"
#include "ramify/skeleton/draw.h"
#include "ramify/skeleton/statistics.h"

using namespace ramify;

namespace {

ColorImage grey(const ScalarImage& values) {
  ColorImage out(values.size());
  for (std::size_t i = 0; i < values.pixels().size(); ++i) out.pixels()[i] = {values.pixels()[i], values.pixels()[i], values.pixels()[i]};
  return out;
}

// White with a dark ring of radius 40 in the middle of 128 x 128 px.
ColorImage ring() {
  ScalarImage out(128, 128, 1.0f);
  for (int y = 0; y < 128; ++y) {
    for (int x = 0; x < 128; ++x) {
      const double d = std::abs(std::hypot(x - 64, y - 64) - 40.0);
      out(x, y) = static_cast<float>(std::clamp((d - 2.0) / 2.0, 0.0, 1.0));
    }
  }
  return grey(out);
}

}  // namespace

TEST_CASE("importance: darkness alone, edges alone, three to one") {
  ScalarImage ramp(64, 32);
  for (int y = 0; y < 32; ++y) {
    for (int x = 0; x < 64; ++x) ramp(x, y) = static_cast<float>(x) / 63.0f;
  }
  ImportanceOptions options;
  options.edges = 0.0;
  CHECK(importance_map(grey(ramp), options)(20, 10) == Approx(1.0 - 20.0 / 63.0).margin(1e-5));
  options.light = true;
  CHECK(importance_map(grey(ramp), options)(20, 10) == Approx(20.0 / 63.0).margin(1e-5));
  options.light = false;
  options.edges = 3.0;
  options.blur = 0.0;
  // The ramp's slope is the same everywhere, so it is its own 99th percentile.
  CHECK(importance_map(grey(ramp), options)(20, 10) == Approx((3.0 + 1.0 - 20.0 / 63.0) / 4.0).margin(1e-3));
  const ScalarImage flat = importance_map(grey(ScalarImage(16, 16, 0.25f)), options);
  CHECK(flat(8, 8) == Approx(0.75 / 4.0).margin(1e-4));
}

TEST_CASE("stylize: the drawing lies on what is important, more so with the partial metric than with sums") {
  // Three dark waves between two uprights: along them is a long way, across the light ground a short one.
  ScalarImage light(192, 192, 1.0f);
  for (int x = 12; x < 180; ++x) {
    for (const int middle : {40, 96, 152}) {
      const double y0 = middle + 18.0 * std::sin(x * 2.0 * kPi / 42.0);
      for (int y = 0; y < 192; ++y) light(x, y) = std::min(light(x, y), static_cast<float>(std::clamp(0.35 * std::abs(y - y0), 0.0, 1.0)));
    }
  }
  for (int y = 20; y < 172; ++y) light(12, y) = light(179, y) = 0.0f;
  ImportanceOptions darkness;
  darkness.edges = 0.0;
  const ScalarImage importance = importance_map(grey(light), darkness);
  for (const std::uint64_t seed : {1, 2, 3}) {
    double on_lines[2] = {0.0, 0.0};
    std::vector<int> ends[2];
    for (int i = 0; i < 2; ++i) {
      StylizeOptions options;
      options.metric.metric = i == 0 ? Metric::Sum : Metric::Partial;
      options.endpoints = 120;
      options.least = 0.5;
      const Stylization made = stylize(importance, {}, std::nullopt, options, Rng(seed), {});
      ends[i] = made.endpoints;
      const Skeleton skeleton = dendrite_skeleton(made.dendrite, 1.0, {});
      CHECK(find_crossings(skeleton).empty());
      int near = 0;
      for (const Node& node : skeleton.nodes()) {
        near += importance(static_cast<int>(node.position.x()), static_cast<int>(node.position.y())) > 0.4f ? 1 : 0;
      }
      on_lines[i] = static_cast<double>(near) / skeleton.count();
    }
    CHECK(ends[0] == ends[1]);
    CHECK(on_lines[1] > 0.9);
    CHECK(on_lines[1] > on_lines[0] + 0.1);
  }
}

TEST_CASE("main_line_node: from there the dearest step to most of the lines is the cheapest possible") {
  // A ring far from the middle, which is dear itself; and one cheap pixel in the middle that leads nowhere.
  ScalarImage importance = importance_map(ring(), {});
  importance(64, 64) = 1.0f;
  const Lattice lattice = importance_lattice(importance, {}, {}, Rng(4));
  const int node = main_line_node(lattice, Vec2(64, 64));
  CHECK(std::abs(std::hypot(node % 128 - 64, node / 128 - 64) - 40.0) < 8.0);
  // By plans: the peak that a tenth of all nodes can be reached with, from there and from any of 60 other nodes.
  const auto peak_to_a_tenth = [&](int from) {
    PlanOptions options;
    options.metric.metric = Metric::Partial;
    const Plan plan = plan_paths(lattice, std::vector<int>{from}, options);
    std::vector<double> peaks;
    for (int i = 0; i < lattice.count(); ++i) peaks.push_back(path_cost(plan, i));
    std::nth_element(peaks.begin(), peaks.begin() + lattice.count() / 10, peaks.end());
    return peaks[static_cast<std::size_t>(lattice.count() / 10)];
  };
  const double own = peak_to_a_tenth(node);
  Rng rng(8);
  for (int i = 0; i < 60; ++i) CHECK(own <= peak_to_a_tenth(rng.below(lattice.count())) + 1e-9);
}

TEST_CASE("emphasize: a rolling mean that runs on into the parent and thins at the tip") {
  Skeleton line({100, 10});
  for (int i = 0; i < 80; ++i) line.append({Vec3(i, 5, 0), 1.0, i - 1, 0, 0});
  for (int i = 0; i < 30; ++i) line.append({Vec3(40 + i, 5 + 0.1 * i, 0), 1.0, i == 0 ? 40 : 79 + i, 1, 0});
  ImportanceThickness options;
  options.thin = 0.5;
  options.thick = 2.5;
  options.window = 10;
  const Skeleton out = emphasize(line, ScalarImage(100, 10, 1.0f), options);
  CHECK(out[0].radius == Approx(2.5));                      // at the root the window is shorter
  CHECK(out[40].radius == Approx(2.5));
  CHECK(out[79].radius == Approx(0.5 + 2.0 * 11.0 / 21.0)); // half the window hangs over the end
  CHECK(out[80].radius == Approx(2.5));                     // the child's base lies against its parent
  CHECK(out[109].radius == Approx(0.5 + 2.0 * 11.0 / 21.0));
  ScalarImage half(100, 10, 0.0f);
  for (int y = 0; y < 10; ++y) {
    for (int x = 0; x < 30; ++x) half(x, y) = 1.0f;
  }
  CHECK(emphasize(line, half, options)[30].radius == Approx(0.5 + 2.0 * 10.0 / 21.0));
}

TEST_CASE("stylize: endpoints keep to the mask and to what is important enough") {
  const ScalarImage importance = importance_map(ring(), {});
  Mask allowed(128, 128, 1);
  for (int y = 0; y < 128; ++y) {
    for (int x = 90; x < 128; ++x) allowed(x, y) = 0;
  }
  StylizeOptions options;
  options.endpoints = 200;
  options.least = 0.2;
  const Stylization made = stylize(importance, allowed, Vec2(20, 20), options, Rng(2), {});
  for (const int node : made.endpoints) {
    CHECK(node % 128 < 90);
    CHECK(importance.pixels()[static_cast<std::size_t>(node)] >= 0.2f);
  }
  CHECK_THROWS_AS(stylize(importance, allowed, Vec2(100, 20), options, Rng(2), {}), InputError);
  options.least = 1.0;
  CHECK_THROWS_AS(stylize(ScalarImage(64, 64, 0.1f), {}, std::nullopt, options, Rng(2), {}), InputError);
}
