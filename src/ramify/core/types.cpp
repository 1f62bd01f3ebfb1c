// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/core/types.h"

#include <cmath>

namespace ramify {

double angle_of(const Vec2& v) {
  return v.x() == 0.0 && v.y() == 0.0 ? 0.0 : std::atan2(v.y(), v.x());
}

double wrap_angle(double angle) {
  const double turned = std::remainder(angle, 2.0 * kPi);
  return turned <= -kPi ? turned + 2.0 * kPi : turned;
}

}  // namespace ramify
