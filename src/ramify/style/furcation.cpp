// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/style/furcation.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "ramify/core/parallel.h"
#include "ramify/core/random.h"
#include "ramify/style/linear_svm.h"

namespace ramify {
namespace {

constexpr int kMostFolds = 5;
constexpr int kMostNegatives = 400;
constexpr double kSoftness = 0.01;      // C; 100 features and few positives want a wide margin (PICTURES 12.2-9)
constexpr int kFewestPositives = 5;
constexpr double kUsefulAuc = 0.6;

struct Sample {
  std::vector<double> features;
  bool positive = false;
  int branch = 0;
};

double mean_radius(const BendingModel& bending) {
  return std::accumulate(bending.radius.begin(), bending.radius.end(), 0.0) / std::max(1, bending.vertex_count());
}

// Every furcation vertex, and evenly thinned others: a few thousand negatives say no more than a few hundred.
std::vector<Sample> collect_samples(const BendingModel& bending, const Hierarchy& hierarchy, const FurcationModel& model) {
  std::vector<std::vector<int>> forks(hierarchy.branches.size());
  for (const SourceBranch& branch : hierarchy.branches) {
    if (branch.parent != kNone) forks[branch.parent].push_back(branch.parent_vertex);
  }
  const double unit = mean_radius(bending);
  const int stride = std::max(1, bending.vertex_count() / std::clamp(3 * model.positives, 150, kMostNegatives));
  std::vector<Sample> samples;
  for (int b = 0; b < bending.branch_count(); ++b) {
    const int count = bending.length_of(b), first = bending.first[b];
    if (count < 6) continue;
    const std::span<const double> alpha(&bending.alpha[first], count), radius(&bending.radius[first], count);
    for (int i = 1; i + 1 < count; ++i) {
      const bool positive = std::find(forks[b].begin(), forks[b].end(), i) != forks[b].end();
      if (!positive && (first + i) % stride != 0) continue;
      int before = i, after = count - 1 - i;
      for (const int fork : forks[b]) {
        if (fork < i) before = std::min(before, i - fork);
        if (fork > i) after = std::min(after, fork - i);
      }
      Sample sample{furcation_features(alpha, radius, i, before, after, unit, bending, model), positive, b};
      samples.push_back(sample);
      if (positive && !model.absolute_angles) {
        for (int j = 0; j <= 2 * model.half_window; ++j) sample.features[j] *= -1.0;
        samples.push_back(sample);
      }
    }
  }
  return samples;
}

void standardise(FurcationModel& model, std::vector<Sample>& samples) {
  const std::size_t dims = samples.front().features.size();
  model.mean.assign(dims, 0.0);
  model.deviation.assign(dims, 0.0);
  for (const Sample& s : samples) {
    for (std::size_t d = 0; d < dims; ++d) model.mean[d] += s.features[d] / samples.size();
  }
  for (const Sample& s : samples) {
    for (std::size_t d = 0; d < dims; ++d) model.deviation[d] += std::pow(s.features[d] - model.mean[d], 2) / samples.size();
  }
  for (double& deviation : model.deviation) deviation = std::sqrt(deviation) + 1e-6;
  for (Sample& s : samples) {
    for (std::size_t d = 0; d < dims; ++d) s.features[d] = (s.features[d] - model.mean[d]) / model.deviation[d];
  }
}

Hyperplane train(const std::vector<Sample>& samples, const std::vector<int>& fold, int left_out, std::size_t dims) {
  std::vector<std::span<const double>> points;
  std::vector<bool> labels;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (fold[i] == left_out) continue;
    points.push_back(std::span(samples[i].features).first(dims));
    labels.push_back(samples[i].positive);
  }
  return train_linear_svm(points, labels, kSoftness);
}

// Decision value of every sample by a machine that has not seen its fold.
std::vector<double> held_out_values(const std::vector<Sample>& samples, const std::vector<int>& fold, std::size_t dims,
                                    const Monitor& monitor) {
  const int folds = 1 + *std::max_element(fold.begin(), fold.end());
  std::vector<Hyperplane> planes(folds);
  parallel_for(folds, [&](int f) {
    monitor.check();
    planes[f] = train(samples, fold, f, dims);
  });
  std::vector<double> values;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    values.push_back(planes[fold[i]].value(std::span(samples[i].features).first(dims)));
  }
  return values;
}

double area_under_curve(const std::vector<Sample>& samples, const std::vector<double>& values) {
  double wins = 0.0, pairs = 0.0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (!samples[i].positive) continue;
    for (std::size_t j = 0; j < samples.size(); ++j) {
      if (samples[j].positive) continue;
      wins += values[i] > values[j] ? 1.0 : values[i] == values[j] ? 0.5 : 0.0;
      pairs += 1.0;
    }
  }
  return pairs > 0.0 ? wins / pairs : 0.5;
}

// Logistic regression of the labels on the decision values by Newton's method, lightly damped so that separable data end.
void fit_probabilities(FurcationModel& model, const std::vector<Sample>& samples, const std::vector<double>& values) {
  double slope = 1.0, offset = 0.0;
  for (int round = 0; round < 50; ++round) {
    double g0 = 1e-3 * slope, g1 = 0.0, h00 = 1e-3, h01 = 0.0, h11 = 1e-6;
    for (std::size_t i = 0; i < samples.size(); ++i) {
      const double p = 1.0 / (1.0 + std::exp(-(slope * values[i] + offset)));
      const double error = p - (samples[i].positive ? 1.0 : 0.0), weight = p * (1.0 - p);
      g0 += error * values[i];
      g1 += error;
      h00 += weight * values[i] * values[i];
      h01 += weight * values[i];
      h11 += weight;
    }
    const double det = h00 * h11 - h01 * h01;
    if (!(det > 1e-12)) break;
    const double step0 = (h11 * g0 - h01 * g1) / det, step1 = (h00 * g1 - h01 * g0) / det;
    slope -= std::clamp(step0, -2.0, 2.0);
    offset -= std::clamp(step1, -2.0, 2.0);
    if (std::abs(step0) + std::abs(step1) < 1e-9) break;
  }
  model.slope = std::max(slope, 0.0);
  model.offset = offset;
}

void measure_gaps(FurcationModel& model, const BendingModel& bending, const Hierarchy& hierarchy) {
  std::vector<std::vector<int>> forks(hierarchy.branches.size());
  std::array<double, kHeadingOrders> vertices{};
  for (int b = 0; b < bending.branch_count(); ++b) {
    const SourceBranch& branch = hierarchy.branches[b];
    vertices[std::min(branch.order, kHeadingOrders - 1)] += bending.length_of(b);
    if (branch.parent == kNone) continue;
    forks[branch.parent].push_back(branch.parent_vertex);
    model.rate[std::min(branch.order - 1, kHeadingOrders - 1)] += 1.0;
    ++model.positives;
  }
  for (int o = 0; o < kHeadingOrders; ++o) model.rate[o] /= std::max(1.0, vertices[o]);
  std::vector<double> logs;
  for (std::vector<int>& places : forks) {
    std::sort(places.begin(), places.end());
    for (std::size_t i = 1; i < places.size(); ++i) logs.push_back(std::log(std::max(1, places[i] - places[i - 1])));
  }
  if (logs.size() < 3) return;
  model.gap_log_mean = std::accumulate(logs.begin(), logs.end(), 0.0) / logs.size();
  double square = 0.0;
  for (const double log : logs) square += std::pow(log - model.gap_log_mean, 2);
  model.gap_log_deviation = std::max(0.1, std::sqrt(square / logs.size()));
}

std::vector<int> make_folds(const std::vector<Sample>& samples, bool random) {
  Rng rng = Rng(0).child("style.folds");
  std::vector<int> fold;
  for (const Sample& sample : samples) fold.push_back(random ? rng.below(5) : sample.branch % kMostFolds);
  // Folds without a sample would train nothing: number those that occur.
  std::vector<int> number(kMostFolds, kNone);
  int used = 0;
  for (int& f : fold) {
    if (number[f] == kNone) number[f] = used++;
    f = number[f];
  }
  return fold;
}

}  // namespace

std::vector<double> furcation_features(std::span<const double> alpha, std::span<const double> radius, int at, int before,
                                       int after, double unit_radius, const BendingModel& bending,
                                       const FurcationModel& model) {
  const int last = static_cast<int>(alpha.size()) - 1;
  const auto reflected = [&](int i) {
    i = std::abs(i);
    return std::clamp(i > last ? 2 * last - i : i, 0, last);
  };
  std::vector<double> features;
  features.reserve(4 * model.half_window + 4);
  for (int j = -model.half_window; j <= model.half_window; ++j) {
    const double turn = alpha[reflected(at + j)];
    features.push_back(model.absolute_angles ? std::abs(turn) : turn);
  }
  for (int j = -model.half_window; j <= model.half_window; ++j) features.push_back(radius[reflected(at + j)] / unit_radius);
  const double m = bending.extension;
  features.push_back(std::log(1.0 + std::min(10.0, before / m)));
  features.push_back(std::log(1.0 + std::min(10.0, after / m)));
  return features;
}

double furcation_value(const FurcationModel& model, std::span<const double> features) {
  double value = model.bias;
  for (std::size_t d = 0; d < model.weight.size(); ++d) {
    value += model.weight[d] * (features[d] - model.mean[d]) / model.deviation[d];
  }
  return value;
}

double furcation_probability(const FurcationModel& model, double value) {
  return 1.0 / (1.0 + std::exp(-(model.slope * value + model.offset)));
}

FurcationModel learn_furcations(const BendingModel& bending, const Hierarchy& hierarchy, const FurcationOptions& options,
                                const Monitor& monitor) {
  FurcationModel model;
  model.half_window = bending.history;
  model.absolute_angles = options.absolute_angles;
  measure_gaps(model, bending, hierarchy);
  if (model.positives < kFewestPositives) {
    monitor.note("only " + std::to_string(model.positives) +
                 " furcations to learn from: they are placed by their gaps alone");
    return model;
  }
  std::vector<Sample> samples = collect_samples(bending, hierarchy, model);
  if (std::none_of(samples.begin(), samples.end(), [](const Sample& s) { return s.positive; })) return model;
  standardise(model, samples);
  const std::size_t dims = samples.front().features.size();
  const std::vector<int> by_branch = make_folds(samples, false);
  const std::vector<double> values = held_out_values(samples, by_branch, dims, monitor);
  model.auc = area_under_curve(samples, values);
  model.auc_shape = area_under_curve(samples, held_out_values(samples, by_branch, dims - 2, monitor));
  const Hyperplane plane = train(samples, by_branch, kNone, dims);
  model.weight = plane.weight;
  model.bias = plane.bias;
  fit_probabilities(model, samples,
                    options.random_folds ? held_out_values(samples, make_folds(samples, true), dims, monitor) : values);
  model.trained = model.auc >= kUsefulAuc;
  if (!model.trained) monitor.note("the shape of the branches does not tell where they fork: gaps alone are used");
  return model;
}

}  // namespace ramify
