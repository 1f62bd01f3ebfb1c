// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>

#include "ramify/compose/placement.h"

namespace ramify {
namespace {

constexpr int kQuantiles = 20;
constexpr double kSlack = 1.25;  // fragments still match at this ratio of widths

// Quantiles 0, 5, …, 100 % of log radius over all pixels of all curves (so that long branches count more).
std::vector<double> log_radius_quantiles(const std::vector<BranchCurve>& curves) {
  std::vector<double> all;
  for (const BranchCurve& curve : curves) {
    for (const double r : curve.radii) all.push_back(std::log(r));
  }
  std::vector<double> quantiles;
  if (all.empty()) return quantiles;
  std::sort(all.begin(), all.end());
  for (int k = 0; k <= kQuantiles; ++k) quantiles.push_back(all[(all.size() - 1) * static_cast<std::size_t>(k) / kQuantiles]);
  return quantiles;
}

// Piecewise linear between the quantiles, shifted beyond the ends.
double mapped(double value, const std::vector<double>& from, const std::vector<double>& to) {
  if (value <= from.front()) return to.front();
  if (value >= from.back()) return to.back();
  const std::size_t k = static_cast<std::size_t>(std::upper_bound(from.begin(), from.end(), value) - from.begin());
  const double width = from[k] - from[k - 1];
  const double f = width > 0.0 ? (value - from[k - 1]) / width : 0.0;
  return to[k - 1] + f * (to[k] - to[k - 1]);
}

}  // namespace

Skeleton match_radii(const Skeleton& skeleton, const FragmentLibrary& library) {
  const std::vector<double> target = log_radius_quantiles(branch_curves(skeleton, {0.0, 0.0}));
  const std::vector<double> source = log_radius_quantiles(library.curves);
  if (target.empty() || source.empty()) return skeleton;
  const double low = std::log(library.thinnest / kSlack), high = std::log(library.thickest * kSlack);
  if (target[1] >= low && target[kQuantiles - 1] <= high) return skeleton;
  Skeleton result = skeleton;
  for (int i = 0; i < result.count(); ++i) {
    result.set_radius(i, std::exp(mapped(std::log(result[i].radius), target, source)));
  }
  return result;
}

}  // namespace ramify
