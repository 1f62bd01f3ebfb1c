// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/style/bending.h"

#include <algorithm>
#include <cmath>

#include "ramify/core/random.h"
#include "ramify/geometry/polyline.h"

namespace ramify {
namespace {

constexpr int kProfileReach = 8;  // vertices to each side: one feature (PICTURES 12.2-3)

// Geometric mean of the radii within reach: widths multiply.
std::vector<double> radius_profile(const std::vector<double>& radii) {
  const int n = static_cast<int>(radii.size());
  std::vector<double> profile(radii.size());
  for (int i = 0; i < n; ++i) {
    const int reach = std::min({kProfileReach, std::max(i, 2), std::max(n - 1 - i, 2)});
    double sum = 0.0;
    int count = 0;
    for (int j = std::max(0, i - reach); j <= std::min(n - 1, i + reach); ++j, ++count) sum += std::log(radii[j]);
    profile[i] = std::exp(sum / count);
  }
  return profile;
}

double median(std::vector<double> values, double otherwise) {
  if (values.empty()) return otherwise;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// Median r.m.s. difference over random pairs of windows: the unit in which differences are felt.
void measure_gains(BendingModel& model) {
  std::vector<int> ends;  // last vertex of every window of at least m + 1 vertices
  for (int b = 0; b < model.branch_count(); ++b) {
    for (int i = model.first[b] + model.extension; i < model.first[b + 1]; ++i) ends.push_back(i);
  }
  if (ends.empty()) return;
  std::vector<int> branch_first(model.point.size());
  for (int b = 0; b < model.branch_count(); ++b) {
    for (int i = model.first[b]; i < model.first[b + 1]; ++i) branch_first[i] = model.first[b];
  }
  Rng rng = Rng(0).child("style.gains");
  std::vector<double> angles, radii;
  for (int pair = 0; pair < 2000; ++pair) {
    const int a = ends[rng.below(static_cast<int>(ends.size()))];
    const int b = ends[rng.below(static_cast<int>(ends.size()))];
    const int count = std::min({model.history + 1, a - branch_first[a], b - branch_first[b]});
    double angle = 0.0, radius = 0.0;
    for (int j = 0; j < count; ++j) {
      angle += std::pow(model.alpha[a - j] - model.alpha[b - j], 2);
      radius += std::pow(model.radius[a - j] - model.radius[b - j], 2);
    }
    angles.push_back(std::sqrt(angle / count));
    radii.push_back(std::sqrt(radius / count));
  }
  model.angle_gain = std::max(1e-3, median(angles, 1.0));
  model.radius_gain = std::max(0.1, median(radii, 1.0));
}

void measure_histograms(BendingModel& model, bool mirror) {
  double widest = 1e-6, low = model.radius.front(), high = low;
  for (const double alpha : model.alpha) widest = std::max(widest, std::abs(alpha));
  for (const double radius : model.radius) low = std::min(low, radius), high = std::max(high, radius);
  model.angles.low = -widest;
  model.angles.high = widest;
  model.radii.low = low;
  model.radii.high = std::max(high, low + 1e-6);
  for (int b = 0; b < model.branch_count(); ++b) {
    for (int i = model.first[b] + 1; i + 1 < model.first[b + 1]; ++i) {
      model.angles.add(model.alpha[i]);
      if (mirror) model.angles.add(-model.alpha[i]);
      model.radii.add(model.radius[i]);
    }
  }
}

double square_difference(std::span<const double> a, std::span<const double> b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
  return sum;
}

}  // namespace

BendingModel make_bending(const std::vector<BendingBranch>& branches, double step, int extension, int history, bool mirror) {
  BendingModel model;
  model.step = step;
  model.extension = extension;
  model.history = history;
  model.first = {0};
  for (const BendingBranch& branch : branches) {
    const std::vector<double> alpha = turning_angles(branch.points);
    const std::vector<double> profile = radius_profile(branch.radii);
    model.point.insert(model.point.end(), branch.points.begin(), branch.points.end());
    model.alpha.insert(model.alpha.end(), alpha.begin(), alpha.end());
    model.radius.insert(model.radius.end(), branch.radii.begin(), branch.radii.end());
    model.smooth_radius.insert(model.smooth_radius.end(), profile.begin(), profile.end());
    model.first.push_back(static_cast<int>(model.point.size()));
  }
  if (model.point.empty()) return model;
  measure_gains(model);
  measure_histograms(model, mirror);
  return model;
}

double likeness(double difference) { return 1.0 / (difference + 1.0) + 1.0; }

double window_quality(const BendingModel& model, std::span<const double> alpha_a, std::span<const double> alpha_b,
                      std::span<const double> radius_a, std::span<const double> radius_b, bool raw) {
  const double angle = square_difference(alpha_a, alpha_b), radius = square_difference(radius_a, radius_b);
  if (raw) return likeness(std::sqrt(angle)) * likeness(std::sqrt(radius));
  const double angles = std::max<std::size_t>(1, alpha_a.size()), radii = std::max<std::size_t>(1, radius_a.size());
  return likeness(std::sqrt(angle / angles) / model.angle_gain) *
         likeness(std::sqrt(radius / radii) / model.radius_gain);
}

}  // namespace ramify
