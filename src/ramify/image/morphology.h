// SPDX-License-Identifier: GPL-3.0-or-later
// Grey morphology with squares, and what it finds: things narrower than the square.
#pragma once

#include "ramify/image/image.h"

namespace ramify {

// Lowest and highest value in the square of side 2 radius + 1 around every pixel, cut at the frame. O(1) per pixel and
// radius (van Herk 1992).
ScalarImage lowest_around(const ScalarImage& image, int radius);
ScalarImage highest_around(const ScalarImage& image, int radius);

// What sticks out of its surroundings and is narrower than 2 radius + 1 px: the picture minus its opening (bright), or
// its closing minus the picture. Never negative.
ScalarImage top_hat(const ScalarImage& image, int radius, bool bright);

}  // namespace ramify
