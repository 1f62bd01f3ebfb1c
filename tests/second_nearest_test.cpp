// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/graph/second_nearest.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "support/random_lattice.h"

using namespace ramify;

namespace {

// One plan for every generator: what each of them costs at every node.
template <class Graph>
void check_against_single_plans(const Graph& graph, const std::vector<std::vector<int>>& generators) {
  std::vector<int> sources, generator(static_cast<std::size_t>(graph.count()), kNone);
  std::vector<Plan> alone;
  for (std::size_t g = 0; g < generators.size(); ++g) {
    alone.push_back(plan_paths(graph, generators[g]));
    for (const int node : generators[g]) {
      sources.push_back(node);
      generator[static_cast<std::size_t>(node)] = static_cast<int>(g);
    }
  }
  const Plan plan = plan_paths(graph, sources);
  const TwoNearest nearest = two_nearest(plan, graph, generator);
  for (int node = 0; node < graph.count(); ++node) {
    const int own = nearest.own[static_cast<std::size_t>(node)], other = nearest.other[static_cast<std::size_t>(node)];
    CHECK((own == kNone) == !is_reached(plan, node));
    double second = std::numeric_limits<double>::infinity();
    for (std::size_t g = 0; g < generators.size(); ++g) {
      if (static_cast<int>(g) != own) second = std::min(second, path_cost(alone[g], node));
    }
    CHECK((other == kNone) == !std::isfinite(second));
    if (own != kNone) CHECK(path_cost(alone[static_cast<std::size_t>(own)], node) == Approx(path_cost(plan, node)).epsilon(1e-5));
    if (other == kNone) continue;
    REQUIRE(other != own);
    CHECK(second_cost(nearest, node) == Approx(second).epsilon(1e-5));
    CHECK(path_cost(alone[static_cast<std::size_t>(other)], node) == Approx(second).epsilon(1e-5));
  }
}

}  // namespace

TEST_CASE("the second-nearest generator is the one that single plans find") {
  Rng rng(21);
  for (int trial = 0; trial < 80; ++trial) {
    constexpr Connectivity kAll[] = {Connectivity::Plane4, Connectivity::Plane8, Connectivity::Volume6, Connectivity::Volume26};
    const Lattice lattice = random_lattice(rng, kAll[trial % 4]);
    std::vector<std::vector<int>> generators;
    std::vector<char> taken(static_cast<std::size_t>(lattice.count()), 0);
    for (int g = 0; g < 1 + trial % 5; ++g) {
      generators.emplace_back();
      while (generators.back().empty() || rng.below(3) > 0) {
        const int node = random_node(lattice, rng);
        if (!taken[static_cast<std::size_t>(node)]++) generators.back().push_back(node);
      }
    }
    check_against_single_plans(lattice, generators);
  }
}

TEST_CASE("second-nearest generators on point graphs") {
  Rng rng(22);
  for (int trial = 0; trial < 10; ++trial) {
    std::vector<Vec3> points;
    for (int i = 0; i < 200; ++i) points.emplace_back(rng.uniform(0, 100), rng.uniform(0, 80), 0.0);
    check_against_single_plans(with_hashed_costs(yao_graph(points, 6, 1000.0), 5, 1.0, 5.0), {{3}, {70, 71}, {120}, {199}});
  }
}

TEST_CASE("on an even line the costs of both generators are the distances") {
  Lattice lattice;
  lattice.width = 11;
  lattice.height = 1;
  lattice.connectivity = Connectivity::Plane4;
  lattice.weights = WholeWeights(11, 2);
  std::vector<int> generator(11, kNone);
  generator[0] = 4, generator[10] = 9;
  PlanOptions options;
  const Plan plan = plan_paths(lattice, std::vector<int>{0, 10}, options);
  const TwoNearest nearest = two_nearest(plan, lattice, generator);
  for (int x = 0; x < 11; ++x) {
    if (x != 5) CHECK(nearest.own[static_cast<std::size_t>(x)] == (x < 5 ? 4 : 9));
    if (x != 5) CHECK(nearest.other[static_cast<std::size_t>(x)] == (x < 5 ? 9 : 4));
    CHECK(second_cost(nearest, x) == 2.0 * std::max(x, 10 - x));
  }
  generator[10] = kNone;
  CHECK_THROWS_WITH(two_nearest(plan, lattice, generator), Catch::Contains("node 10"));
  CHECK_THROWS_AS(two_nearest(plan, lattice, std::vector<int>(3, 0)), std::invalid_argument);
  options.metric.metric = Metric::Partial;
  CHECK_THROWS_AS(two_nearest(plan_paths(lattice, std::vector<int>{0}, options), lattice, generator), std::invalid_argument);
  options = {};
  options.max_cost = 12.0;  // up to six nodes away: only the middle knows both
  const Plan near = plan_paths(lattice, std::vector<int>{0, 10}, options);
  generator[10] = 9;
  const TwoNearest bounded = two_nearest(near, lattice, generator);
  for (int x = 0; x < 11; ++x) CHECK((bounded.other[static_cast<std::size_t>(x)] != kNone) == (x >= 4 && x <= 6));
}
