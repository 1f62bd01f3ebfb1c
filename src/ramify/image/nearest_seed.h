// SPDX-License-Identifier: GPL-3.0-or-later
// The nearest of many points for every pixel: a Voronoi diagram on the grid.
#pragma once

#include <utility>
#include <vector>

#include "ramify/image/image.h"

namespace ramify {

// For every pixel the index of the seed (a pixel, inside the picture) whose centre is nearest, exactly; of seeds
// equally far the first. kNone where there are no seeds. Boxes are halved with the lists of the seeds that may be
// nearest in them, and the pixels of small boxes compared with what is left: O(pixels) where seeds are spread over the
// picture. Parallel.
LabelImage nearest_seeds(const std::vector<std::pair<int, int>>& seeds, Size size);

}  // namespace ramify
