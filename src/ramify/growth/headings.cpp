// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/growth/headings.h"

#include <algorithm>
#include <cmath>

namespace ramify {
namespace {

constexpr int kDirections = 48;
constexpr double kFreePower = 1.5;
constexpr double kFloor = 0.004;         // of a bin: what was never seen is not quite impossible
constexpr double kLeastStrength = 0.15;  // below it an order has no direction of its own (PICTURES 1)

}  // namespace

double free_way(const GrowthState& state, const Vec2& from, double direction, double skip, double reach) {
  constexpr int kSamples = 6;
  double sum = 0.0;
  for (int j = 1; j <= kSamples; ++j) {
    sum += state.unfilled(from + direction_of(direction) * (skip + reach * j / kSamples));
  }
  return sum / kSamples;
}

double draw_heading(const GrowthState& state, const Vec2& from, double start, int order, double reach, const Vec2& root,
                    Rng& rng) {
  const int o = std::min(order, kHeadingOrders - 1);
  const Headings& absolute = state.style.hierarchy.headings[o];
  const Headings& ray = state.style.hierarchy.ray_headings[o];
  // The more the exemplar's branches agree, the more counts where they go (PICTURES 1).
  double absolute_power = absolute.strength < kLeastStrength ? 0.5 : std::max(1.0, 2.0 * absolute.strength);
  if (state.options.tropism >= 0.0) absolute_power = state.options.tropism;
  const Vec2 outward = from - root;
  const double ray_power = ray.strength < kLeastStrength || outward.norm() < 4.0 * state.style.step ? 0.0 : ray.strength;
  const double skip = state.spacing, spread = state.style.hierarchy.chord_spread[o];
  std::vector<double> weights;
  for (int i = 0; i < kDirections; ++i) {
    const double direction = -kPi + 2.0 * kPi * i / kDirections;
    const double turn = wrap_angle(direction - start) / spread;
    double weight = std::exp(-0.5 * turn * turn);
    weight *= std::pow(share_at(absolute, direction) + kFloor, absolute_power);
    if (ray_power > 0.0) {
      weight *= std::pow(share_at(ray, direction - angle_of(outward)) + kFloor, ray_power);
    }
    weights.push_back(weight * std::pow(0.05 + free_way(state, from, direction, skip, reach), kFreePower));
  }
  const int drawn = rng.discrete(weights);
  return wrap_angle(-kPi + 2.0 * kPi * (drawn + rng.uniform() - 0.5) / kDirections);
}

}  // namespace ramify
