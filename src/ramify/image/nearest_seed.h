// SPDX-License-Identifier: GPL-3.0-or-later
// The nearest of many points for every pixel: a Voronoi diagram on the grid.
#pragma once

#include <utility>
#include <vector>

#include "ramify/image/image.h"

namespace ramify {

// For every pixel the index of the seed (a pixel, inside the picture) whose centre is nearest, exactly; kNone where there
// are no seeds. Of seeds in one pixel the first counts; of seeds equally far any may, but always the same. O(pixels), in
// two passes of lower envelopes (Felzenszwalb and Huttenlocher 2012), parallel.
LabelImage nearest_seeds(const std::vector<std::pair<int, int>>& seeds, Size size);

}  // namespace ramify
