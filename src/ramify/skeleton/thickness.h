// SPDX-License-Identifier: GPL-3.0-or-later
// How thick a mask is: exact Euclidean distances (Felzenszwalb & Huttenlocher 2012).
#pragma once

#include "ramify/image/image.h"

namespace ramify {

// px from each foreground pixel's centre to the edge of the mask (half a pixel nearer than the nearest background
// centre), 0 in the background. The world outside the picture continues the mask: the frame is no edge. A mask without
// background gives width + height everywhere.
ScalarImage distance_inside(const Mask& mask);

}  // namespace ramify
