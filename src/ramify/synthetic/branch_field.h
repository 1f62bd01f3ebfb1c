// SPDX-License-Identifier: GPL-3.0-or-later
// Where every pixel lies with respect to the branches: what the cross profiles are painted from.
#pragma once

#include <limits>
#include <vector>

#include "ramify/exemplar/annotation.h"
#include "ramify/image/image.h"

namespace ramify {

struct BranchSample {
  float distance = std::numeric_limits<float>::infinity();  // px to the rim, negative inside; infinity beyond reach
  float radius = 0.0f;                                      // px, of the branch there
  float along = 0.0f;                                       // px from the branch's first point
  float across = 0.0f;                                      // px from the centre line, positive to its right
  float direction_x = 0.0f, direction_y = 0.0f;             // unit heading, base to tip
  int branch = kNone;

  // Unit vector away from the centre line.
  float outward_x() const { return across >= 0.0f ? -direction_y : direction_y; }
  float outward_y() const { return across >= 0.0f ? direction_x : -direction_x; }
};

// For every pixel the branch whose rim is nearest, within `reach` px of it. A branch is the union of discs along its
// polyline (a child's begins at its parent's point), radii linear between points.
Image<BranchSample> branch_field(Size size, const std::vector<AnnotatedBranch>& branches, double reach);

// 255 where the field says inside.
Mask inside_mask(const Image<BranchSample>& field);

}  // namespace ramify
