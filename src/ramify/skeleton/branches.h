// SPDX-License-Identifier: GPL-3.0-or-later
// The branches of a skeleton: derived, never stored.
#pragma once

#include <vector>

#include "ramify/skeleton/skeleton.h"

namespace ramify {

struct Branch {
  std::vector<int> nodes;   // base to tip; a child's first node is its first vertex after the junction
  int parent = kNone;       // branch it leaves, or kNone for a root branch
  int parent_node = kNone;  // node of the parent where it leaves
  int order = 0;            // 0 for a root branch, parent's + 1 otherwise
  double length = 0.0;      // px, including the edge from the parent's node
};

struct BranchTree {
  std::vector<Branch> branches;     // parents before children, in the order of their first node
  std::vector<int> branch_of_node;  // for every node
};

// O(n). The continuation at a furcation is the child with the lowest index.
BranchTree branch_tree(const Skeleton& skeleton);

// The branch's points with the parent's node in front (when there is one), and the radii beside them. The parent's node
// counts with the child's own first radius, so that a thin child does not start as thick as its parent.
struct Polyline {
  std::vector<Vec2> points;   // px
  std::vector<double> radii;  // px, one per point
};
Polyline branch_polyline(const Skeleton& skeleton, const Branch& branch);

}  // namespace ramify
