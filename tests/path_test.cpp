// SPDX-License-Identifier: GPL-3.0-or-later
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "ramify/core/random.h"
#include "ramify/graph/least_cost_path.h"

using namespace ramify;

namespace {

// The cheapest cost by relaxing every edge until nothing changes (Bellman-Ford), with the documented edge cost.
double relaxed_cost(const LatticeCosts& costs, Pixel start, Pixel target) {
  const int w = costs.cost.width(), h = costs.cost.height();
  Image<double> best(w, h, 1e18);
  best(start.x, start.y) = 0;
  for (bool changed = true; changed;) {
    changed = false;
    for (int y = 0; y < h; ++y) {
      for (int x = 0; x < w; ++x) {
        for (int dy = -1; dy <= 1; ++dy) {
          for (int dx = -1; dx <= 1; ++dx) {
            const int u = x + dx, v = y + dy;
            if ((dx == 0 && dy == 0) || !best.contains(u, v) || costs.cost(u, v) == 0 || best(x, y) > 1e17) continue;
            const double length = std::hypot(dx, dy), along =
                std::abs(costs.tangent(u, v).x() * dx + costs.tangent(u, v).y() * dy) / length;
            const double step = std::round(0.5 * length * (costs.cost(x, y) + costs.cost(u, v)) *
                                           (1.0 + costs.turn_weight * (1.0 - std::min(along, 1.0))));
            if (best(x, y) + step < best(u, v)) {
              best(u, v) = best(x, y) + step;
              changed = true;
            }
          }
        }
      }
    }
  }
  return best(target.x, target.y);
}

}  // namespace

TEST_CASE("the bucket queue finds the cost that brute force finds") {
  Rng rng(4);
  for (int trial = 0; trial < 40; ++trial) {
    LatticeCosts costs{Image<std::uint16_t>(14, 11), VectorImage(14, 11), 1.0};
    for (auto& c : costs.cost.pixels()) c = rng.uniform() < 0.1 ? 0 : static_cast<std::uint16_t>(1 + rng.below(1000));
    for (auto& t : costs.tangent.pixels()) {
      const double a = rng.uniform(0, kPi);
      t = {static_cast<float>(std::cos(a)), static_cast<float>(std::sin(a))};
    }
    costs.cost(0, 0) = costs.cost(13, 10) = 5;
    const auto path = cheapest_path(costs, {0, 0}, {{13, 10}}, {0, 0, 13, 10});
    const double expected = relaxed_cost(costs, {0, 0}, {13, 10});
    if (!path) {
      CHECK(expected > 1e17);
      continue;
    }
    CHECK(static_cast<double>(path->cost) == expected);
    CHECK(path->pixels.front() == Pixel{0, 0});
    CHECK(path->pixels.back() == Pixel{13, 10});
    for (std::size_t i = 1; i < path->pixels.size(); ++i) {
      const Pixel a = path->pixels[i - 1], b = path->pixels[i];
      CHECK(std::max(std::abs(a.x - b.x), std::abs(a.y - b.y)) == 1);
    }
  }
}

TEST_CASE("a path stays in its box and a target outside is an error") {
  LatticeCosts costs{Image<std::uint16_t>(40, 40, 100), VectorImage(), 1.0};
  for (int x = 0; x < 40; ++x) costs.cost(x, 12) = 1;  // a cheap road outside the box
  const auto path = cheapest_path(costs, {5, 20}, {{35, 20}}, {0, 15, 39, 25});
  REQUIRE(path);
  for (const Pixel& p : path->pixels) CHECK(p.y >= 15);
  CHECK(cheapest_path(costs, {5, 20}, {{35, 20}}, {0, 0, 39, 39})->cost < path->cost);
  CHECK_THROWS_AS(cheapest_path(costs, {5, 20}, {{35, 50}}, {0, 0, 39, 39}), std::invalid_argument);
}
