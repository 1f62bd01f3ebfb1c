// SPDX-License-Identifier: GPL-3.0-or-later
// Rivers and other branches too wide for a ridge: their two banks are traced by intelligent scissors (Mortensen and
// Barrett 1995), and the branch runs along the middle between them (ALGORITHMS 3.1-5).
#pragma once

#include <optional>
#include <vector>

#include "ramify/core/monitor.h"
#include "ramify/graph/least_cost_path.h"
#include "ramify/image/image.h"

namespace ramify {

// A stroke between two banks.
struct Ribbon {
  std::vector<Pixel>
      middle;          // from the stroke's first point to its last, 8-connected, as far from one bank as from the other
  Mask inside;         // 255 between the banks
  ScalarImage radius;  // px to the nearer bank, 0 outside
};

// points: px, two at least, inside the branch, as straight lines between them are. bright: the branch is brighter than
// its surround in `picture`. No value where the branch is narrower than `width` px in the median of the points or has
// no two clear banks there. O(pixels within reach of the stroke).
std::optional<Ribbon> trace_banks(const ScalarImage& picture, bool bright, const std::vector<Vec2>& points,
                                  double width, const Monitor& monitor = {});

}  // namespace ramify
