// SPDX-License-Identifier: GPL-3.0-or-later
// How far a skeleton's structure is from an exemplar's (ALGORITHMS 7.1, PICTURES 1 and 10).
#pragma once

#include <vector>

#include "ramify/core/random.h"
#include "ramify/report/figure.h"
#include "ramify/skeleton/distribution.h"
#include "ramify/skeleton/skeleton.h"
#include "ramify/skeleton/statistics.h"

namespace ramify {

// Two distributions drawn on top of each other.
struct HistogramFigure {
  std::string label, unit;
  ShareHistogram exemplar, result;
};

struct StructureComparison {
  SkeletonStatistics exemplar, result;  // both at the exemplar's step
  std::vector<Figure> figures;
  std::vector<HistogramFigure> histograms;
};
StructureComparison compare_structure(const Skeleton& exemplar, const Skeleton& result, Rng rng);

// Overlap (F1 of centre lines 5 px wide) of two skeletons on equal canvases, the best over shifts up to a tenth of the
// shorter side and the eight flips and quarter turns, and the same with the second one turned by 45 degrees: chance.
struct SameStructure {
  double overlap = 0.0;
  double chance = 0.0;
};
SameStructure measure_same_structure(const Skeleton& a, const Skeleton& b);

}  // namespace ramify
