// SPDX-License-Identifier: GPL-3.0-or-later
// The second-nearest generator of every node: what "rocks" and their smooth borders are made of (001 section 3.4,
// ALGORITHMS 8.6): the difference of both costs is zero on the border of a cell and grows inwards.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "ramify/graph/plan.h"

namespace ramify {

// For every node the generator its own path comes from, the nearest one that is another, and the cost of the least-cost
// path from that. Where generators cost the same, `own` is the plan's choice and `other` that of the path whose last step
// ties would give (plan.h).
struct TwoNearest {
  std::vector<std::int32_t> own, other;  // kNone where there is none
  std::vector<std::uint32_t> sum;        // ticks from `other`; read it by second_cost
  double ticks_per_unit = 1.0;
};

// plan: by Sum, not stopped early, of this graph. generator: one for every node, read at the plan's sources; >= 0. Sources
// may share a generator (a line, a whole dendrite). Nodes whose second cost is above the plan's max_cost keep none.
// O(n log n). Throws std::invalid_argument for another kind of plan, InputError for a source without a generator.
TwoNearest two_nearest(const Plan& plan, const Lattice& lattice, std::span<const int> generator, const Monitor& monitor = {});
TwoNearest two_nearest(const Plan& plan, const PointGraph& graph, std::span<const int> generator, const Monitor& monitor = {});

// Sources that touch (along the lattice's steps) as one generator: 0, 1, … in the order of their lowest nodes at those
// nodes, kNone elsewhere.
std::vector<int> connected_generators(const Lattice& lattice, std::span<const int> sources);

// In the unit of the weights; infinity where there is no second generator.
double second_cost(const TwoNearest& nearest, int node);

}  // namespace ramify
