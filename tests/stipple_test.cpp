// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/graph/stipple.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "ramify/core/random.h"

using namespace ramify;

namespace {

ScalarImage random_cost(int width, int height, Rng rng) {
  ScalarImage cost(width, height);
  for (float& c : cost.pixels()) c = static_cast<float>(rng.uniform());
  return cost;
}

// The published loop to the letter: the frontier is searched through from end to end, no queue, no rim of cells. Costs
// without jitter.
std::vector<int> stipple_by_search(const ScalarImage& cost, int start, double threshold, float floor) {
  const int w = cost.width(), n = w * cost.height();
  std::vector<float> distance(static_cast<std::size_t>(n), std::numeric_limits<float>::infinity());
  std::vector<bool> frontier(static_cast<std::size_t>(n), false);
  std::vector<int> out;
  distance[static_cast<std::size_t>(start)] = 0.0f;
  frontier[static_cast<std::size_t>(start)] = true;
  for (;;) {
    int u = -1;
    for (int i = 0; i < n; ++i) {
      if (frontier[static_cast<std::size_t>(i)] && (u < 0 || distance[static_cast<std::size_t>(i)] < distance[static_cast<std::size_t>(u)])) u = i;
    }
    if (u < 0) return out;
    if (distance[static_cast<std::size_t>(u)] > threshold) {
      out.push_back(u);
      distance[static_cast<std::size_t>(u)] = 0.0f;
      continue;
    }
    frontier[static_cast<std::size_t>(u)] = false;
    const int x = u % w, y = u / w;
    for (const auto& [dx, dy] : {std::pair{1, 0}, {-1, 0}, {0, 1}, {0, -1}}) {
      if (!cost.contains(x + dx, y + dy)) continue;
      const int v = (y + dy) * w + x + dx;
      const float edge = 0.5f * (cost(x, y) + floor + (cost(x + dx, y + dy) + floor));
      if (distance[static_cast<std::size_t>(u)] + edge < distance[static_cast<std::size_t>(v)]) {
        distance[static_cast<std::size_t>(v)] = distance[static_cast<std::size_t>(u)] + edge;
        frontier[static_cast<std::size_t>(v)] = true;
      }
    }
  }
}

double nearest_spacing(const std::vector<int>& pixels, int width) {
  double sum = 0.0;
  for (const int a : pixels) {
    double best = 1e9;
    for (const int b : pixels) {
      if (a != b) best = std::min(best, std::hypot(a % width - b % width, a / width - b / width));
    }
    sum += best;
  }
  return sum / static_cast<double>(pixels.size());
}

}  // namespace

TEST_CASE("stipple: the same points as the published loop without a queue") {
  for (int i = 0; i < 20; ++i) {
    Rng rng = Rng(5).child("case", static_cast<std::uint64_t>(i));
    const ScalarImage cost = random_cost(8 + rng.below(20), 8 + rng.below(20), rng.child("cost"));
    const int start = rng.below(static_cast<int>(cost.pixels().size()));
    StippleOptions options;
    options.jitter = 0.0;
    const double threshold = rng.uniform(0.7, 4.0);
    const Stipples found = stipple(cost, {}, {start}, threshold, options);
    CHECK(found.pixels == stipple_by_search(cost, start, threshold, static_cast<float>(options.floor)));
  }
}

TEST_CASE("stipple: on even ground the count follows the threshold and points keep apart") {
  const int size = 160;
  const ScalarImage cost(size, size, 1.0f);
  StippleOptions options;
  options.floor = 1e-6;
  for (const double threshold : {6.0, 9.0, 14.0}) {
    const Stipples found = stipple(cost, {}, {size * size / 2}, threshold, options);
    const double n = static_cast<double>(found.pixels.size());
    CHECK(n * threshold * threshold / (size * size) > 1.0);
    CHECK(n * threshold * threshold / (size * size) < 2.2);
    const double hexagonal = std::sqrt(2.0 / std::sqrt(3.0) * size * size / n);
    CHECK(nearest_spacing(found.pixels, size) > 0.6 * hexagonal);
  }
}

TEST_CASE("stipple: dear ground gets more points in proportion to the square of its cost") {
  ScalarImage cost(200, 100, 0.2f);
  for (int y = 0; y < 100; ++y) {
    for (int x = 100; x < 200; ++x) cost(x, y) = 0.4f;
  }
  StippleOptions options;
  options.floor = 1e-6;
  const Stipples found = stipple_count(cost, {}, {0}, 800, options);
  const auto dear = static_cast<double>(std::count_if(found.pixels.begin(), found.pixels.end(), [](int p) { return p % 200 >= 100; }));
  CHECK(dear / (static_cast<double>(found.pixels.size()) - dear) == Approx(4.0).epsilon(0.25));
}

TEST_CASE("stipple_count: within two per cent, inside the mask, hops count edges") {
  Rng rng(9);
  const ScalarImage cost = random_cost(180, 140, rng.child("cost"));
  Mask allowed(180, 140, 255);
  for (int y = 0; y < 140; ++y) {
    for (int x = 60; x < 90; ++x) allowed(x, y) = y < 130 ? 0 : 255;
  }
  for (const int count : {50, 300, 2000}) {
    const Stipples found = stipple_count(cost, allowed, {0}, count, {});
    CHECK(static_cast<double>(found.pixels.size()) == Approx(count).epsilon(count < 100 ? 0.06 : 0.02));
    for (std::size_t i = 0; i < found.pixels.size(); ++i) {
      const int x = found.pixels[i] % 180, y = found.pixels[i] / 180;
      CHECK(allowed(x, y) != 0);
      CHECK(found.hops[i] >= (x < 60 ? x + y : x + 130));  // no way to the right but over row 130
    }
    std::vector<int> sorted = found.pixels;
    std::sort(sorted.begin(), sorted.end());
    CHECK(std::adjacent_find(sorted.begin(), sorted.end()) == sorted.end());
  }
}

TEST_CASE("stipple: what cannot be done is refused") {
  const ScalarImage cost(4, 4, 1.0f);
  CHECK_THROWS_AS(stipple(cost, {}, {}, 1.0, {}), std::invalid_argument);
  CHECK_THROWS_AS(stipple(cost, {}, {16}, 1.0, {}), std::invalid_argument);
  CHECK_THROWS_AS(stipple(cost, {}, {0}, 0.0, {}), std::invalid_argument);
  CHECK_THROWS_AS(stipple_count(cost, {}, {0}, 0, {}), std::invalid_argument);
}

TEST_CASE("stipple: the cost that is kept is 0 at points, at most the threshold, and changes by no more than an edge costs") {
  const ScalarImage cost = random_cost(40, 30, Rng(12));
  StippleOptions options;
  options.jitter = 0.0;
  options.keep_cost = true;
  const Stipples found = stipple(cost, {}, {7}, 3.0, options);
  REQUIRE(found.cost.size() == cost.size());
  CHECK(found.cost.pixels()[7] == 0.0f);
  for (const int pixel : found.pixels) CHECK(found.cost.pixels()[static_cast<std::size_t>(pixel)] == 0.0f);
  const auto floor = static_cast<float>(options.floor);
  for (int y = 0; y < cost.height(); ++y) {
    for (int x = 0; x + 1 < cost.width(); ++x) {
      CHECK(found.cost(x, y) <= 3.0f);
      CHECK(std::abs(found.cost(x, y) - found.cost(x + 1, y)) <= 0.5f * (cost(x, y) + cost(x + 1, y)) + floor + 1e-5f);
    }
  }
}
