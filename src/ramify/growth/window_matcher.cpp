// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/growth/window_matcher.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace ramify {

WindowMatcher::WindowMatcher(const BendingModel& model) : model_(model), pad_(model.history + 1) {
  alpha_.assign(pad_, 0.0f);
  radius_.assign(pad_, 0.0f);
  alpha_sums_ = {0.0};
  radius_sums_ = {0.0};
  for (int b = 0; b < model.branch_count(); ++b) {
    for (int i = model.first[b]; i < model.first[b + 1]; ++i) {
      place_.push_back(static_cast<int>(alpha_.size()));
      in_branch_.push_back(i - model.first[b]);
      after_.push_back(model.first[b + 1] - 1 - i);
      const int edge = std::max(i, model.first[b] + 1);  // the first vertex has no edge before it: it takes the one after
      along_.push_back((model.point[edge] - model.point[edge - 1]).stableNormalized());
      alpha_.push_back(static_cast<float>(model.alpha[i]));
      radius_.push_back(static_cast<float>(model.radius[i]));
      alpha_sums_.push_back(alpha_sums_.back() + model.alpha[i] * model.alpha[i]);
      radius_sums_.push_back(radius_sums_.back() + model.radius[i] * model.radius[i]);
    }
    alpha_.insert(alpha_.end(), pad_, 0.0f);
    radius_.insert(radius_.end(), pad_, 0.0f);
  }
}

Vec2 WindowMatcher::displacement(int vertex, int count, bool from_start) const {
  const Vec2 way = model_.point[vertex + count] - model_.point[vertex];
  const Vec2& along = along_[vertex + (from_start && after_[vertex] > 0 ? 1 : 0)];
  return {along.dot(way), cross(along, way)};
}

namespace {

// out[i] += weight * in[i - lag]
void correlate(const std::vector<float>& in, float weight, int lag, std::vector<float>& out) {
  const float* source = in.data();
  float* sum = out.data() + lag;
  const std::size_t count = in.size() - static_cast<std::size_t>(lag);
  for (std::size_t i = 0; i < count; ++i) sum[i] += weight * source[i];
}

}  // namespace

void WindowMatcher::match(const GrowingBranch& branch, int ahead, bool raw, WindowQualities& out) const {
  const int n = branch.count(), tip = n - 1;
  const int history = std::min(model_.history + 1, n);
  // The turn at the tip is not known yet, and the first node has none.
  const int turns = std::max(0, std::min(model_.history, n - 2));
  std::vector<float> alpha_product(alpha_.size(), 0.0f), radius_product(radius_.size(), 0.0f);
  std::vector<double> alpha_squares{0.0}, radius_squares{0.0};
  for (int j = 1; j <= turns; ++j) {
    correlate(alpha_, static_cast<float>(branch.turns[tip - j]), j, alpha_product);
    alpha_squares.push_back(alpha_squares.back() + branch.turns[tip - j] * branch.turns[tip - j]);
  }
  for (int j = 0; j < history; ++j) {
    correlate(radius_, static_cast<float>(branch.radii[tip - j]), j, radius_product);
    radius_squares.push_back(radius_squares.back() + branch.radii[tip - j] * branch.radii[tip - j]);
  }
  const int vertices = model_.vertex_count();
  constexpr float kIllegal = -std::numeric_limits<float>::infinity();
  out.plain.assign(vertices, kIllegal);
  out.mirrored.assign(vertices, kIllegal);
  const int least = std::min(n, model_.extension);
  for (int v = 0; v < vertices; ++v) {
    const int shared = std::min(history, in_branch_[v] + 1);
    if (after_[v] < ahead || shared < least) continue;
    const int shared_turns = std::min(turns, in_branch_[v]);
    const double a = alpha_sums_[v] - alpha_sums_[v - shared_turns] + alpha_squares[shared_turns];
    const double cross_a = 2.0 * alpha_product[place_[v]];
    const double r = radius_sums_[v + 1] - radius_sums_[v + 1 - shared] + radius_squares[shared] -
                     2.0 * radius_product[place_[v]];
    double scale_a = 1.0, scale_r = 1.0;
    if (!raw) {
      scale_a = 1.0 / (std::sqrt(std::max(1.0, static_cast<double>(shared_turns))) * model_.angle_gain);
      scale_r = 1.0 / (std::sqrt(static_cast<double>(shared)) * model_.radius_gain);
    }
    const double radius = likeness(std::sqrt(std::max(0.0, r)) * scale_r);
    out.plain[v] = static_cast<float>(std::log(likeness(std::sqrt(std::max(0.0, a - cross_a)) * scale_a) * radius));
    out.mirrored[v] = static_cast<float>(std::log(likeness(std::sqrt(std::max(0.0, a + cross_a)) * scale_a) * radius));
  }
}

}  // namespace ramify
