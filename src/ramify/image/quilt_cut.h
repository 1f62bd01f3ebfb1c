// SPDX-License-Identifier: GPL-3.0-or-later
// Private to the quilt: one expansion move (Boykov, Veksler and Zabih 2001) of one patch inside its box.
#pragma once

#include "ramify/image/quilt.h"

namespace ramify {

// Costs are per pixel; a seam between equal pictures costs kSeamFloor an edge.
inline constexpr float kForbiddenPixel = 60.0f;  // showing a forbidden photo pixel
inline constexpr float kSeamFloor = 0.02f;

// Gives the patch `index` every pixel of its box that lowers the total cost. Pixels without a label are taken whenever
// the photo has something to show there. Reads one pixel around the box, writes the box only.
void expand_patch(const QuiltJob& job, Quilt& quilt, int index);

}  // namespace ramify
