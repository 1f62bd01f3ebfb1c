// SPDX-License-Identifier: GPL-3.0-or-later
// Where every pixel lies with respect to the branches: what the cross profiles are painted from.
#pragma once

#include <limits>

#include "ramify/image/image.h"
#include "ramify/skeleton/skeleton.h"

namespace ramify {

struct BranchSample {
  float distance = std::numeric_limits<float>::infinity();  // px to the rim, negative inside; infinity beyond reach
  float radius = 0.0f;                                      // px, of the branch there
  float along = 0.0f;                                       // px from where the branch starts
  float across = 0.0f;                                      // px from the centre line, positive to its right
  float direction_x = 0.0f, direction_y = 0.0f;             // unit heading, base to tip
  int branch = kNone;

  // Unit vector away from the centre line.
  float outward_x() const { return across >= 0.0f ? -direction_y : direction_y; }
  float outward_y() const { return across >= 0.0f ? direction_x : -direction_x; }
};

// For every pixel the branch whose rim is nearest, within about `reach` px of it (skeleton/draw.h).
Image<BranchSample> branch_field(const Skeleton& skeleton, double reach);

}  // namespace ramify
