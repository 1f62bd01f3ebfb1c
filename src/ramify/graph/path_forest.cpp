// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/graph/path_forest.h"

#include <algorithm>
#include <cstdlib>
#include <utility>

namespace ramify {
namespace {

bool drawn_between(const PathForest& forest, int a, int b) {
  const int i = forest.index_of[a], j = forest.index_of[b];
  if (i < 0 || j < 0) return false;
  return forest.parents[i] == j || forest.parents[j] == i;
}

// The generator a source belongs to; for drawn sources of later rounds that of their tree.
int generator_of(const PathForest& forest, int source) {
  if (forest.generator.empty()) return 0;
  int index = forest.index_of[source];
  if (index == kNone) return forest.generator[source];
  while (forest.parents[index] != kNone) index = forest.parents[index];
  return forest.generator[forest.nodes[index]];
}

// A path as it is walked from its endpoint. Its nodes are marked in the forest's index by negative positions.
class Walk {
 public:
  explicit Walk(PathForest& forest) : forest_(forest) {}
  void push(int node) {
    forest_.index_of[node] = kFirstMark - static_cast<int>(way_.size());
    way_.push_back(node);
  }
  void cut_after(int position) {
    for (; static_cast<int>(way_.size()) > position + 1; way_.pop_back()) forest_.index_of[way_.back()] = kNone;
  }
  int back() const { return way_.back(); }
  // The position of the first of two nodes that follow each other on the way, or kNone.
  int edge_between(int a, int b) const {
    const int i = kFirstMark - forest_.index_of[a], j = kFirstMark - forest_.index_of[b];
    return i >= 0 && j >= 0 && std::abs(i - j) == 1 ? std::min(i, j) : kNone;
  }
  // Forgets the marks and gives the way from the source's side to the endpoint.
  std::vector<int> finish() {
    for (const int node : way_) forest_.index_of[node] = kNone;
    std::reverse(way_.begin(), way_.end());
    return std::move(way_);
  }

 private:
  static constexpr int kFirstMark = kNone - 1;
  PathForest& forest_;
  std::vector<int> way_;
};

// What lies across a step: a drawn line, of which `joint` is an end next to the step's start, or the walk's own edge
// that begins at position `own`.
struct Crossing {
  int joint = kNone;
  int own = kNone;
};

// Lines across a step are the other diagonals of the box it spans. Of the two ends of a drawn line the cheaper one in the
// plane, in space the one along an axis.
Crossing find_crossing(const PathForest& forest, const Walk& walk, const Lattice& lattice, int node, int to) {
  const auto a = node_place(lattice, node), b = node_place(lattice, to);
  const int along[3] = {b[0] - a[0], (b[1] - a[1]) * lattice.width, (b[2] - a[2]) * lattice.width * lattice.height};
  const int axes = (along[0] != 0) + (along[1] != 0) + (along[2] != 0);
  if (axes < 2) return {};
  for (const int offset : along) {
    if (offset == 0) continue;
    const int one = node + offset, other = to - offset;
    if (drawn_between(forest, one, other)) {
      return {axes == 2 && node_weight(lattice, other) < node_weight(lattice, one) ? other : one, kNone};
    }
    const int own = walk.edge_between(one, other);
    if (own != kNone) return {kNone, own};
  }
  return {};
}

AddedPath append_way(PathForest& forest, const std::vector<int>& way, int joint, bool aside) {
  const AddedPath added{static_cast<int>(forest.nodes.size()), static_cast<int>(way.size()), aside, false};
  for (const int node : way) {
    const int index = static_cast<int>(forest.nodes.size());
    forest.nodes.push_back(node);
    forest.parents.push_back(joint);
    forest.paths.push_back(forest.path_count);
    forest.index_of[node] = joint = index;
  }
  ++forest.path_count;
  return added;
}

// Follows the parents from `endpoint` until something drawn or a source. crossing(walk, from, to) tells what is in the way.
template <class Parent, class Across>
AddedPath follow(PathForest& forest, const Plan& plan, int endpoint, const Parent& parent, const Across& crossing) {
  AddedPath none{static_cast<int>(forest.nodes.size())};
  if (!is_reached(plan, endpoint) || forest.index_of[endpoint] != kNone) return none;
  Walk walk(forest);
  walk.push(endpoint);
  bool aside = false;
  int source = endpoint, joint = kNone;
  for (int next = parent(endpoint); next != kNone && joint == kNone; next = parent(next)) {
    source = next;
    Crossing across = crossing(walk, walk.back(), next);
    for (; across.own != kNone; across = crossing(walk, walk.back(), next)) {
      walk.cut_after(across.own);
      aside = true;
    }
    aside = aside || across.joint != kNone;
    joint = forest.index_of[across.joint != kNone ? across.joint : next];
    if (joint == kNone) walk.push(next);
  }
  const std::vector<int> way = walk.finish();
  if (!aside || joint == kNone) return append_way(forest, way, joint, aside);
  for (int next = source; next != kNone; next = parent(next)) source = next;
  if (generator_of(forest, source) == generator_of(forest, forest.nodes[joint])) return append_way(forest, way, joint, true);
  none.aside = none.blocked = true;
  return none;
}

template <class Position>
std::vector<std::vector<Vec3>> polylines(const PathForest& forest, const Position& position) {
  std::vector<std::vector<Vec3>> lines(static_cast<std::size_t>(forest.path_count));
  for (std::size_t i = 0; i < forest.nodes.size(); ++i) {
    std::vector<Vec3>& line = lines[forest.paths[i]];
    if (line.empty() && forest.parents[i] != kNone) line.push_back(position(forest.nodes[forest.parents[i]]));
    line.push_back(position(forest.nodes[i]));
  }
  return lines;
}

}  // namespace

PathForest make_path_forest(int graph_nodes, std::vector<int> generator) {
  PathForest forest;
  forest.generator = std::move(generator);
  forest.index_of.assign(static_cast<std::size_t>(graph_nodes), kNone);
  return forest;
}

AddedPath add_path(PathForest& forest, const Plan& plan, const Lattice& lattice, int endpoint) {
  return follow(forest, plan, endpoint, [&](int node) { return path_parent(plan, lattice, node); },
                [&](const Walk& walk, int from, int to) { return find_crossing(forest, walk, lattice, from, to); });
}

AddedPath add_path(PathForest& forest, const Plan& plan, const PointGraph& graph, int endpoint) {
  return follow(forest, plan, endpoint, [&](int node) { return path_parent(plan, graph, node); },
                [](const Walk&, int, int) { return Crossing{}; });
}

std::vector<std::vector<Vec3>> forest_polylines(const PathForest& forest, const Lattice& lattice) {
  return polylines(forest, [&](int node) { return node_position(lattice, node); });
}

std::vector<std::vector<Vec3>> forest_polylines(const PathForest& forest, const PointGraph& graph) {
  return polylines(forest, [&](int node) { return graph.points[node]; });
}

}  // namespace ramify
