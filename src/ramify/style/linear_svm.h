// SPDX-License-Identifier: GPL-3.0-or-later
// Linear support vector classification by libsvm, reduced to what is deterministic: its own cross-validation and
// probabilities draw from rand() and are not used.
#pragma once

#include <span>
#include <vector>

namespace ramify {

struct Hyperplane {
  std::vector<double> weight;
  double bias = 0.0;

  double value(std::span<const double> point) const;  // positive on the side of the true labels
};

// Points of equal size with their labels; softness is C, > 0; the rarer label weighs as much as the other in sum. With
// only one label given, or none, the hyperplane is zero.
Hyperplane train_linear_svm(const std::vector<std::span<const double>>& points, const std::vector<bool>& labels,
                            double softness);

}  // namespace ramify
