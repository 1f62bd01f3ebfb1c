// SPDX-License-Identifier: GPL-3.0-or-later
// Are branches as wide in a picture as their skeleton says (PICTURES 10)? Their widths are measured again along the
// skeleton, as tracing measures them, and compared with its radii.
#pragma once

#include "ramify/image/image.h"
#include "ramify/skeleton/skeleton.h"

namespace ramify {

struct WidthRatio {
  double middle = 1.0;     // median of measured / stated radius
  double deviation = 0.0;  // median of |ratio / middle - 1|
  int samples = 0;         // px of branch that could be measured; 0 = the other two say nothing
};

// color: sRGB. glow: branches shine; else edges count, and whether branches are bright is seen from the picture. Branches
// below 1 px of radius, the first stretch inside a parent and what leaves the picture are left out.
WidthRatio measure_width_ratio(const ColorImage& color, const Skeleton& skeleton, bool glow);

}  // namespace ramify
