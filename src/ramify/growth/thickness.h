// SPDX-License-Identifier: GPL-3.0-or-later
// Grown branches as thick as the exemplar's: one monotone map of all radii.
#pragma once

#include "ramify/growth/growth_state.h"

namespace ramify {

// Maps the radii of what has grown onto the distribution of the exemplar's, by a factor of at most kMostChange. What grows
// thicker takes at most half of the room to its neighbours.
void match_thickness(GrowthState& state);

}  // namespace ramify
