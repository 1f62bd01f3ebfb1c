// SPDX-License-Identifier: GPL-3.0-or-later
#include <catch2/catch.hpp>
#include <map>
#include <set>

#include "ramify/skeleton/assemble.h"
#include "ramify/skeleton/branches.h"
#include "support/random_skeleton.h"

using namespace ramify;

namespace {

std::vector<LooseNode> shuffled(const Skeleton& skeleton, Rng rng, std::vector<int>& place) {
  place.resize(skeleton.count());
  for (int i = 0; i < skeleton.count(); ++i) place[i] = i;
  rng.shuffle(place);
  std::vector<LooseNode> nodes(skeleton.count());
  for (int i = 0; i < skeleton.count(); ++i) {
    const Node& n = skeleton[i];
    nodes[place[i]] = {n.position, n.radius, n.parent == kNone ? kNone : place[n.parent], n.tag};
  }
  return nodes;
}

}  // namespace

TEST_CASE("assembling shuffled nodes keeps every edge") {
  for (int seed = 0; seed < 30; ++seed) {
    const Skeleton original = random_skeleton(Rng(seed), {200, 200}, 12);
    std::vector<int> place;
    const auto nodes = shuffled(original, Rng(seed + 100), place);
    for (const auto rule : {ContinuationRule::AsListed, ContinuationRule::Straightest}) {
      const Assembled result = assemble_skeleton(nodes, original.size, rule);
      result.skeleton.check();
      REQUIRE(result.skeleton.count() == original.count());
      for (int i = 0; i < original.count(); ++i) {
        const Node& moved = result.skeleton[result.index_of[place[i]]];
        CHECK(moved.position == original[i].position);
        CHECK(moved.radius == original[i].radius);
        CHECK(moved.tag == original[i].tag);
        const int parent = original[i].parent;
        CHECK(moved.parent == (parent == kNone ? kNone : result.index_of[place[parent]]));
      }
    }
  }
}

TEST_CASE("nodes in a good order keep their indices") {
  const Skeleton original = random_skeleton(Rng(5), {200, 200}, 20);
  std::vector<LooseNode> nodes;
  for (const Node& n : original.nodes()) nodes.push_back({n.position, n.radius, n.parent, n.tag});
  const Assembled result = assemble_skeleton(nodes, original.size, ContinuationRule::AsListed);
  for (int i = 0; i < original.count(); ++i) CHECK(result.index_of[i] == i);
}

TEST_CASE("the straight thick child continues its parent") {
  // A stem to the right, a thin twig listed first, traced with pixel steps.
  std::vector<LooseNode> nodes;
  for (int x = 0; x <= 30; ++x) nodes.push_back({Vec3(x, 50 + x % 2, 0), 4.0, x - 1, 0});
  int twig = 15;
  for (int k = 1; k <= 40; ++k) {
    nodes.push_back({Vec3(15 + 0.2 * k, 50 + k, 0), 1.5, twig, 0});
    twig = static_cast<int>(nodes.size()) - 1;
  }
  int stem = 15;
  nodes[16].parent = kNone;  // the stem's second half, moved behind the twig
  nodes.resize(nodes.size());
  std::vector<LooseNode> late(nodes.begin() + 16, nodes.begin() + 31);
  nodes.erase(nodes.begin() + 16, nodes.begin() + 31);
  for (std::size_t i = 17; i < nodes.size(); ++i) nodes[i].parent = static_cast<int>(i) - 1;
  nodes[16].parent = 15;
  for (LooseNode node : late) {
    node.parent = stem;
    nodes.push_back(node);
    stem = static_cast<int>(nodes.size()) - 1;
  }
  const Skeleton listed = assemble_skeleton(nodes, {100, 100}, ContinuationRule::AsListed).skeleton;
  const Skeleton straight = assemble_skeleton(nodes, {100, 100}, ContinuationRule::Straightest).skeleton;
  CHECK(branch_tree(listed).branches[0].nodes.size() == 16 + 40);
  const BranchTree tree = branch_tree(straight);
  REQUIRE(tree.branches.size() == 2);
  CHECK(tree.branches[0].nodes.size() == 31);
  CHECK(straight[tree.branches[0].nodes.back()].position.x() == 30.0);
  CHECK(straight[tree.branches[1].nodes.back()].order == 1);
  CHECK(branch_tree(order_continuations(listed)).branches[0].nodes.size() == 31);
}

TEST_CASE("cycles are cut once each") {
  std::vector<LooseNode> nodes(7);
  const int parents[] = {2, 0, 1, 2, kNone, 6, 5};
  for (int i = 0; i < 7; ++i) nodes[i].parent = parents[i];
  CHECK_THROWS_AS(assemble_skeleton(nodes, {9, 9}, ContinuationRule::AsListed), std::invalid_argument);
  const auto cut = cut_cycles(nodes);
  CHECK(cut == std::vector<std::pair<int, int>>{{0, 2}, {5, 6}});
  CHECK(assemble_skeleton(nodes, {9, 9}, ContinuationRule::AsListed).skeleton.count() == 7);
}
