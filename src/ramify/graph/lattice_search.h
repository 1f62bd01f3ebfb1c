// SPDX-License-Identifier: GPL-3.0-or-later
// From a lattice to the view of its connectivity and weights. Private to the layer.
#pragma once

#include "ramify/graph/run_search.h"
#include "ramify/graph/second_nearest.h"

namespace ramify {

struct WeightRange {
  double least = 0.0, most = 0.0, mean = 0.0;  // over allowed nodes; 0 when there are none
};
WeightRange weight_range(const Lattice& lattice);

double dearest_edge(const Lattice& lattice, const WeightRange& weights);

// Searches on from what the plan holds; task.bounds are set here. One definition for each number of steps.
template <int kSteps>
SearchEnd search_lattice(const Lattice& lattice, Plan& plan, SearchTask task, const WeightRange& weights, const Monitor& monitor);

// Fills in the second generators where `nearest` holds every node's own.
template <int kSteps>
SearchEnd search_lattice_again(const Lattice& lattice, const Plan& plan, const WeightRange& weights, TwoNearest& nearest, const Monitor& monitor);

}  // namespace ramify
