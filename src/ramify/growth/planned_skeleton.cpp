// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/growth/planned_skeleton.h"

#include <algorithm>
#include <stdexcept>
#include <tuple>

namespace ramify {

int draw_paths(Structure& structure, const Plan& plan, const Lattice& lattice, const std::vector<int>& endpoints, int round) {
  int reached = 0;
  for (const int endpoint : endpoints) {
    add_path(structure.forest, plan, lattice, endpoint);
    structure.rounds.resize(static_cast<std::size_t>(structure.forest.path_count), round);
    const int index = structure.forest.index_of[static_cast<std::size_t>(endpoint)];
    if (index == kNone) continue;
    structure.endpoints.push_back(index);
    ++reached;
  }
  return reached;
}

std::vector<int> endpoints_above(const Structure& structure) {
  const PathForest& forest = structure.forest;
  std::vector<int> count(forest.nodes.size(), 0);
  for (const int endpoint : structure.endpoints) ++count[static_cast<std::size_t>(endpoint)];
  for (std::size_t i = count.size(); i-- > 0;) {
    if (forest.parents[i] != kNone) count[static_cast<std::size_t>(forest.parents[i])] += count[i];
  }
  return count;
}

namespace {

// Children of every node, the branch's continuation first.
std::vector<std::vector<int>> ordered_children(const Structure& structure) {
  const PathForest& forest = structure.forest;
  const std::vector<int> above = endpoints_above(structure);
  std::vector<std::vector<int>> children(forest.nodes.size());
  for (std::size_t i = 0; i < children.size(); ++i) {
    if (forest.parents[i] != kNone) children[static_cast<std::size_t>(forest.parents[i])].push_back(static_cast<int>(i));
  }
  const auto rank = [&](int node) {
    const auto i = static_cast<std::size_t>(node);
    return std::make_tuple(structure.rounds[static_cast<std::size_t>(forest.paths[i])], -above[i], node);
  };
  for (std::vector<int>& list : children) {
    std::sort(list.begin(), list.end(), [&](int a, int b) { return rank(a) < rank(b); });
  }
  return children;
}

struct Start {
  int node, parent, order;  // node of the forest, skeleton node it hangs on, order of its branch
};

}  // namespace

Skeleton skeleton_from_structure(const Structure& structure, const std::vector<Vec3>& positions, const std::vector<double>& radii,
                                 Size canvas, int dim) {
  const std::size_t count = structure.forest.nodes.size();
  if (positions.size() != count || radii.size() != count) {
    throw std::invalid_argument("skeleton_from_structure: positions and radii must be one per node");
  }
  const std::vector<std::vector<int>> children = ordered_children(structure);
  Skeleton out(canvas);
  out.dim = dim;
  std::vector<Start> starts;
  for (std::size_t i = count; i-- > 0;) {
    if (structure.forest.parents[i] == kNone) starts.push_back({static_cast<int>(i), kNone, 0});
  }
  // A stack of branches still to draw: whole branches come out in one piece, so a continuation has a lower index than
  // the side branches at the same node.
  while (!starts.empty()) {
    const Start start = starts.back();
    starts.pop_back();
    std::vector<Start> sides;
    int parent = start.parent;
    for (int node = start.node; node != kNone;) {
      const auto i = static_cast<std::size_t>(node);
      Node made;
      made.position = positions[i];
      made.radius = radii[i];
      made.parent = parent;
      made.order = start.order;
      parent = out.append(made);
      const std::vector<int>& next = children[i];
      for (std::size_t k = 1; k < next.size(); ++k) sides.push_back({next[k], parent, start.order + 1});
      node = next.empty() ? kNone : next.front();
    }
    starts.insert(starts.end(), sides.rbegin(), sides.rend());
  }
  return out;
}

}  // namespace ramify
