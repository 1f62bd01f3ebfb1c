// SPDX-License-Identifier: GPL-3.0-or-later
// From nodes in any order, as files and tracers give them, to a Skeleton: parents before children, continuations first.
#pragma once

#include <vector>

#include "ramify/skeleton/skeleton.h"

namespace ramify {

struct LooseNode {
  Vec3 position = Vec3::Zero();  // px
  double radius = 1.0;           // px, > 0
  int parent = kNone;            // index into the same list, in any order; kNone for a root
  int tag = 0;
};

enum class ContinuationRule {
  AsListed,    // the child listed first goes on
  Straightest  // ALGORITHMS 3.3-9: cos(turn) + 0.5 r_child / r_parent + 0.25 x share of the subtrees' length
};

struct Assembled {
  Skeleton skeleton;          // orders counted; roots stay in their order and are never changed
  std::vector<int> index_of;  // new index of every loose node
};

// Lists that already have parents before children and the wanted continuations keep their indices. No recursion, so
// chains may be as long as memory allows. Throws std::invalid_argument for parents out of range or in a cycle (cut them
// before with cut_cycles).
Assembled assemble_skeleton(const std::vector<LooseNode>& nodes, Size canvas, ContinuationRule rule);

// Makes one node of every parent cycle a root (the one listed first) and returns the edges that were cut, as
// (node, former parent). O(n).
std::vector<std::pair<int, int>> cut_cycles(std::vector<LooseNode>& nodes);

// The same skeleton with its nodes in an order that makes the straightest child of every furcation the continuation.
Skeleton order_continuations(const Skeleton& skeleton);

// Sets every node's order from the branches (0 on root branches, +1 at every furcation away).
void count_orders(Skeleton& skeleton);

}  // namespace ramify
