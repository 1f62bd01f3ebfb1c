// SPDX-License-Identifier: GPL-3.0-or-later
// Distances between two sets of measurements, and what such a distance is between two halves of one set.
#pragma once

#include <span>
#include <vector>

#include "ramify/core/random.h"

namespace ramify {

struct ShareHistogram {
  double low = 0.0, high = 1.0;  // the bins divide [low, high] equally; values outside count in the end bins
  std::vector<double> shares;    // summing to 1 (all 0 without values)
};
inline constexpr int kShareBins = 16;
ShareHistogram make_histogram(std::span<const double> values, double low, double high, int bins = kShareBins);

// Both over the range of the first set.
struct HistogramPair {
  ShareHistogram first, second;
};
HistogramPair make_histograms(std::span<const double> first, std::span<const double> second, int bins = kShareBins);

double total_variation(const ShareHistogram& a, const ShareHistogram& b);  // 0 same … 1 disjoint
double jensen_shannon(const ShareHistogram& a, const ShareHistogram& b);   // bits, 0 … 1

// Earth mover's distance between the samples themselves (no bins), in their unit; 0 when one is empty.
double earth_movers_distance(std::span<const double> a, std::span<const double> b);

// The distance that sampling alone makes: median over `times` random halvings of the runs, each half pooled.
// 0 without at least two runs.
struct NoiseFloor {
  double total_variation = 0.0;
  double jensen_shannon = 0.0;       // bits
  double earth_movers = 0.0;         // unit of the values
};
NoiseFloor noise_floor(const std::vector<std::vector<double>>& runs, Rng rng, int times = 20);

std::vector<double> pooled(const std::vector<std::vector<double>>& runs);

}  // namespace ramify
