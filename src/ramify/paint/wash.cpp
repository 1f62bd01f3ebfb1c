// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/paint/wash.h"

#include <algorithm>
#include <cmath>

#include "ramify/core/parallel.h"
#include "ramify/core/random.h"
#include "ramify/image/filter.h"
#include "ramify/image/sample.h"

namespace ramify {
namespace {

constexpr double kTooth = 2.6;      // px of the canvas between the paper's hollows
constexpr double kDrift = 70.0;     // px, from where pigment gathered to where water thinned it
constexpr double kRagged = 1.1;     // px by which the paper's tooth bends a rim
constexpr float kBody = 0.36f, kRim = 0.7f;          // pigment inside a wash and along its rim
constexpr float kGranulation = 0.6f, kFlow = 0.95f;   // how far tooth and drift change it
constexpr float kDarkest = 0.03f;   // of a pigment's colour: ink is not darker

// Smooth noise in the plane, 0..1: values at whole places, joined by cubics.
float noise_at(std::uint64_t seed, double x, double y) {
  const double fx = std::floor(x), fy = std::floor(y);
  const auto value = [&](int i, int j) {
    return hash01(seed, static_cast<std::uint64_t>(static_cast<std::int64_t>(fx) + i + (std::int64_t{1} << 40)),
                  static_cast<std::uint64_t>(static_cast<std::int64_t>(fy) + j + (std::int64_t{1} << 40)));
  };
  const auto ease = [](double t) { return t * t * (3.0 - 2.0 * t); };
  const double u = ease(x - fx), v = ease(y - fy);
  return static_cast<float>((1.0 - v) * ((1.0 - u) * value(0, 0) + u * value(1, 0)) + v * ((1.0 - u) * value(0, 1) + u * value(1, 1)));
}

// Octaves of it, around 0, within -1..1.
float layered_noise(std::uint64_t seed, const Vec2& p, double period, int octaves) {
  float sum = 0.0f, most = 0.0f, weight = 1.0f;
  for (int k = 0; k < octaves; ++k, period *= 0.5, weight *= 0.6f) {
    const double turn = 0.5 + 0.9 * k;  // no octave shows the grid of another, or the canvas's
    const Vec2 q = Vec2(std::cos(turn) * p.x() - std::sin(turn) * p.y(), std::sin(turn) * p.x() + std::cos(turn) * p.y()) / period;
    sum += weight * (2.0f * noise_at(seed + static_cast<std::uint64_t>(k), q.x(), q.y()) - 1.0f);
    most += weight;
  }
  return sum / most;
}

}  // namespace

ColorImage optical_density(const WetLayer& layer, const PaperView& view, const Monitor& monitor) {
  const Size size = layer.alpha.size();
  const ScalarImage wet = gaussian_blur(layer.alpha, layer.bleeding * view.scale);
  monitor.check();
  // Pigment that ran together while it was wet: colours of touching strokes pass into each other.
  const double run = 2.5 * layer.bleeding * view.scale;
  const ColorImage pigment = gaussian_blur(layer.color, run);
  const ScalarImage carried = gaussian_blur(layer.alpha, run);
  ColorImage density(size);
  parallel_for(size.height, [&](int y) {
    if (y % 16 == 0) monitor.check();
    for (int x = 0; x < size.width; ++x) {
      if (wet(x, y) <= 1e-4f) continue;
      const Vec2 at = (Vec2(x + 0.5, y + 0.5) - view.shift) / view.scale;
      const Vec2 bend(layered_noise(11, at, 3.0 * kTooth, 2), layered_noise(23, at, 3.0 * kTooth, 2));
      const Vec2 from = Vec2(x, y) + kRagged * view.scale * bend;
      const float body = sample_bilinear(layer.alpha, from);
      if (body <= 0.0f) continue;
      const float rim = std::clamp(2.0f * (1.0f - sample_bilinear(wet, from)), 0.0f, 1.0f);
      const float tooth = 1.0f + kGranulation * layered_noise(37, at, kTooth, 2);
      const float drift = 1.0f + kFlow * layered_noise(41, at, kDrift, 3);
      const float amount = body * (kBody + kRim * rim) * std::max(0.0f, tooth) * std::max(0.15f, drift);
      const float share = std::max(1e-3f, carried(x, y));
      for (int k = 0; k < 3; ++k) {
        density(x, y)[k] = -amount * std::log(std::clamp(pigment(x, y)[k] / share, kDarkest, 1.0f));
      }
    }
  }, 16);
  return density;
}

}  // namespace ramify
