// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/exemplar/branch_zone.h"

#include <algorithm>

#include "ramify/skeleton/draw.h"

namespace ramify {

Mask branch_zone(const Skeleton& skeleton, Size size, const std::function<double(double)>& reach) {
  constexpr double kLeast = 0.1;  // px; skeletons have no body without a radius
  Skeleton widened = skeleton;
  for (int i = 0; i < skeleton.count(); ++i) widened.set_radius(i, std::max(kLeast, reach(skeleton[i].radius)));
  const ScalarImage distance = draw_signed_distance(widened, size, 1.0);
  Mask mask(size, 0);
  for (std::size_t i = 0; i < mask.pixels().size(); ++i) mask.pixels()[i] = distance.pixels()[i] <= 0.0f ? 255 : 0;
  return mask;
}

}  // namespace ramify
