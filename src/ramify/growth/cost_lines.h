// SPDX-License-Identifier: GPL-3.0-or-later
// Lines that a plan's costs draw in the plane: equal distance from a dendrite (Xu & Mould 2007, section 3.3, figures 2 and
// 9), and the borders of what is nearest to each of several generators ("rocks", section 3.4).
#pragma once

#include <vector>

#include "ramify/core/monitor.h"
#include "ramify/core/options.h"
#include "ramify/growth/dendrite.h"
#include "ramify/skeleton/skeleton.h"

namespace ramify {

struct CostLineOptions {
  int count = 10;        // lines of equal distance, evenly spread up to `reach`
  double reach = 0.0;    // nodes; 0 = to the farthest node
  double radius = 0.6;   // px, half the width of a line
};
std::vector<OptionField> describe(CostLineOptions& options);

// Every line is a branch of its own; a closed one ends where it starts. `pitch` as in dendrite_skeleton. Around nodes that
// may not be entered lines close. Order 0; tag: the line's level, 1 = nearest.
Skeleton distance_lines(const Dendrite& dendrite, double pitch, const CostLineOptions& options, const Monitor& monitor);

// The outline of every generator's cell, smooth although labels are whole numbers: the zero line of the difference between
// the costs of the two nearest generators (two_nearest). Outlines of neighbours coincide; at the canvas's edge they close
// along it. Generators that touch are one. tag: the generator, 1 = the first in reading order. Throws InputError for less than two.
Skeleton cell_outlines(const Lattice& lattice, const std::vector<int>& generators, double pitch, double radius, const Monitor& monitor);

}  // namespace ramify
