// SPDX-License-Identifier: GPL-3.0-or-later
// From the drawn paths of a plan to a Skeleton.
#pragma once

#include <vector>

#include "ramify/graph/path_forest.h"
#include "ramify/skeleton/skeleton.h"

namespace ramify {

// Paths drawn so far and the round in which each was added.
struct Structure {
  PathForest forest;
  std::vector<int> rounds;     // one a path
  std::vector<int> endpoints;  // indices into forest.nodes: where paths end
};

// Draws the paths of a plan to these endpoints (lattice nodes); returns how many could be reached. An endpoint that lies
// on a path drawn before is an end of that path's stretch.
int draw_paths(Structure& structure, const Plan& plan, const Lattice& lattice, const std::vector<int>& endpoints, int round);

// How many endpoints lie at or above (away from the root) every node of the forest.
std::vector<int> endpoints_above(const Structure& structure);

// positions, radii: one per node of the forest. A branch goes on into the child of the earliest round, of these with the
// most endpoints above it, then into the earlier one; orders count the furcations away from that line.
Skeleton skeleton_from_structure(const Structure& structure, const std::vector<Vec3>& positions, const std::vector<double>& radii,
                                 Size canvas, int dim);

}  // namespace ramify
