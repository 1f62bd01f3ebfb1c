// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/growth/cost_lines.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <set>

#include "ramify/core/error.h"
#include "ramify/growth/moss.h"
#include "ramify/skeleton/branches.h"

using namespace ramify;

namespace {

// Every step costs 1: the distance along axes is |dx| + |dy|.
DendriteTarget even_target(int size) {
  DendriteTarget target;
  target.lattice.width = target.lattice.height = size;
  target.lattice.connectivity = Connectivity::Plane4;
  target.lattice.weights = WholeWeights(static_cast<std::size_t>(size * size), 1);
  target.generators = {target.lattice.node(size / 2, size / 2)};
  target.endpoints = target.generators;
  return target;
}

}  // namespace

TEST_CASE("lines of equal distance lie where the distance is theirs") {
  const DendriteTarget target = even_target(41);
  const Dendrite dot = grow_dendrite(target, {}, Rng(1), {});
  REQUIRE(dot.structure.forest.nodes.size() == 1);
  CostLineOptions options;
  options.count = 3;  // at 10, 20 and 30 of 40
  const Skeleton lines = distance_lines(dot, 2.0, options, {});
  std::set<int> levels;
  for (const Node& node : lines.nodes()) {
    const double x = (node.position.x() + 0.5) / 2.0 - 0.5, y = (node.position.y() + 0.5) / 2.0 - 0.5;
    CHECK(std::abs(x - 20) + std::abs(y - 20) == Approx(10.0 * node.tag).margin(1e-4));
    levels.insert(node.tag);
  }
  CHECK(levels == std::set<int>{1, 2, 3});
  const BranchTree tree = branch_tree(lines);
  CHECK(lines[tree.branches[0].nodes.back()].position == lines[tree.branches[0].nodes.front()].position);  // closed
  CHECK(tree.branches.size() == 1 + 1 + 4);  // the last one leaves the canvas at its four corners
  CHECK(lines.size == Size{82, 82});
}

TEST_CASE("outlines of two cells meet halfway and close along the canvas") {
  DendriteTarget target = even_target(21);
  const std::vector<int> generators{target.lattice.node(4, 10), target.lattice.node(16, 10)};
  const Skeleton lines = cell_outlines(target.lattice, generators, 1.0, 0.5, {});
  const BranchTree tree = branch_tree(lines);
  REQUIRE(tree.branches.size() == 2);
  for (const Branch& branch : tree.branches) {
    double area = 0.0;
    for (std::size_t i = 0; i + 1 < branch.nodes.size(); ++i) area += 0.5 * cross(lines[branch.nodes[i]].xy(), lines[branch.nodes[i + 1]].xy());
    CHECK(std::abs(area) == Approx(10.5 * 21).margin(2.0));  // half the canvas each
    CHECK(lines[branch.nodes.front()].position == lines[branch.nodes.back()].position);
  }
  int halfway = 0;
  for (const Node& node : lines.nodes()) halfway += std::abs(node.position.x() - 10.0) < 0.51;
  CHECK(halfway >= 2 * 19);
  CHECK_THROWS_AS(cell_outlines(target.lattice, {generators[0], generators[0] + 1}, 1.0, 0.5, {}), InputError);  // they touch
}

TEST_CASE("trees of generators that do not touch stay apart") {
  for (int seed = 0; seed < 6; ++seed) {
    DendriteTarget target = even_target(60);
    target.endpoints.clear();
    target.lattice.connectivity = Connectivity::Plane8;
    target.lattice.weights = HashedWeights{static_cast<std::uint64_t>(seed), 1.0, 20.0, true};
    target.generators = {target.lattice.node(20, 30), target.lattice.node(40, 30)};
    DendriteOptions options;
    options.endpoints = 40;
    options.rounds = 3;
    options.branching = 2.0;
    options.distance = 25.0;
    const Dendrite grown = grow_dendrite(target, options, Rng(static_cast<std::uint64_t>(seed)), {});
    const PathForest& forest = grown.structure.forest;
    std::set<int> roots;
    for (std::size_t i = 0; i < forest.nodes.size(); ++i) {
      if (forest.parents[i] == kNone) roots.insert(forest.nodes[i]);
    }
    CHECK(roots == std::set<int>(target.generators.begin(), target.generators.end()));
  }
}

TEST_CASE("moss: hairs have the colour of the ground they stand on and are darker below others") {
  ColorImage picture(80, 60);
  for (int y = 0; y < 60; ++y) {
    for (int x = 0; x < 80; ++x) picture(x, y) = {static_cast<float>(x) / 80, static_cast<float>(y) / 60, 0.5f};
  }
  MossOptions options;
  options.height = 12.0;
  options.rows = 6.0;
  const std::vector<MossHair> hairs = grow_moss(picture, options, Rng(4), {});
  CHECK(hairs.size() > 10 * 20);
  double low = 0.0, high = 0.0;
  float row = -1.0f;
  for (const MossHair& hair : hairs) {
    REQUIRE(hair.points.size() == hair.light.size());
    CHECK(hair.color.g >= row);  // back to front
    row = hair.color.g;
    const double ground = hair.color.g * 60 + moss_headroom(options);
    for (std::size_t i = 0; i < hair.points.size(); ++i) {
      CHECK(hair.points[i].y() <= ground + 1e-3);
      CHECK(hair.points[i].y() >= ground - moss_headroom(options));
      CHECK(hair.light[i] > 0.0f);
      CHECK(hair.light[i] <= 1.0f);
    }
    if (hair.points.front().y() > ground - 0.5) CHECK(hair.points.front().x() == Approx(hair.color.r * 80).margin(1e-3));  // stands on the ground itself
    low += hair.light.front();
    high += hair.light.back();
  }
  CHECK(low < 0.8 * high);
  options.shadow = 0.0;
  for (const MossHair& hair : grow_moss(picture, options, Rng(4), {})) {
    for (const float light : hair.light) CHECK(light == 1.0f);
  }
  CHECK_THROWS_AS(grow_moss(ColorImage(), options, Rng(4), {}), InputError);
}
