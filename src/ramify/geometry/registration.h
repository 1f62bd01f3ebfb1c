// SPDX-License-Identifier: GPL-3.0-or-later
// The motion that lays one point set on another, in closed form: one step of a 2D ICP (Trucco and Lopez 1994), as paper
// 002 section 5.2 aligns fragments. Both sets are given relative to their fragments' centres, and centre goes on centre.
#pragma once

#include <span>

#include "ramify/core/types.h"

namespace ramify {

// v turned by `angle` (rad, positive from +x towards +y).
inline Vec2 rotated(const Vec2& v, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  return {c * v.x() - s * v.y(), s * v.x() + c * v.y()};
}

struct Alignment {
  double angle = 0.0;     // rad in (-pi, pi]; turns `from` onto `to`
  double residual = 0.0;  // sum of squared distances that is left, px^2
};

// Minimises sum |R from_l - to_l|^2 over rotations about the origin. Both spans have the same length; all points at the
// origin give angle 0.
Alignment align_rotation(std::span<const Vec2> from, std::span<const Vec2> to);

}  // namespace ramify
