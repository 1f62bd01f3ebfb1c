// SPDX-License-Identifier: GPL-3.0-or-later
// For every pixel: how far it is from the branches, and which one is nearest.
#pragma once

#include <vector>

#include "ramify/image/image.h"
#include "ramify/skeleton/curve.h"

namespace ramify {

struct BranchField {
  ScalarImage signed_distance;  // px to the edge of the branches, negative inside; infinity when there is no branch
  ScalarImage surface_radius;   // px, of the branch whose edge is nearest; 0 beyond 4 px from every edge
  ScalarImage centre_distance;  // px to the nearest centre line
  ScalarImage radius;           // px, of the branch at that point of the centre line; 0 when there is none
  LabelImage curve;             // index of that curve; kNone when there is none
  LabelImage vertex;            // its vertex
};

// Near an edge (within 4 px) and inside, the signed distance is that to the discs along the curves, to sub-pixel
// accuracy; farther away that to the nearest pixel inside.
BranchField measure_branch_field(const std::vector<BranchCurve>& curves, Size size);

}  // namespace ramify
