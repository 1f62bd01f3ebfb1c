// SPDX-License-Identifier: GPL-3.0-or-later
// One skeleton's widths brought to another's: by quantiles, so that thin stays thin and thick stays thick whatever the
// units were (ALGORITHMS 11-1).
#pragma once

#include <vector>

#include "ramify/skeleton/skeleton.h"

namespace ramify {

// How radii are spread over the length of a skeleton. A node counts with half the length of the edges that meet in it;
// nodes of a skeleton without length count alike.
struct RadiusSpread {
  std::vector<double> radii;   // px, ascending, no two equal
  std::vector<double> shares;  // 0..1, ascending: the share of the length that is thinner, and half of what is as thin

  double radius_at(double share) const;  // linear between the entries, the first and the last beyond them
  double share_at(double radius) const;  // its inverse
};

// Throws std::invalid_argument for an empty skeleton. O(n log n).
RadiusSpread measure_radius_spread(const Skeleton& skeleton);

// The same for radii that count alike.
RadiusSpread measure_radius_spread(std::vector<double> radii);

// Every radius becomes wanted.radius_at(share_at(radius) of the skeleton's own spread): a map that never falls. All
// radii alike become the wanted median.
Skeleton map_radii(const Skeleton& skeleton, const RadiusSpread& wanted);

}  // namespace ramify
