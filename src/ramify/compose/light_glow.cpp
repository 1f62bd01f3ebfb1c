// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/compose/light_glow.h"

#include <Eigen/Dense>
#include <algorithm>

#include "ramify/core/parallel.h"
#include "ramify/image/filter.h"

namespace ramify {
namespace {

constexpr int kFitStep = 4;  // px between the samples of the fit
constexpr int kTerms = static_cast<int>(kGlowSigmas.size());

std::array<ColorImage, kTerms> blurs(const ColorImage& core) {
  std::array<ColorImage, kTerms> out;
  parallel_for(kTerms, [&](int k) { out[k] = gaussian_blur(core, kGlowSigmas[k]); });
  return out;
}

// Minimises |A w - y|^2 over w >= 0 from the normal equations: with a handful of unknowns every set of active weights
// can be tried, so no iteration and no starting point are needed.
Eigen::VectorXd non_negative_solution(const Eigen::MatrixXd& normal, const Eigen::VectorXd& right) {
  const auto n = static_cast<int>(right.size());
  Eigen::VectorXd best = Eigen::VectorXd::Zero(n);
  double best_cost = 0.0;
  for (int set = 1; set < 1 << n; ++set) {
    Eigen::MatrixXd a = Eigen::MatrixXd::Identity(n, n);
    Eigen::VectorXd b = Eigen::VectorXd::Zero(n);
    for (int i = 0; i < n; ++i) {
      if (!(set >> i & 1)) continue;
      b[i] = right[i];
      for (int j = 0; j < n; ++j)
        if (set >> j & 1) a(i, j) = normal(i, j);
    }
    const Eigen::VectorXd w = a.fullPivLu().solve(b);
    if ((w.array() < 0.0).any() || !w.allFinite()) continue;
    const double cost = w.dot(normal * w) - 2.0 * w.dot(right);
    if (cost < best_cost) best_cost = cost, best = w;
  }
  return best;
}

}  // namespace

GlowModel fit_glow(const ColorImage& core, const ColorImage& light, const ScalarImage& weight) {
  const auto basis = blurs(core);
  GlowModel model;
  for (int c = 0; c < 3; ++c) {
    Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
    Eigen::Vector3d right = Eigen::Vector3d::Zero();
    for (int y = 0; y < core.height(); y += kFitStep) {
      for (int x = 0; x < core.width(); x += kFitStep) {
        const Eigen::Vector3d g(basis[0](x, y)[c], basis[1](x, y)[c], basis[2](x, y)[c]);
        normal += weight(x, y) * g * g.transpose();
        right += weight(x, y) * std::max(0.0f, light(x, y)[c]) * g;
      }
    }
    const Eigen::VectorXd w = non_negative_solution(normal, right);
    for (int k = 0; k < kTerms; ++k) model.weights[c][k] = w[k];
  }
  return model;
}

ColorImage render_glow(const GlowModel& model, const ColorImage& core) {
  const auto basis = blurs(core);
  ColorImage glow(core.size());
  parallel_for(
      core.height(),
      [&](int y) {
        for (int x = 0; x < core.width(); ++x) {
          for (int c = 0; c < 3; ++c) {
            double v = 0.0;
            for (int k = 0; k < kTerms; ++k) v += model.weights[c][k] * basis[k](x, y)[c];
            glow(x, y)[c] = static_cast<float>(v);
          }
        }
      },
      32);
  return glow;
}

std::vector<double> fit_gains(const std::vector<ColorImage>& glows, const ColorImage& light,
                              const ScalarImage& weight) {
  constexpr double kUntold = 0.02;  // share of the mean information that pulls every factor to 1
  const auto n = static_cast<Eigen::Index>(glows.size());
  Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(n, n);
  Eigen::VectorXd right = Eigen::VectorXd::Zero(n), g(n);
  for (int y = 0; y < light.height(); y += kFitStep) {
    for (int x = 0; x < light.width(); x += kFitStep) {
      if (weight(x, y) <= 0.0f) continue;
      for (int c = 0; c < 3; ++c) {
        for (Eigen::Index k = 0; k < n; ++k) g[k] = glows[static_cast<std::size_t>(k)](x, y)[c];
        normal += weight(x, y) * g * g.transpose();
        right += weight(x, y) * std::max(0.0f, light(x, y)[c]) * g;
      }
    }
  }
  const double pull = kUntold * normal.trace() / static_cast<double>(n) + 1e-12;
  normal += pull * Eigen::MatrixXd::Identity(n, n);
  right += pull * Eigen::VectorXd::Ones(n);
  const Eigen::VectorXd w = non_negative_solution(normal, right);
  return {w.data(), w.data() + n};
}

}  // namespace ramify
