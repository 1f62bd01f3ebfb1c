// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/graph/point_graph.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <map>
#include <set>

#include "ramify/core/random.h"
#include "ramify/graph/path_forest.h"
#include "ramify/graph/plan.h"
#include "support/random_lattice.h"

using namespace ramify;

namespace {

std::vector<Vec3> random_points(int count, bool plane, Rng& rng) {
  std::vector<Vec3> points;
  for (int i = 0; i < count; ++i) points.emplace_back(rng.uniform(0, 100), rng.uniform(0, 80), plane ? 0.0 : rng.uniform(0, 60));
  return points;
}

}  // namespace

TEST_CASE("point graphs hold the edges that brute force finds") {
  Rng rng(8);
  for (int trial = 0; trial < 12; ++trial) {
    const bool plane = trial % 2 == 0;
    const std::vector<Vec3> points = random_points(60 + 20 * trial, plane, rng);
    const double reach = trial % 3 == 0 ? 18.0 : 1000.0;
    const int sectors = plane ? 6 : 8;
    std::set<std::pair<int, int>> yao, near;
    for (int i = 0; i < static_cast<int>(points.size()); ++i) {
      std::map<int, std::pair<double, int>> best;
      for (int j = 0; j < static_cast<int>(points.size()); ++j) {
        const Vec3 d = points[j] - points[i];
        if (j == i || d.norm() > reach) continue;
        double turn = std::atan2(d.y(), d.x()) / (2.0 * kPi);
        if (turn < 0.0) turn += 1.0;
        const int sector = plane ? static_cast<int>(turn * sectors) : (d.x() < 0) + 2 * (d.y() < 0) + 4 * (d.z() < 0);
        if (!best.count(sector) || std::make_pair(d.norm(), j) < best[sector]) best[sector] = {d.norm(), j};
        if (d.norm() <= 18.0) near.insert({i, j});
      }
      for (const auto& [sector, found] : best) {
        yao.insert({i, found.second});
        yao.insert({found.second, i});
      }
    }
    const auto edges = [](const PointGraph& graph) {
      std::set<std::pair<int, int>> out;
      for (int i = 0; i < graph.count(); ++i) {
        for (int e = graph.first[i]; e < graph.first[i + 1]; ++e) {
          out.insert({i, graph.neighbor[e]});
          CHECK(graph.cost[e] == Approx((graph.points[i] - graph.points[graph.neighbor[e]]).norm()));
        }
      }
      return out;
    };
    CHECK(edges(yao_graph(points, sectors, reach)) == yao);
    CHECK(edges(threshold_graph(points, 18.0)) == near);
  }
  CHECK_THROWS_WITH(yao_graph(random_points(9, false, rng), 6, 10.0), Catch::Contains("must be 8"));
  CHECK_THROWS_WITH(threshold_graph({Vec3(0, 0, std::nan(""))}, 1.0), Catch::Contains("point 0"));
}

TEST_CASE("no point could be reached cheaper through a neighbour") {
  Rng rng(9);
  for (int trial = 0; trial < 20; ++trial) {
    const PointGraph graph = with_hashed_costs(yao_graph(random_points(300, trial % 2 == 0, rng), trial % 2 ? 8 : 6, 1000.0), 5, 1.0, 5.0);
    const std::vector<int> sources{rng.below(300), rng.below(300)};
    const Plan plan = plan_paths(graph, sources);
    for (int i = 0; i < graph.count(); ++i) {
      for (int e = graph.first[i]; e < graph.first[i + 1]; ++e) {
        CHECK(path_cost(plan, graph.neighbor[e]) <= (path_cost(plan, i) + graph.cost[e]) * (1.0 + 1e-5));
      }
      const int parent = path_parent(plan, graph, i);
      if (parent == kNone) CHECK(path_cost(plan, i) == 0.0);
    }
    const Plan more = reseeded(plan, graph, std::vector<int>{7, 8}, std::numeric_limits<double>::infinity());
    std::vector<int> all = sources;
    all.insert(all.end(), {7, 8});
    CHECK(more.sum == plan_paths(graph, all).sum);
    PathForest forest = make_path_forest(graph.count());
    for (int i = 0; i < 20; ++i) add_path(forest, plan, graph, rng.below(300));
    for (const auto& line : forest_polylines(forest, graph)) CHECK(!line.empty());
  }
}

TEST_CASE("geodesic cells of a connected region make a connected graph") {
  Rng rng(10);
  for (int trial = 0; trial < 20; ++trial) {
    Lattice lattice;
    lattice.width = 40;
    lattice.height = 30;
    lattice.cut_corners = false;
    lattice.weights = WholeWeights(1200, 1);
    lattice.allowed.assign(1200, 0);
    int x = 20, y = 15;  // a random walk: thin, ragged, 4-connected
    for (int i = 0; i < 900; ++i) {
      lattice.allowed[lattice.node(x, y)] = 1;
      x = std::clamp(x + (rng.below(2) ? 0 : rng.below(3) - 1), 0, 39);
      lattice.allowed[lattice.node(x, y)] = 1;
      y = std::clamp(y + rng.below(3) - 1, 0, 29);
    }
    std::vector<int> sites;
    std::vector<Vec3> points;
    while (sites.size() < 25) {
      const int node = random_node(lattice, rng);
      if (std::find(sites.begin(), sites.end(), node) != sites.end()) continue;
      sites.push_back(node);
      points.push_back(node_position(lattice, node));
    }
    std::vector<int> label = nearest_sources(plan_paths(lattice, sites), lattice);
    for (int& l : label) l = l == kNone ? kNone : static_cast<int>(std::find(sites.begin(), sites.end(), l) - sites.begin());
    for (int i = 0; i < 1200; ++i) CHECK((label[i] != kNone) == (lattice.allowed[i] != 0));
    const PointGraph graph = voronoi_graph(points, label, 40, 30);
    const Plan plan = plan_paths(graph, std::vector<int>{0});
    for (int i = 0; i < graph.count(); ++i) CHECK(is_reached(plan, i));
  }
}
