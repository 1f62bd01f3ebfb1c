// SPDX-License-Identifier: GPL-3.0-or-later
// How much room the exemplar's branches leave each other: growth that keeps it makes no parallel strands and no tangles.
#pragma once

#include "ramify/style/hierarchy.h"

namespace ramify {

// Fills clearance, opening and chord_spread; `branches` and `spacing` must be there. size: of the exemplar.
void measure_room(Hierarchy& hierarchy, const BendingModel& bending, Size size);

}  // namespace ramify
