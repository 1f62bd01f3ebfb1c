// SPDX-License-Identifier: GPL-3.0-or-later
// The displacement field of paper 002 (section 5.3), for comparison with the thin plate.
#pragma once

#include <span>

#include "ramify/geometry/thin_plate.h"

namespace ramify {

// Displacements on the points of `grid` (its values are ignored) that take the given values at the given places (px) and
// minimise the sum of squared five-point Laplacians, truncated at the rim as the printed energy has it.
std::vector<Vec2> laplacian_displacements(const WarpGrid& grid, std::span<const Vec2> places,
                                          std::span<const Vec2> displacements);

}  // namespace ramify
