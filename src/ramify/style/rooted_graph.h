// SPDX-License-Identifier: GPL-3.0-or-later
// The skeleton as runs of nodes, after loose trees have been tied to the branch they nearly touch.
#pragma once

#include <vector>

#include "ramify/core/monitor.h"
#include "ramify/skeleton/skeleton.h"

namespace ramify {

struct GraphRun {
  std::vector<int> nodes;    // of the skeleton, base to tip
  int parent_run = kNone;    // earlier run
  int parent_node = kNone;   // of the skeleton
};

struct RootedGraph {
  std::vector<GraphRun> runs;  // parents before children
  int tied = 0;                // loose trees attached
  int dropped = 0;             // trees left out
};

// A tree of less than 0.3 of the nodes whose end lies within 10 px of another tree's rim is attached there, unless it is at
// home where it begins: on the frame, beside another root, or at a node for which `anchored` is true (one entry per node, or
// none). Trees of less than 1.5 % of the nodes' length that do not reach the frame are left out. In trees that are attached
// by another end than their root, and so turned round, the continuation at a furcation is chosen by direction, width and
// length; elsewhere it stays the child with the lowest index unless another goes on clearly wider, longer and straighter.
// A branch that leaves the picture ends there: what goes on much thinner, or turns back, is a root.
RootedGraph tie_loose_trees(const Skeleton& skeleton, const std::vector<bool>& anchored, const Monitor& monitor);

}  // namespace ramify
