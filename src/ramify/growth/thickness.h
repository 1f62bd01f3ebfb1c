// SPDX-License-Identifier: GPL-3.0-or-later
// Grown branches as thick as the exemplar's: one monotone map of all radii.
#pragma once

#include <vector>

#include "ramify/growth/growth_state.h"

namespace ramify {

// Value of the sorted `wanted` (not empty) at the share of the sorted `present` (not empty) below `value`; between
// neighbours linear. Increasing in `value`: what is thicker stays thicker.
double at_same_share(const std::vector<double>& present, const std::vector<double>& wanted, double value);

// Maps the radii of what has grown onto the distribution of the exemplar's, by a factor of at most kMostChange. What grows
// thicker takes at most half of the room to its neighbours.
void match_thickness(GrowthState& state);

}  // namespace ramify
