// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/style/histogram.h"

#include <algorithm>
#include <cmath>

namespace ramify {

int Histogram::bin(double value) const {
  const double width = high - low;
  if (!(width > 0.0)) return 0;
  const double place = std::floor((value - low) / width * kHistogramBins);
  return static_cast<int>(std::clamp(place, 0.0, kHistogramBins - 1.0));
}

double histogram_distance(const Histogram& first, const Histogram& second) {
  double sum = 0.0;
  for (int b = 0; b < kHistogramBins; ++b) {
    const double difference = first.share(b) - second.share(b);
    sum += difference * difference;
  }
  return sum / kHistogramBins;
}

double histogram_gain(const Histogram& exemplar, const Histogram& grown, std::span<const double> values) {
  Histogram after = grown;
  for (const double value : values) after.add(value);
  return histogram_distance(exemplar, grown) - histogram_distance(exemplar, after);
}

}  // namespace ramify
