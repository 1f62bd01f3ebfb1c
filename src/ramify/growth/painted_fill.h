// SPDX-License-Identifier: GPL-3.0-or-later
// Fills a painted map as it asks (PICTURES 9 and 12.2-11): a stem through every island of paint, then branch after branch
// to where most is lacking and farthest away, so that large branches come first and small ones fill between them.
#pragma once

#include "ramify/growth/growth_state.h"

namespace ramify {

// Adds to what has grown until nothing lacks that could be reached. most_order: the highest order that may grow.
void fill_painted(GrowthState& state, int most_order);

}  // namespace ramify
