// SPDX-License-Identifier: GPL-3.0-or-later
// Graphs over scattered points, in the plane or in space: Yao graphs (004), all pairs below a distance (004), neighbouring
// Voronoi cells (003; ALGORITHMS 9, 10). Undirected; neighbours in compressed rows. Paths are planned on them as on
// lattices (plan.h); edges of such graphs may cross each other, so their paths may too.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "ramify/core/types.h"

namespace ramify {

struct PointGraph {
  std::vector<Vec3> points;             // px or model units; z = 0 in the plane
  std::vector<std::int32_t> first{0};   // one a point and one more: its neighbours are first[i] … first[i + 1] - 1
  std::vector<std::int32_t> neighbor;   // ascending within a row; j is in the row of i as i is in the row of j
  std::vector<float> cost;              // one a neighbour, > 0, the same both ways; the makers below put the length

  int count() const { return static_cast<int>(points.size()); }
};

// The nearest neighbour of every point in each of `sectors` equal sectors (in the plane; the first starts at +x) or in
// each octant (in space, where `sectors` must be 8), not farther than `reach`; edges chosen from either end. In the plane
// all z must be equal. Ties go to the lower index. InputError for fewer than 3 sectors, a reach that is not above 0, or
// positions that are not finite.
PointGraph yao_graph(const std::vector<Vec3>& points, int sectors, double reach);

// All pairs not farther apart than `reach`.
PointGraph threshold_graph(const std::vector<Vec3>& points, double reach);

// Points whose cells touch: `label` holds the index of a point, or kNone, for every pixel of a width x height x depth grid
// (x fastest), and cells touch where pixels that share a side carry both labels. With the labels of a plan restricted to a
// region (geodesic Voronoi cells), the graph of a connected region is connected (ALGORITHMS 10).
PointGraph voronoi_graph(const std::vector<Vec3>& points, const std::vector<int>& label, int width, int height, int depth = 1);

// From a list of pairs, in any order, with repetitions; costs are lengths. Pairs of a point with itself are dropped.
PointGraph graph_from_pairs(const std::vector<Vec3>& points, std::vector<std::pair<int, int>> pairs);

// Costs length * (base + spread * u) with u uniform in [0, 1), a hash of the seed and the pair.
PointGraph with_hashed_costs(PointGraph graph, std::uint64_t seed, double base, double spread);

}  // namespace ramify
