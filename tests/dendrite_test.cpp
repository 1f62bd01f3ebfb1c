// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/growth/dendrite.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <set>

#include "ramify/core/error.h"
#include "ramify/core/parallel.h"
#include "ramify/growth/endpoint_placement.h"
#include "ramify/skeleton/branches.h"
#include "ramify/skeleton/statistics.h"

using namespace ramify;

namespace {

DendriteTarget random_target(int size, std::uint64_t seed, Connectivity connectivity = Connectivity::Plane8) {
  DendriteTarget target;
  target.lattice.width = target.lattice.height = size;
  target.lattice.connectivity = connectivity;
  target.lattice.weights = HashedWeights{seed, 1.0, 10.0, false};
  target.generators = {target.lattice.node(size / 2, size / 2)};
  return target;
}

std::vector<Vec2> tips(const Skeleton& skeleton) {
  std::vector<bool> leaf(static_cast<std::size_t>(skeleton.count()), true);
  for (const Node& node : skeleton.nodes()) {
    if (node.parent != kNone) leaf[static_cast<std::size_t>(node.parent)] = false;
  }
  std::vector<Vec2> out;
  for (int i = 0; i < skeleton.count(); ++i) {
    if (leaf[static_cast<std::size_t>(i)]) out.push_back(skeleton[i].xy());
  }
  return out;
}

std::vector<int> end_nodes(const Dendrite& dendrite) {
  std::vector<int> out;
  for (const int end : dendrite.structure.endpoints) out.push_back(dendrite.structure.forest.nodes[static_cast<std::size_t>(end)]);
  return out;
}

}  // namespace

TEST_CASE("dendrite: given endpoints are reached by the paths that a plan finds") {
  DendriteTarget target = random_target(60, 3);
  for (int i = 0; i < 40; ++i) target.endpoints.push_back(target.lattice.node(3 + 7 * (i % 8), 2 + 11 * (i / 8)));
  const Dendrite grown = grow_dendrite(target, {}, Rng(1), {});
  CHECK(grown.rounds == std::vector<int>{40});
  const Plan plan = plan_paths(target.lattice, target.generators);
  std::set<int> expected;
  for (int node : target.endpoints) {
    for (; node != kNone; node = path_parent(plan, target.lattice, node)) expected.insert(node);
  }
  const std::vector<int>& nodes = grown.structure.forest.nodes;
  CHECK(std::set<int>(nodes.begin(), nodes.end()) == expected);
  const Skeleton skeleton = dendrite_skeleton(grown, 1.0, {});
  skeleton.check();
  for (const Vec2& tip : tips(skeleton)) {
    CHECK(std::count(target.endpoints.begin(), target.endpoints.end(), target.lattice.node(static_cast<int>(tip.x()), static_cast<int>(tip.y()))) == 1);
  }
}

TEST_CASE("dendrite: every round keeps its distance from what was there, and its points from one another") {
  DendriteOptions options;
  options.endpoints = 8;
  options.distance = 40.0;
  options.attenuation = 2.0;
  options.branching = 3.0;
  options.rounds = 3;
  const DendriteTarget target = random_target(200, 8);
  const Dendrite grown = grow_dendrite(target, options, Rng(4), {});
  REQUIRE(grown.rounds.size() == 3);
  CHECK(grown.rounds[0] == 8);
  CHECK(grown.rounds[1] == 24);
  double distance = 40.0;
  int first = 0;
  for (std::size_t round = 0; round < 3; ++round, distance /= 2.0) {
    std::vector<int> before = target.generators, ends;
    const PathForest& forest = grown.structure.forest;
    for (std::size_t i = 0; i < forest.nodes.size(); ++i) {
      if (grown.structure.rounds[static_cast<std::size_t>(forest.paths[i])] < static_cast<int>(round)) before.push_back(forest.nodes[i]);
    }
    const Plan fresh = plan_paths(target.lattice, before);  // from scratch: nothing incremental
    for (int i = 0; i < grown.rounds[round]; ++i) ends.push_back(end_nodes(grown)[static_cast<std::size_t>(first + i)]);
    double low = 1e9, high = 0.0;
    for (const int end : ends) {
      low = std::min(low, path_sum(fresh, end));
      high = std::max(high, path_sum(fresh, end));
      for (const int other : ends) {
        if (end != other) CHECK(std::hypot(end % 200 - other % 200, end / 200 - other / 200) >= 0.3 * distance - 1e-9);
      }
    }
    CHECK(low >= 0.6 * high - 1.0);   // the band of 0.6 d to d
    CHECK(high <= 4.5 * distance);    // d nodes of mean cost
    first += grown.rounds[round];
  }
}

TEST_CASE("dendrite: no two paths cross whatever the metric and the neighbours") {
  int plans = 0;
  for (const Metric metric : {Metric::Sum, Metric::Partial, Metric::Full, Metric::Power, Metric::Mix}) {
    for (const Connectivity connectivity : {Connectivity::Plane4, Connectivity::Plane8}) {
      for (std::uint64_t seed = 0; seed < 12; ++seed, ++plans) {
        DendriteOptions options;
        options.metric.metric = metric;
        options.endpoints = 25;
        options.rounds = 2;
        options.refine = seed % 3 == 0 ? 3 : 1;
        DendriteTarget target = random_target(48, seed, connectivity);
        target.generators.push_back(target.lattice.node(5, 5));  // two rivals
        const Skeleton skeleton = dendrite_skeleton(grow_dendrite(target, options, Rng(seed), {}), 2.0, {});
        CHECK(find_crossings(skeleton).empty());
      }
    }
  }
  CHECK(plans == 120);
}

TEST_CASE("dendrite: refined paths stay within the nodes of the coarse ones") {
  const DendriteTarget target = random_target(50, 5);
  DendriteOptions options;
  options.endpoints = 12;
  const Dendrite coarse = grow_dendrite(target, options, Rng(2), {});
  const std::set<int> allowed(coarse.structure.forest.nodes.begin(), coarse.structure.forest.nodes.end());
  for (const bool each : {false, true}) {
    options.refine = 4;
    options.refine_each = each;
    const Dendrite fine = grow_dendrite(target, options, Rng(2), {});
    CHECK(fine.lattice.width == 200);
    CHECK(fine.structure.forest.nodes.size() > 3 * coarse.structure.forest.nodes.size());
    for (const int node : fine.structure.forest.nodes) CHECK(allowed.count(target.lattice.node(node % 200 / 4, node / 200 / 4)) == 1);
    const Skeleton skeleton = dendrite_skeleton(fine, 2.0, {});
    CHECK(skeleton.size == Size{100, 100});
  }
}

TEST_CASE("dendrite: refined paths never cross, planned together or each by itself") {
  int meetings = 0;
  for (int seed = 0; seed < 40; ++seed) {
    DendriteTarget target = random_target(40, static_cast<std::uint64_t>(seed));
    std::get<HashedWeights>(target.lattice.weights).per_edge = seed % 2 == 0;
    DendriteOptions options;
    options.metric.metric = seed % 4 < 2 ? Metric::Sum : Metric::Partial;
    options.endpoints = 25;
    options.refine = 3;
    options.refine_each = seed % 8 != 7;
    const Dendrite grown = grow_dendrite(target, options, Rng(static_cast<std::uint64_t>(seed)), {});
    const PathForest& forest = grown.structure.forest;
    std::set<std::pair<int, int>> middles;  // in half steps: edges of a lattice meet between nodes where these coincide
    int edges = 0;
    for (std::size_t i = 0; i < forest.nodes.size(); ++i) {
      if (forest.parents[i] == kNone) continue;
      const int a = forest.nodes[i], b = forest.nodes[static_cast<std::size_t>(forest.parents[i])], width = grown.lattice.width;
      CHECK(std::abs(a % width - b % width) <= 1);
      CHECK(std::abs(a / width - b / width) <= 1);
      middles.insert({a % width + b % width, a / width + b / width});
      ++edges;
    }
    CHECK(static_cast<int>(middles.size()) == edges);
    CHECK(find_crossings(dendrite_skeleton(grown, 1.0, {})).empty());
    // Each by itself, paths part that the coarse dendrite shares: otherwise nothing could cross.
    std::vector<int> children(forest.nodes.size(), 0);
    for (const int parent : forest.parents) {
      if (parent != kNone) meetings += ++children[static_cast<std::size_t>(parent)] > 1;
    }
  }
  CHECK(meetings > 40 * 15);
}

TEST_CASE("dendrite: refining within a mask loses no endpoint") {
  DendriteTarget target = random_target(60, 11);
  target.lattice.cut_corners = false;
  target.lattice.allowed.assign(3600, 0);
  for (int node = 0; node < 3600; ++node) {
    const double d = std::hypot(node % 60 - 30, node / 60 - 30);
    target.lattice.allowed[static_cast<std::size_t>(node)] = d > 18 && d < 27;  // a ring
  }
  target.generators = {target.lattice.node(52, 30)};
  DendriteOptions options;
  options.endpoints = 30;
  options.refine = 3;
  const Dendrite grown = grow_dendrite(target, options, Rng(2), {});
  CHECK(grown.rounds[0] == 30);
  CHECK(grown.structure.endpoints.size() == 30);
}

TEST_CASE("dendrite: lightning ends at the bottom and forks downwards; moss stands on its generator") {
  DendriteTarget target = random_target(120, 6);
  target.generators = {target.lattice.node(60, 0)};
  DendriteOptions options;
  options.placement = EndpointPlacement::Lightning;
  options.endpoints = 3;
  options.branching = 8.0;
  options.rounds = 2;
  const Dendrite bolt = grow_dendrite(target, options, Rng(3), {});
  REQUIRE(bolt.rounds.size() == 2);
  const std::vector<int> ends = end_nodes(bolt);
  for (int i = 0; i < bolt.rounds[0]; ++i) CHECK(ends[static_cast<std::size_t>(i)] / 120 >= 116);

  target.generators.clear();
  for (int x = 0; x < 120; ++x) target.generators.push_back(target.lattice.node(x, 119));
  options.placement = EndpointPlacement::Moss;
  options.endpoints = 80;
  options.distance = 30.0;
  options.spacing = 2.0;
  options.rounds = 1;
  for (const int end : end_nodes(grow_dendrite(target, options, Rng(3), {}))) {
    CHECK(end / 120 >= 119 - 30);
    CHECK(end / 120 <= 119 - 18);
  }
}

TEST_CASE("dendrite: the skeleton is as thick as its endpoints ask for and goes on where most of them lie") {
  const Dendrite grown = grow_dendrite(random_target(80, 2), {}, Rng(7), {});
  DendriteThickness thickness;
  thickness.tip = 0.5;
  thickness.taper = 0.5;
  const Skeleton skeleton = dendrite_skeleton(grown, 1.0, thickness);
  std::vector<int> above(static_cast<std::size_t>(skeleton.count()), 0);
  std::set<std::pair<double, double>> ends;
  for (const int node : end_nodes(grown)) ends.insert({node % 80, node / 80});
  for (int i = skeleton.count() - 1; i >= 0; --i) {
    above[static_cast<std::size_t>(i)] += static_cast<int>(ends.count({skeleton[i].position.x(), skeleton[i].position.y()}));
    if (skeleton[i].parent != kNone) above[static_cast<std::size_t>(skeleton[i].parent)] += above[static_cast<std::size_t>(i)];
    CHECK(skeleton[i].radius == Approx(0.5 * std::sqrt(above[static_cast<std::size_t>(i)])));
  }
  const BranchTree tree = branch_tree(skeleton);
  for (const Branch& branch : tree.branches) {
    if (branch.parent == kNone) continue;
    CHECK(branch.order == tree.branches[static_cast<std::size_t>(branch.parent)].order + 1);
    for (const int node : tree.branches[static_cast<std::size_t>(branch.parent)].nodes) {
      if (skeleton[node].parent == branch.parent_node) CHECK(above[static_cast<std::size_t>(node)] >= above[static_cast<std::size_t>(branch.nodes.front())]);
    }
  }
}

TEST_CASE("dendrite: the same for any number of threads and errors that name the cause") {
  DendriteOptions options;
  options.rounds = 3;
  set_thread_count(1);
  const Skeleton one = dendrite_skeleton(grow_dendrite(random_target(90, 4), options, Rng(5), {}), 1.0, {});
  set_thread_count(2);
  const Skeleton two = dendrite_skeleton(grow_dendrite(random_target(90, 4), options, Rng(5), {}), 1.0, {});
  set_thread_count(0);
  REQUIRE(one.count() == two.count());
  for (int i = 0; i < one.count(); ++i) CHECK(one[i].position == two[i].position);

  DendriteTarget walled = random_target(20, 1);
  walled.lattice.allowed.assign(400, 1);
  for (int y = 0; y < 20; ++y) walled.lattice.allowed[static_cast<std::size_t>(walled.lattice.node(14, y))] = 0;
  walled.endpoints = {walled.lattice.node(18, 4)};
  CHECK_THROWS_AS(grow_dendrite(walled, {}, Rng(1), {}), InputError);
  options.attenuation = 1.0;
  CHECK_THROWS_AS(grow_dendrite(random_target(20, 1), options, Rng(1), {}), OptionError);
}

TEST_CASE("choose_spaced: as many as asked, apart, and all when nothing keeps them") {
  std::vector<int> all(50 * 50);
  for (int i = 0; i < 2500; ++i) all[static_cast<std::size_t>(i)] = i;
  const std::vector<int> few = choose_spaced(all, {50, 50}, 40, 5.0, Rng(2));
  CHECK(few.size() == 40);
  for (const int a : few) {
    for (const int b : few) {
      if (a != b) CHECK(std::hypot(a % 50 - b % 50, a / 50 - b / 50) >= 5.0);
    }
  }
  std::vector<int> everything = choose_spaced(all, {50, 50}, 5000, 0.0, Rng(2));
  std::sort(everything.begin(), everything.end());
  CHECK(everything == all);
}
