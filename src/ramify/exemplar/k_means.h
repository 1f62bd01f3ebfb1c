// SPDX-License-Identifier: GPL-3.0-or-later
// Private: k-means with seeded centres, the same for any number of threads.
#pragma once

#include <array>
#include <vector>

#include "ramify/core/random.h"

namespace ramify {

using Feature = std::array<float, 4>;

struct Clusters {
  std::vector<Feature> centres;
  std::vector<int> label;  // of every sample
};

// Centres start far apart (k-means++, Arthur and Vassilvitskii 2007). Empty clusters are dropped.
Clusters k_means(const std::vector<Feature>& samples, int clusters, Rng rng);

float distance2(const Feature& a, const Feature& b);

}  // namespace ramify
