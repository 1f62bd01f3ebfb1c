// SPDX-License-Identifier: GPL-3.0-or-later
// The drawn part of a plan: the paths of chosen endpoints, joined to trees (001 section 3, 000 section 3.1). A path is
// followed from its endpoint towards its source and ends where it meets what was drawn before, so the forest only grows,
// round after round, and its nodes are the sources of the next round (reseeded).
//
// Drawn paths never cross. On lattices with diagonals two edges may cross between nodes. Within one plan by Sum from the
// weights of nodes they cannot (the two axial ways around would be cheaper: sqrt 2 (a + b + c + d) > a + b + c + d), but
// other metrics and weights, and lines of earlier rounds, leave such places. There a path does not cross: it turns aside
// by one step onto the line it would cross and joins that; a path that would cross itself leaves out the loop. If the line
// grew from another generator, the path is not drawn at all. Edges of point graphs are not checked: they may cross.
#pragma once

#include <vector>

#include "ramify/graph/plan.h"

namespace ramify {

// Nodes of the graph with their parents; a parent stands before its children, so the forest is a skeleton already.
struct PathForest {
  std::vector<int> nodes;     // of the graph
  std::vector<int> parents;   // indices into `nodes`; kNone for the roots, which are sources
  std::vector<int> paths;     // with which path (0, 1, …, in the order they were added) the node came
  std::vector<int> index_of;  // one a node of the graph: where it stands in `nodes`, or kNone
  std::vector<int> generator; // one a node of the graph, read at sources: which generator it belongs to; empty = all are one
  int path_count = 0;         // paths added
};
PathForest make_path_forest(int graph_nodes, std::vector<int> generator = {});

// What adding a path did. Its nodes are forest.nodes[first … first + count - 1], from the joint to the endpoint.
struct AddedPath {
  int first = 0;
  int count = 0;         // 0: the endpoint was drawn already, is not reached, or is cut off by a line of another generator
  bool aside = false;    // it left its planned way so as not to cross a line
  bool blocked = false;  // not drawn: it would have crossed a line of another generator
};
AddedPath add_path(PathForest& forest, const Plan& plan, const Lattice& lattice, int endpoint);
AddedPath add_path(PathForest& forest, const Plan& plan, const PointGraph& graph, int endpoint);

// Each added path as the positions of its nodes from the node it joins (or its source) to its endpoint, in px.
std::vector<std::vector<Vec3>> forest_polylines(const PathForest& forest, const Lattice& lattice);
std::vector<std::vector<Vec3>> forest_polylines(const PathForest& forest, const PointGraph& graph);

}  // namespace ramify
