// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/growth/raster_density.h"

#include <algorithm>
#include <cmath>

namespace ramify {
namespace {

constexpr double kNoise = 0.05;  // changes of D below this are the raster's

// D of everything grown, sampled at pixel centres as the paper's map is.
double density_at(const GrowthState& state, const Vec2& point) {
  const Vec2 pixel(std::round(point.x()), std::round(point.y()));
  const double rho = state.spread();
  const double d = state.occupancy.index().nearest_rim(pixel, 3.0 * rho, [](const Capsule&) { return true; });
  return std::exp(-d * d / (rho * rho));
}

}  // namespace

double raster_maximum(const GrowthState& state, int number, const Vec2& from, const Vec2& along, double reach) {
  double lowest = 1.0, highest = 0.0;
  const double start = state.branches[number].radii.back();
  for (double s = start; s <= reach; s += 2.0) {
    const double d = density_at(state, from + along * s);
    lowest = std::min(lowest, d);
    if (d > lowest + kNoise) highest = std::max(highest, d);
  }
  return highest > 0.0 ? highest : lowest;
}

bool crosses_density(const GrowthState& state, int number, const Extension& extension) {
  Vec2 from = state.branches[number].points.back();
  double lowest = 1.0, highest = 0.0;
  bool risen = false;
  for (const Vec2& to : extension.points) {
    const int samples = std::max(1, static_cast<int>((to - from).norm()));
    for (int i = 1; i <= samples; ++i) {
      const Vec2 point = from + (to - from) * (static_cast<double>(i) / samples);
      if (state.ground.blocked(point)) return true;
      const double d = density_at(state, point);
      if (!risen) {
        lowest = std::min(lowest, d);
        risen = d > lowest + kNoise;
        highest = d;
      } else {
        highest = std::max(highest, d);
        if (d < highest - kNoise) return true;
      }
    }
    from = to;
  }
  return false;
}

}  // namespace ramify
