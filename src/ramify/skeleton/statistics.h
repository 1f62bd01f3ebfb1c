// SPDX-License-Identifier: GPL-3.0-or-later
// Figures of a skeleton's structure (ALGORITHMS 7.1, PICTURES 10): what a style should reproduce and a report compares.
#pragma once

#include <vector>

#include "ramify/skeleton/skeleton.h"

namespace ramify {

// Length-weighted mean of the edges' directions: strength |mean e^(i theta)| 0..1 and its angle.
struct Heading {
  double strength = 0.0;
  double direction = 0.0;  // rad
};

// Turning angles and radii after smoothing (sigma 2 px for points, 4 px for radii) and resampling to `step`: a traced
// line's pixel staircase is not style. Kept in runs of about 40 px, the unit that noise floors are drawn from.
struct BendSamples {
  double step = 8.0;                         // px, h
  std::vector<std::vector<double>> angles;   // rad
  std::vector<std::vector<double>> radii;    // px
  double length = 0.0;                       // px of branches long enough to count (2 h)
};

struct SkeletonStatistics {
  BendSamples bends;
  double total_length = 0.0;          // px, all edges
  int branches = 0, roots = 0, tips = 0;
  int furcations = 0;                 // nodes with two or more children
  double furcations_per_1000px = 0.0; // of bends.length
  std::vector<double> gaps;           // px along a branch between neighbouring furcations
  std::vector<double> order_lengths;  // px, by branch order
  std::vector<int> strahler_streams;  // streams of Strahler order 1, 2, …
  std::vector<double> tortuosity;     // arc / chord of every branch longer than 2 h, sorted
  std::vector<double> fork_angles;    // rad, measure_child_starts
  std::vector<double> fork_ratios;    // radius of child / parent
  double box_dimension = 0.0;         // of the rasterised centre line; 0 when the canvas is too small to tell
  int crossings = 0;                  // pairs of edges that cross
  Heading heading;
  std::vector<Heading> order_headings;
};

// h for comparing with this skeleton: 4 x the median radius of its nodes, clamped to 8..16 px (PICTURES 10).
double comparison_step(const Skeleton& skeleton);

// `step` (px) must be the exemplar's for both skeletons of a comparison; 0 means comparison_step(skeleton).
SkeletonStatistics measure_statistics(const Skeleton& skeleton, double step = 0.0);

BendSamples measure_bends(const Skeleton& skeleton, double step);

// Pairs of edges, named by their child nodes (the lower one first), whose insides cross in exact arithmetic. Expected
// O(n) for edges of similar length. Sorted.
std::vector<std::pair<int, int>> find_crossings(const Skeleton& skeleton);

// Slope of log N on log 1/eps, N = boxes of eps = 2^k px that the centre line enters, from 2 x the smallest radius (at
// least 2 px) to an eighth of the longer side.
double box_dimension(const Skeleton& skeleton);

// Linear interpolation between order statistics (as numpy's default); q in 0..1; 0 for no values.
double quantile(std::vector<double> values, double q);

}  // namespace ramify
