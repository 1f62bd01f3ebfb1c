// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/exemplar/k_means.h"

#include <limits>

namespace ramify {
namespace {

int nearest(const std::vector<Feature>& centres, const Feature& sample) {
  int best = 0;
  for (int k = 1; k < static_cast<int>(centres.size()); ++k) {
    if (distance2(centres[k], sample) < distance2(centres[best], sample)) best = k;
  }
  return best;
}

std::vector<Feature> spread_centres(const std::vector<Feature>& samples, int clusters, Rng& rng) {
  std::vector<Feature> centres{samples[rng.below(static_cast<int>(samples.size()))]};
  std::vector<double> weight(samples.size(), std::numeric_limits<double>::max());
  while (static_cast<int>(centres.size()) < clusters) {
    for (std::size_t i = 0; i < samples.size(); ++i) {
      weight[i] = std::min<double>(weight[i], distance2(samples[i], centres.back()));
    }
    centres.push_back(samples[rng.discrete(weight)]);
  }
  return centres;
}

}  // namespace

float distance2(const Feature& a, const Feature& b) {
  float sum = 0.0f;
  for (std::size_t k = 0; k < a.size(); ++k) sum += (a[k] - b[k]) * (a[k] - b[k]);
  return sum;
}

Clusters k_means(const std::vector<Feature>& samples, int clusters, Rng rng) {
  Clusters result;
  if (samples.empty() || clusters < 1) return result;
  result.centres = spread_centres(samples, clusters, rng);
  result.label.assign(samples.size(), -1);
  constexpr int kRounds = 30;
  for (int round = 0; round < kRounds; ++round) {
    bool moved = false;
    for (std::size_t i = 0; i < samples.size(); ++i) {
      const int k = nearest(result.centres, samples[i]);
      moved = moved || k != result.label[i];
      result.label[i] = k;
    }
    if (!moved) break;
    std::vector<std::array<double, 4>> sum(result.centres.size(), {0.0, 0.0, 0.0, 0.0});
    std::vector<int> count(result.centres.size(), 0);
    for (std::size_t i = 0; i < samples.size(); ++i) {
      ++count[result.label[i]];
      for (int d = 0; d < 4; ++d) sum[result.label[i]][d] += samples[i][d];
    }
    for (std::size_t k = 0; k < result.centres.size(); ++k) {
      for (int d = 0; d < 4 && count[k] > 0; ++d) result.centres[k][d] = static_cast<float>(sum[k][d] / count[k]);
    }
  }
  return result;
}

}  // namespace ramify
