// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/skeleton/radius_map.h"

#include <algorithm>
#include <numeric>
#include <stdexcept>

namespace ramify {
namespace {

// Piecewise linear through (xs, ys), constant beyond the ends; xs ascending.
double interpolated(const std::vector<double>& xs, const std::vector<double>& ys, double x) {
  if (x <= xs.front()) return ys.front();
  if (x >= xs.back()) return ys.back();
  const std::size_t k = static_cast<std::size_t>(std::upper_bound(xs.begin(), xs.end(), x) - xs.begin());
  const double f = (x - xs[k - 1]) / (xs[k] - xs[k - 1]);
  return ys[k - 1] + f * (ys[k] - ys[k - 1]);
}

RadiusSpread make_spread(const std::vector<double>& radii, const std::vector<double>& weights) {
  if (radii.empty()) throw std::invalid_argument("measure_radius_spread: there are no radii");
  std::vector<std::size_t> order(radii.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return radii[a] < radii[b]; });
  const double total = std::accumulate(weights.begin(), weights.end(), 0.0);
  RadiusSpread spread;
  double below = 0.0;
  for (std::size_t from = 0, to = 0; from < order.size(); from = to) {
    double own = 0.0;
    for (; to < order.size() && radii[order[to]] == radii[order[from]]; ++to) own += weights[order[to]];
    if (own > 0.0) {
      spread.radii.push_back(radii[order[from]]);
      spread.shares.push_back((below + 0.5 * own) / total);
    }
    below += own;
  }
  return spread;
}

}  // namespace

double RadiusSpread::radius_at(double share) const {
  return interpolated(shares, radii, share);
}
double RadiusSpread::share_at(double radius) const {
  return interpolated(radii, shares, radius);
}

RadiusSpread measure_radius_spread(const Skeleton& skeleton) {
  std::vector<double> radii, weights(static_cast<std::size_t>(skeleton.count()), 0.0);
  const auto add_edge = [&](int a, int b) {
    const double half = 0.5 * (skeleton[a].position - skeleton[b].position).norm();
    weights[a] += half, weights[b] += half;
  };
  for (int i = 0; i < skeleton.count(); ++i) {
    radii.push_back(skeleton[i].radius);
    if (skeleton[i].parent != kNone) add_edge(i, skeleton[i].parent);
  }
  for (const auto& [a, b] : skeleton.loop_links) add_edge(a, b);
  if (std::none_of(weights.begin(), weights.end(), [](double w) { return w > 0.0; }))
    return measure_radius_spread(std::move(radii));
  return make_spread(radii, weights);
}

RadiusSpread measure_radius_spread(std::vector<double> radii) {
  return make_spread(radii, std::vector<double>(radii.size(), 1.0));
}

Skeleton map_radii(const Skeleton& skeleton, const RadiusSpread& wanted) {
  if (skeleton.empty()) return skeleton;
  const RadiusSpread own = measure_radius_spread(skeleton);
  Skeleton result = skeleton;
  for (int i = 0; i < result.count(); ++i) result.set_radius(i, wanted.radius_at(own.share_at(result[i].radius)));
  return result;
}

}  // namespace ramify
