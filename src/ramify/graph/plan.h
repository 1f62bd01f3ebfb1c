// SPDX-License-Identifier: GPL-3.0-or-later
// Least-cost paths from a set of sources to every node of a lattice or point graph (papers 000, 001; ALGORITHMS 8).
// The walk: plan_paths → PathForest (path_forest.h) takes the paths of endpoints out of it → reseeded makes their nodes
// sources for the next round.
//
// Costs are whole numbers of ticks, a power of two to the unit, chosen so that the largest cost fits: weights that are
// whole numbers give exact costs wherever no diagonal has its own length. Ties go to the neighbour with the lower cost,
// then to the one with the lower index. So a plan is one unique forest, whatever queue found it.
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "ramify/core/monitor.h"
#include "ramify/graph/lattice.h"
#include "ramify/graph/metric.h"
#include "ramify/graph/point_graph.h"
#include "ramify/graph/step_array.h"

namespace ramify {

struct PlanOptions {
  MetricOptions metric{};
  // Truncation: nodes that cost more stay unreached. In the unit of weights; Partial, Full: of the peak; Mix: of the mix.
  double max_cost = std::numeric_limits<double>::infinity();
  // Early stop: when all these nodes have their final cost (or cannot be reached); empty = go on to the end.
  std::vector<int> endpoints{};
};

// Ticks along a path, and of its dearest edge (without lengths).
struct SumAndPeak {
  std::uint32_t sum = 0, peak = 0;
  friend bool operator==(const SumAndPeak&, const SumAndPeak&) = default;
};

// What is known of every node. Read it through the functions below; the arrays are what they are to be small (lattices:
// 4.5 bytes a node for Sum, 8.5 for Partial, Mix, Full and Power; half a byte more with 26 neighbours).
struct Plan {
  MetricOptions metric;
  double ticks_per_unit = 1.0;
  double max_cost = std::numeric_limits<double>::infinity();
  bool stopped_early = false;         // some nodes are unreached because the endpoints came first
  double power_unit = 1.0;            // Power: the dearest edge possible
  std::vector<std::uint32_t> sum;     // Sum: ticks along the path
  std::vector<SumAndPeak> pair;       // Partial, Mix, Full
  std::vector<double> power_sum;      // Power: sum of (cost / power_unit)^p
  StepArray step;                     // lattices: the step from the node to its parent, kSource, kForbidden or kUnreached
  std::vector<std::int32_t> parent;   // point graphs: the parent, or one of those three taken negative
};

// Throws InputError when a source does not exist or is forbidden, or there is none; OptionError for options out of range.
Plan plan_paths(const Lattice& lattice, std::span<const int> sources, const PlanOptions& options = {},
                const Monitor& monitor = {});
Plan plan_paths(const PointGraph& graph, std::span<const int> sources, const PlanOptions& options = {},
                const Monitor& monitor = {});

// The plan with more sources: `nodes` (say, those of the paths drawn so far) cost nothing from now on. Costs only fall, so
// for Sum and Power only what improves is touched, and the result is what plan_paths would find for all the sources;
// the other metrics plan anew (their labels do not stay valid). The lattice must be the one planned on.
// max_cost: at most the plan's (OptionError). Nodes that now cost more than it may keep a cost that is too high, but is
// above max_cost too. Throws InputError as plan_paths, std::invalid_argument when the plan was stopped early.
Plan reseeded(Plan plan, const Lattice& lattice, std::span<const int> nodes, double max_cost, const Monitor& monitor = {});
Plan reseeded(Plan plan, const PointGraph& graph, std::span<const int> nodes, double max_cost, const Monitor& monitor = {});

bool is_reached(const Plan& plan, int node);
// The cost by the plan's metric in the unit of the weights (Partial, Full: the peak); infinity when unreached.
double path_cost(const Plan& plan, int node);
// The sum of the edges on the path; infinity when unreached. Not known for Power.
double path_sum(const Plan& plan, int node);
// The next node on the way to the source; kNone for sources and for nodes that are not reached.
int path_parent(const Plan& plan, const Lattice& lattice, int node);
int path_parent(const Plan& plan, const PointGraph& graph, int node);

// For every node the source its path starts from, kNone where none: the label of the nearest generator.
std::vector<int> nearest_sources(const Plan& plan, const Lattice& lattice);
std::vector<int> nearest_sources(const Plan& plan, const PointGraph& graph);

}  // namespace ramify
