// SPDX-License-Identifier: GPL-3.0-or-later
#include <catch2/catch.hpp>
#include <cmath>
#include <stdexcept>

#include "ramify/core/random.h"
#include "ramify/skeleton/branches.h"
#include "ramify/skeleton/skeleton.h"

using namespace ramify;

TEST_CASE("append refuses what would break the tree") {
  Skeleton s(Size{10, 10});
  CHECK(s.append({Vec3(1, 1, 0), 1.0}) == 0);
  CHECK_THROWS_AS(s.append({Vec3(1, 1, 0), 0.0}), std::invalid_argument);
  CHECK_THROWS_AS(s.append({Vec3(1, 1, 0), 1.0, 1}), std::invalid_argument);
  CHECK_THROWS_AS(s.append({Vec3(std::nan(""), 1, 0), 1.0, 0}), std::invalid_argument);
  s.loop_links = {{0, 0}};
  CHECK_THROWS_AS(s.check(), std::logic_error);
}

TEST_CASE("the branches of a random tree partition its nodes") {
  Rng rng(11);
  for (int trial = 0; trial < 50; ++trial) {
    Skeleton s;
    double length = 0.0;
    for (int i = 0; i < 60; ++i) {
      const int parent = i == 0 || rng.uniform() < 0.05 ? kNone : rng.below(i);
      const Vec3 p(rng.uniform(0, 100), rng.uniform(0, 100), 0);
      if (parent != kNone) length += (p - s[parent].position).norm();
      s.append({p, 1.0, parent});
    }
    const BranchTree tree = branch_tree(s);
    int nodes = 0;
    double sum = 0.0;
    for (std::size_t b = 0; b < tree.branches.size(); ++b) {
      const Branch& branch = tree.branches[b];
      nodes += static_cast<int>(branch.nodes.size());
      sum += branch.length;
      CHECK(branch.parent < static_cast<int>(b));
      CHECK(s[branch.nodes.front()].parent == branch.parent_node);
      for (std::size_t k = 1; k < branch.nodes.size(); ++k) {
        // The continuation is the child with the lowest index: brute force over all nodes.
        int lowest = kNone;
        for (int i = s.count() - 1; i >= 0; --i) lowest = s[i].parent == branch.nodes[k - 1] ? i : lowest;
        CHECK(branch.nodes[k] == lowest);
      }
    }
    CHECK(nodes == s.count());
    CHECK(sum == Approx(length));
  }
}
