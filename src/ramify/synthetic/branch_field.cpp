// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/synthetic/branch_field.h"

#include <algorithm>
#include <cmath>

#include "ramify/core/parallel.h"
#include "ramify/skeleton/draw.h"

namespace ramify {

Image<BranchSample> branch_field(const Skeleton& skeleton, double reach) {
  const Image<NearestBranch> nearest = draw_nearest_branch(skeleton, skeleton.size, reach);
  const auto rim = [](const NearestBranch& at) { return at.distance - at.radius; };
  Image<BranchSample> field(skeleton.size);
  parallel_for(field.height(), [&](int y) {
    for (int x = 0; x < field.width(); ++x) {
      const NearestBranch& at = nearest(x, y);
      if (at.branch == kNone || rim(at) > reach) continue;
      // The side is where the distance to the centre line grows towards; one-sided where a neighbour is another branch's.
      const auto rise = [&](int dx, int dy) {
        const NearestBranch &ahead = nearest.clamped(x + dx, y + dy), &behind = nearest.clamped(x - dx, y - dy);
        const float up = ahead.branch == at.branch ? ahead.distance : at.distance;
        const float down = behind.branch == at.branch ? behind.distance : at.distance;
        return up - down;
      };
      const float side = at.tangent.x() * rise(0, 1) - at.tangent.y() * rise(1, 0);
      field(x, y) = {rim(at), at.radius, at.arc, side >= 0.0f ? at.distance : -at.distance,
                     at.tangent.x(), at.tangent.y(), at.branch};
    }
  }, 8);
  return field;
}

}  // namespace ramify
