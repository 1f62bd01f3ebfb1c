// SPDX-License-Identifier: GPL-3.0-or-later
// The bends of an exemplar on a skeleton that comes from elsewhere: letters, drawings, planned paths (ALGORITHMS 4.6,
// 11-1).
#pragma once

#include "ramify/core/monitor.h"
#include "ramify/core/random.h"
#include "ramify/skeleton/skeleton.h"
#include "ramify/style/style.h"

namespace ramify {

// strength: 0 (the skeleton as it is) to 1 (the exemplar's bends wholly); every point moves along a straight line
// between. Roots and tips stay where they are, ends of loop links too; furcations move with the branch they lie on.
// Where branches are near each other they move less, and nothing crosses that did not cross before. Radii stay; the
// result has more nodes. Lengths are px of the exemplar. Throws std::invalid_argument for a strength outside 0..1.
Skeleton restyle_skeleton(const Skeleton& skeleton, const Style& style, double strength, const Rng& rng,
                          const Monitor& monitor);

}  // namespace ramify
