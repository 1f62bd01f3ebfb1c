// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/skeleton/distribution.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace ramify {
namespace {

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t n = values.size();
  return n == 0 ? 0.0 : 0.5 * (values[(n - 1) / 2] + values[n / 2]);
}

}  // namespace

ShareHistogram make_histogram(std::span<const double> values, double low, double high, int bins) {
  ShareHistogram histogram{low, high, std::vector<double>(static_cast<std::size_t>(bins), 0.0)};
  const double width = high > low ? (high - low) / bins : 1.0;
  for (const double v : values) {
    const int bin = static_cast<int>(std::clamp(std::floor((v - low) / width), 0.0, bins - 1.0));
    histogram.shares[bin] += 1.0 / static_cast<double>(values.size());
  }
  return histogram;
}

HistogramPair make_histograms(std::span<const double> first, std::span<const double> second, int bins) {
  double low = 0.0, high = 1.0;
  if (!first.empty()) {
    const auto [least, most] = std::minmax_element(first.begin(), first.end());
    low = *least, high = *most + 1e-9;
  }
  return {make_histogram(first, low, high, bins), make_histogram(second, low, high, bins)};
}

double total_variation(const ShareHistogram& a, const ShareHistogram& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.shares.size(); ++i) sum += std::abs(a.shares[i] - b.shares[i]);
  return 0.5 * sum;
}

double jensen_shannon(const ShareHistogram& a, const ShareHistogram& b) {
  const auto term = [](double p, double mean) { return p > 0.0 ? p * std::log2(p / mean) : 0.0; };
  double sum = 0.0;
  for (std::size_t i = 0; i < a.shares.size(); ++i) {
    const double mean = 0.5 * (a.shares[i] + b.shares[i]);
    sum += 0.5 * (term(a.shares[i], mean) + term(b.shares[i], mean));
  }
  return std::max(0.0, sum);
}

double earth_movers_distance(std::span<const double> a, std::span<const double> b) {
  if (a.empty() || b.empty()) return 0.0;
  std::vector<double> x(a.begin(), a.end()), y(b.begin(), b.end());
  std::sort(x.begin(), x.end());
  std::sort(y.begin(), y.end());
  // The area between the two cumulative distributions.
  double sum = 0.0, at = std::min(x.front(), y.front());
  for (std::size_t i = 0, j = 0; i < x.size() || j < y.size();) {
    const bool left = j == y.size() || (i < x.size() && x[i] <= y[j]);
    const double next = left ? x[i] : y[j];
    sum += (next - at) * std::abs(static_cast<double>(i) / x.size() - static_cast<double>(j) / y.size());
    at = next;
    ++(left ? i : j);
  }
  return sum;
}

std::vector<double> pooled(const std::vector<std::vector<double>>& runs) {
  std::vector<double> all;
  for (const auto& run : runs) all.insert(all.end(), run.begin(), run.end());
  return all;
}

NoiseFloor noise_floor(const std::vector<std::vector<double>>& runs, Rng rng, int times) {
  if (runs.size() < 2) return {};
  std::vector<int> order(runs.size());
  std::iota(order.begin(), order.end(), 0);
  std::vector<double> variations, divergences, distances;
  for (int t = 0; t < times; ++t) {
    rng.shuffle(order);
    std::vector<double> halves[2];
    for (std::size_t k = 0; k < order.size(); ++k) {
      auto& half = halves[k < order.size() / 2 ? 0 : 1];
      half.insert(half.end(), runs[order[k]].begin(), runs[order[k]].end());
    }
    const HistogramPair pair = make_histograms(halves[0], halves[1]);
    variations.push_back(total_variation(pair.first, pair.second));
    divergences.push_back(jensen_shannon(pair.first, pair.second));
    distances.push_back(earth_movers_distance(halves[0], halves[1]));
  }
  return {median(variations), median(divergences), median(distances)};
}

}  // namespace ramify
