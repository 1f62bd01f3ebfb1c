// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/growth/aggregation.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <set>

#include "ramify/core/error.h"
#include "ramify/growth/dendrite.h"

using namespace ramify;

namespace {

std::vector<Vec2> places(const Aggregate& aggregate) {
  std::vector<Vec2> out;
  for (const int node : aggregate.nodes) out.emplace_back(node % aggregate.size.width, node / aggregate.size.width);
  return out;
}

}  // namespace

TEST_CASE("aggregate: every walker stays beside an earlier one, and nowhere twice") {
  for (const WalkerLaunch launch : {WalkerLaunch::AnyNode, WalkerLaunch::Circle}) {
    AggregationOptions options;
    options.walkers = 900;
    options.launch = launch;
    const Aggregate grown = grow_aggregate({121, 101}, options, Rng(3), {});
    CHECK(grown.nodes.size() <= 900);
    CHECK(grown.nodes.size() > 500);
    CHECK(grown.nodes.front() == 50 * 121 + 60);
    const std::vector<Vec2> at = places(grown);
    CHECK(std::set<int>(grown.nodes.begin(), grown.nodes.end()).size() == grown.nodes.size());
    for (std::size_t i = 1; i < at.size(); ++i) {
      REQUIRE(grown.parents[i] >= 0);
      REQUIRE(grown.parents[i] < static_cast<int>(i));
      CHECK((at[i] - at[static_cast<std::size_t>(grown.parents[i])]).norm() == 1.0);
    }
    aggregate_skeleton(grown, 0.5).check();
  }
}

TEST_CASE("aggregate: a full canvas by any node; a circle ends at the canvas's edge") {
  AggregationOptions options;
  options.walkers = 1000;
  options.launch = WalkerLaunch::AnyNode;
  CHECK(grow_aggregate({9, 7}, options, Rng(1), {}).nodes.size() == 63);
  options.launch = WalkerLaunch::Circle;
  const Aggregate small = grow_aggregate({21, 21}, options, Rng(1), {});
  const int last = small.nodes.back(), x = last % 21, y = last / 21;
  CHECK((x == 0 || y == 0 || x == 20 || y == 20));
  CHECK_THROWS_AS(grow_aggregate({2, 9}, options, Rng(1), {}), InputError);
}

TEST_CASE("aggregate: grows to the fractal dimension of diffusion-limited aggregation, 1.71") {
  AggregationOptions options;
  options.walkers = 16000;
  double sum = 0.0;
  for (int seed = 0; seed < 6; ++seed) {
    const Aggregate grown = grow_aggregate({801, 801}, options, Rng(static_cast<std::uint64_t>(seed)), {});
    REQUIRE(grown.nodes.size() == 16000);
    sum += mass_radius_dimension(places(grown), {400, 400}) / 6;
  }
  CHECK(sum == Approx(1.71).margin(0.05));
}

TEST_CASE("mass-radius dimension: 2 for a disc, 1 for a line") {
  std::vector<Vec2> disc, line;
  for (int y = -100; y <= 100; ++y) {
    for (int x = -100; x <= 100; ++x) {
      if (std::hypot(x, y) <= 100) disc.emplace_back(x, y);
    }
  }
  for (int x = -400; x <= 400; ++x) line.emplace_back(x, 7);
  CHECK(mass_radius_dimension(disc, {0, 0}) == Approx(2.0).margin(0.03));
  CHECK(mass_radius_dimension(line, {0, 7}) == Approx(1.0).margin(0.03));
  CHECK(mass_radius_dimension(std::vector<Vec2>(5, Vec2(1, 1)), {0, 0}) == 0.0);
}
