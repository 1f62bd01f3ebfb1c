// SPDX-License-Identifier: GPL-3.0-or-later
// One Markov step of a branch: candidates from the exemplar, scored and tested, one of the best drawn (paper 002, sections
// 4.2, 4.4, 4.5; PICTURES 12.2).
#pragma once

#include "ramify/growth/growth_state.h"

namespace ramify {

// Grows branch `number` from its tip to its intended length, or until it leaves the canvas, joins another branch or finds
// no way on; a stuck branch has been stepped back up to three times.
void grow_branch(GrowthState& state, int number, Rng& rng);

// In a net: goes on from a free end until it meets another branch or leaves; false, and nothing has changed, where none
// comes within two meshes. `number` need not be the branch grown last.
bool run_on(GrowthState& state, int number, Rng& rng);

// Fades the tip of a branch that ends inside the picture as the exemplar's tips do.
void taper_tip(GrowthState& state, int number);

// A branch whose template leaves the frame is meant to reach it: its length becomes the way out along its heading where
// that is between half and 2.5 times what it was.
void aim_at_frame(const GrowthState& state, GrowingBranch& branch);

}  // namespace ramify
