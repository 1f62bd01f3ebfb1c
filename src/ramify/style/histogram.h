// SPDX-License-Identifier: GPL-3.0-or-later
// Histograms of angles and radii over the exemplar's range, and how much an extension would improve a growing one
// (paper 002, section 4.2, "histogram matching"; ALGORITHMS 2 for the restored formula).
#pragma once

#include <array>
#include <span>

namespace ramify {

inline constexpr int kHistogramBins = 16;  // B of the paper

struct Histogram {
  double low = 0.0;   // left edge of the first bin
  double high = 1.0;  // right edge of the last
  std::array<double, kHistogramBins> counts{};
  double total = 0.0;

  int bin(double value) const;  // values outside go to the end bins
  void add(double value, double weight = 1.0) {
    counts[static_cast<std::size_t>(bin(value))] += weight;
    total += weight;
  }
  double share(int b) const { return total > 0.0 ? counts[static_cast<std::size_t>(b)] / total : 0.0; }
};

// (1/B) times the squared distance of the normalised histograms. An empty histogram counts as all zero.
double histogram_distance(const Histogram& first, const Histogram& second);

// Delta of the paper: histogram_distance(exemplar, grown) - histogram_distance(exemplar, grown with `values` added).
// Positive when the values bring the grown histogram nearer. O(B + values).
double histogram_gain(const Histogram& exemplar, const Histogram& grown, std::span<const double> values);

}  // namespace ramify
