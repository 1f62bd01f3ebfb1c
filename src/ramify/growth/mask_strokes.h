// SPDX-License-Identifier: GPL-3.0-or-later
// Strokes painted white on black as lines along their middles.
#pragma once

#include <vector>

#include "ramify/image/image.h"

namespace ramify {

// Farthest first: of every white region the two ends farthest apart, then whatever is farther from all lines than the brush
// is wide, as lines in px that end on an earlier one. White is what is at least 0.5. A ring is one line that ends just
// before its start: it is opened where it is narrowest; a black speck smaller than the stroke is wide opens nothing.
// O(strokes * pixels).
std::vector<std::vector<Vec2>> mask_strokes(const ScalarImage& map);

}  // namespace ramify
