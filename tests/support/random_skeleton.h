// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "ramify/core/random.h"
#include "ramify/skeleton/skeleton.h"

namespace ramify {

// A forest of wandering branches on a canvas: `branches` branches of 2 to `longest` steps of `step` px each.
inline Skeleton random_skeleton(Rng rng, Size canvas, int branches, int longest = 40, double step = 3.0) {
  Skeleton skeleton(canvas);
  for (int b = 0; b < branches; ++b) {
    const bool root = b == 0 || rng.uniform() < 0.1;
    int parent = root ? kNone : rng.below(skeleton.count());
    Vec2 p(rng.uniform(0, canvas.width), rng.uniform(0, canvas.height));
    double radius = rng.uniform(1.0, 6.0);
    if (!root) {
      p = skeleton[parent].xy();
      radius = 0.3 + 0.7 * skeleton[parent].radius * rng.uniform();
    }
    double heading = rng.uniform(-kPi, kPi);
    const int order = root ? 0 : skeleton[parent].order + 1;
    for (int k = 2 + rng.below(longest - 1); k > 0; --k) {
      heading += 0.3 * rng.normal();
      if (parent != kNone) p += step * direction_of(heading);
      radius = 0.3 + 0.97 * (radius - 0.3);
      parent = skeleton.append({Vec3(p.x(), p.y(), 0), radius, parent, order, rng.below(1000)});
    }
  }
  return skeleton;
}

}  // namespace ramify
