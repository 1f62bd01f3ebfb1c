// SPDX-License-Identifier: GPL-3.0-or-later
// Region polygons drawn as a map: which role every pixel of the photo has.
#pragma once

#include <vector>

#include "ramify/exemplar/annotation.h"
#include "ramify/image/image.h"

namespace ramify {

// 255 where the pixel's centre lies inside the polygon (even-odd rule).
Mask polygon_mask(const std::vector<Vec2>& polygon, Size size);

// RegionRole of every pixel; later regions win, Habitat where there is none. Pixels with alpha 0 are Outside.
Image<std::uint8_t> region_map(const std::vector<Region>& regions, Size size, const Mask& alpha = {});

}  // namespace ramify
