// SPDX-License-Identifier: GPL-3.0-or-later
// Walkers that come from far away, without their steps in between. The plane without the disc of a circle is walked back to
// that circle in one draw (the Poisson kernel), and free discs are crossed in one leap to their rim (walk on spheres,
// Muller 1956). Where such a walker first comes near a structure is where diffusion-limited aggregation grows: at the tips;
// fjords are screened.
#pragma once

#include <functional>
#include <optional>

#include "ramify/core/random.h"
#include "ramify/core/types.h"

namespace ramify {

// Where Brownian motion from `place`, outside a circle around the origin, first meets it. With rho the distance of the place
// in radii, the mean of exp(i k (angle - angle of the place)) is rho^-k.
Vec2 return_to_circle(const Vec2& place, double radius, Rng& rng);

struct FarWalk {
  Vec2 middle = Vec2::Zero();  // of a circle with all of the structure inside
  double radius = 1.0;
  double near = 1.0;           // px: what is as near as this is met
  int most_leaps = 20000;
};
// The place where a walker from the circle first comes as near to the structure as wanted; none after too many leaps.
// free_way: at most the distance (px) to the structure at a place.
std::optional<Vec2> walk_from_far(const FarWalk& walk, const std::function<double(const Vec2&)>& free_way, Rng& rng);

}  // namespace ramify
