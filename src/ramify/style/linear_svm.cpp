// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/style/linear_svm.h"

#include <svm.h>

#include <algorithm>
#include <memory>

#include "ramify/core/memory.h"

namespace ramify {
namespace {

struct FreeModel {
  void operator()(svm_model* model) const { svm_free_and_destroy_model(&model); }
};

constexpr int kCacheMegabytes = 64;

void silent(const char*) {}

// Weights of the hyperplane from the support vectors, positive for true labels.
Hyperplane extract_plane(const svm_model& model, std::size_t dims) {
  Hyperplane plane;
  plane.weight.assign(dims, 0.0);
  for (int s = 0; s < model.l; ++s) {
    for (const svm_node* node = model.SV[s]; node->index != -1; ++node) {
      plane.weight[static_cast<std::size_t>(node->index - 1)] += model.sv_coef[0][s] * node->value;
    }
  }
  plane.bias = -model.rho[0];
  // libsvm counts the label it meets first as the positive side.
  if (model.label[0] < 0) {
    for (double& weight : plane.weight) weight = -weight;
    plane.bias = -plane.bias;
  }
  return plane;
}

}  // namespace

double Hyperplane::value(std::span<const double> point) const {
  double sum = bias;
  for (std::size_t d = 0; d < weight.size(); ++d) sum += weight[d] * point[d];
  return sum;
}

Hyperplane train_linear_svm(const std::vector<std::span<const double>>& points, const std::vector<bool>& labels,
                            double softness) {
  const auto positives = std::count(labels.begin(), labels.end(), true);
  const auto negatives = static_cast<std::ptrdiff_t>(labels.size()) - positives;
  const std::size_t dims = points.empty() ? 0 : points.front().size();
  if (positives == 0 || negatives == 0) return {std::vector<double>(dims, 0.0), 0.0};

  std::vector<svm_node> nodes(points.size() * (dims + 1));
  std::vector<svm_node*> rows;
  std::vector<double> targets;
  for (std::size_t i = 0; i < points.size(); ++i) {
    svm_node* row = &nodes[i * (dims + 1)];
    for (std::size_t d = 0; d < dims; ++d) row[d] = {static_cast<int>(d + 1), points[i][d]};
    row[dims] = {-1, 0.0};
    rows.push_back(row);
    targets.push_back(labels[i] ? 1.0 : -1.0);
  }
  require_memory((std::size_t{kCacheMegabytes} << 20) + 256 * points.size() + (8u << 20));  // libsvm does not look
  svm_problem problem{static_cast<int>(points.size()), targets.data(), rows.data()};
  int weighted_label = 1;
  double label_weight = static_cast<double>(negatives) / static_cast<double>(positives);
  svm_parameter parameter{};
  parameter.svm_type = C_SVC;
  parameter.kernel_type = LINEAR;
  parameter.cache_size = kCacheMegabytes;
  parameter.eps = 1e-3;
  parameter.C = softness;
  parameter.nr_weight = 1;
  parameter.weight_label = &weighted_label;
  parameter.weight = &label_weight;
  parameter.shrinking = 1;
  svm_set_print_string_function(silent);  // it would write to stdout
  const std::unique_ptr<svm_model, FreeModel> model(svm_train(&problem, &parameter));
  return extract_plane(*model, dims);
}

}  // namespace ramify
