// SPDX-License-Identifier: GPL-3.0-or-later
// Branches that end on others, as the exemplar's T-ends do (PICTURES 12.2-7).
#pragma once

#include "ramify/growth/occupancy.h"

namespace ramify {

// Ends the extension of branch `number` inside the rim of `target`, short of its axis, by one edge from the point before
// `at`. False, and nothing changed, at a grazing angle, where that edge would turn back, or where it would meet anything
// else, its own branch included.
bool end_on(const Capsule& target, int at, const Occupancy& occupancy, const Ground& ground,
            const std::vector<GrowingBranch>& branches, int number, Extension& extension);

}  // namespace ramify
