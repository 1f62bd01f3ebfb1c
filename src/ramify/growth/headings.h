// SPDX-License-Identifier: GPL-3.0-or-later
// Which way a new branch is meant to go (PICTURES 1 and 12.2-5): one heading is drawn per branch; scoring every step by
// the histogram instead would seek its mode.
#pragma once

#include "ramify/growth/growth_state.h"

namespace ramify {

// Drawn from p(heading | order), a bell around `start` (rad), and the free space that way within `reach` px of `from`.
// root: where the branch's tree begins, px.
double draw_heading(const GrowthState& state, const Vec2& from, double start, int order, double reach, const Vec2& root,
                    Rng& rng);

// Mean unfilled weight along the ray, 0..1; what lies within `skip` px of `from` does not count.
double free_way(const GrowthState& state, const Vec2& from, double direction, double skip, double reach);

}  // namespace ramify
