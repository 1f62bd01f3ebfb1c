// SPDX-License-Identifier: GPL-3.0-or-later
// How the costs of edges make the cost of a path (000 section 3.2, ALGORITHMS 8.2). From sum to full, paths wind more and
// more to keep away from any dear edge.
//
// Sum      the sum over edges: Dijkstra's.
// Power    (sum of costs^p)^(1/p), exact for every p >= 1: a dial from Sum (p = 1) to Full (p large).
// Mix      peak_share * peak + sum_share * sum, with peak the dearest edge so far (000 uses 1000 and 1 for its trees).
// Partial  the peak, ties by the sum: the "partial non-scalar metric" of 000.
// Full     all edges compared in falling order of cost (Pai and Reissel), exact: these are the paths within the minimum
//          spanning tree, so one pass of Prim's algorithm finds them.
//
// Partial and Mix are greedy, as in the papers: the label of a node is the best extension of a neighbour's final label,
// which is a tree, but (the pair is not isotone) not always the best pair of all paths. Peaks are exact. The length of
// diagonals counts in sums (also Power's) and not in peaks or in Full's comparison.
#pragma once

#include <vector>

#include "ramify/core/options.h"

namespace ramify {

enum class Metric { Sum, Partial, Full, Power, Mix };

struct MetricOptions {
  Metric metric = Metric::Sum;
  double power = 4.0;          // Power only: 1 … 64
  double peak_share = 1000.0;  // Mix only: >= 0
  double sum_share = 1.0;      // Mix only: > 0
};
std::vector<OptionField> describe(MetricOptions& options);

}  // namespace ramify
