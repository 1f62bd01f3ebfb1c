// SPDX-License-Identifier: GPL-3.0-or-later
// The density as paper 002 samples it: along a straight ray, and down-up-down along an extension as the sign of an
// intersection. Kept to compare with; it misses glancing contacts (ALGORITHMS 4.5).
#pragma once

#include "ramify/growth/growth_state.h"

namespace ramify {

// Largest D within `reach` px from `from` along the unit vector `along`, after D has first fallen from the branch's own.
double raster_maximum(const GrowthState& state, int number, const Vec2& from, const Vec2& along, double reach);

// Whether D along the extension falls, rises and falls again, or the extension enters what is blocked.
bool crosses_density(const GrowthState& state, int number, const Extension& extension);

}  // namespace ramify
