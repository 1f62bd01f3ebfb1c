// SPDX-License-Identifier: GPL-3.0-or-later
// Fills what is wanted and still empty: a branch is sent to far unfilled places until the canvas or the painted white is
// full (PICTURES 9 and 12.2-11).
#pragma once

#include "ramify/growth/growth_state.h"

namespace ramify {

// Grows children towards unfilled cells, and new roots in painted islands nothing can see. `most_order`: the highest
// order that may grow.
void fill_wanted(GrowthState& state, int most_order);

}  // namespace ramify
