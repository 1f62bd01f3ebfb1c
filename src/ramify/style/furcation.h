// SPDX-License-Identifier: GPL-3.0-or-later
// Where branches fork: a linear support vector machine on the shape of the parent around a vertex and on the distances to
// its neighbouring furcations (paper 002, section 4.3), with a renewal process as fallback where there is too little to
// learn from (ALGORITHMS 4.4; PICTURES 12.2-9).
#pragma once

#include <array>
#include <span>
#include <vector>

#include "ramify/core/monitor.h"
#include "ramify/style/bending.h"
#include "ramify/style/hierarchy.h"

namespace ramify {

struct FurcationModel {
  int half_window = 24;           // k: vertices to each side that are looked at
  bool absolute_angles = true;    // features hold |alpha|: with mirrored data signed ones say nothing
  bool trained = false;           // false: too few furcations or no better than chance; use the gaps alone
  std::vector<double> mean;       // of every feature, for standardising; 4k + 4 entries
  std::vector<double> deviation;  // > 0
  std::vector<double> weight;     // the hyperplane, on standardised features
  double bias = 0.0;
  double slope = 1.0;             // probability = 1 / (1 + exp(-(slope * value + offset)))
  double offset = 0.0;
  int positives = 0;              // furcations seen
  double auc = 0.5;               // leave-one-branch-out, all features
  double auc_shape = 0.5;         // the same without the distances to neighbouring furcations
  double gap_log_mean = 3.0;      // log vertices between neighbouring furcations
  double gap_log_deviation = 0.6;
  std::array<double, kHeadingOrders> rate{};  // furcations per vertex by the order of the parent
};

struct FurcationOptions {
  bool absolute_angles = true;
  bool random_folds = false;  // as the paper's libsvm: five random folds for the probabilities instead of whole branches
};

FurcationModel learn_furcations(const BendingModel& bending, const Hierarchy& hierarchy, const FurcationOptions& options,
                                const Monitor& monitor);

// The 4k + 4 features of vertex `at`: angles, then radii over the mean radius, over 2k + 1 vertices (reflected at the
// ends), then log(1 + n/m) of the index distances to the furcation (or end) before and after, capped at 10 m.
std::vector<double> furcation_features(std::span<const double> alpha, std::span<const double> radius, int at, int before,
                                       int after, double unit_radius, const BendingModel& bending,
                                       const FurcationModel& model);

// Signed distance to the hyperplane in units of the margin: the higher, the likelier a furcation.
double furcation_value(const FurcationModel& model, std::span<const double> features);
double furcation_probability(const FurcationModel& model, double value);

}  // namespace ramify
