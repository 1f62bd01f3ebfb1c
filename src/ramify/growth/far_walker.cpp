// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/growth/far_walker.h"

#include <algorithm>
#include <cmath>

namespace ramify {
namespace {

constexpr double kBack = 1.5;       // radii of the circle: beyond, a walker is brought back to it
constexpr double kShortest = 1.0;   // px, of a leap: without it walkers would creep

Vec2 on_circle(double radius, double angle) { return radius * Vec2(std::cos(angle), std::sin(angle)); }

}  // namespace

// The kernel's distribution function turned round: tan of half the angle is Cauchy's, (rho - 1) / (rho + 1) wide.
Vec2 return_to_circle(const Vec2& place, double radius, Rng& rng) {
  const double distance = place.norm();
  const double half = (distance - radius) / (distance + radius) * std::tan(kPi * (rng.uniform() - 0.5));
  return on_circle(radius, std::atan2(place.y(), place.x()) + 2.0 * std::atan(half));
}

std::optional<Vec2> walk_from_far(const FarWalk& walk, const std::function<double(const Vec2&)>& free_way, Rng& rng) {
  Vec2 place = on_circle(walk.radius, rng.uniform(0.0, 2.0 * kPi));
  for (int leap = 0; leap < walk.most_leaps; ++leap) {
    if (place.norm() > kBack * walk.radius) {
      place = return_to_circle(place, walk.radius, rng);
      continue;
    }
    const double way = free_way(walk.middle + place);
    if (way <= walk.near) return walk.middle + place;
    place += on_circle(std::max(kShortest, way - walk.near), rng.uniform(0.0, 2.0 * kPi));
  }
  return std::nullopt;
}

}  // namespace ramify
