// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/geometry/registration.h"

#include <algorithm>
#include <stdexcept>

namespace ramify {

Alignment align_rotation(std::span<const Vec2> from, std::span<const Vec2> to) {
  if (from.size() != to.size()) throw std::invalid_argument("align_rotation: different numbers of points");
  double sine = 0.0, cosine = 0.0, energy = 0.0;
  for (std::size_t l = 0; l < from.size(); ++l) {
    sine += cross(from[l], to[l]);
    cosine += from[l].dot(to[l]);
    energy += from[l].squaredNorm() + to[l].squaredNorm();
  }
  // sum |Rp - q|^2 = sum |p|^2 + |q|^2 - 2 (cosine cos t + sine sin t), least at t = atan2(sine, cosine).
  return {angle_of({cosine, sine}), std::max(0.0, energy - 2.0 * std::hypot(sine, cosine))};
}

}  // namespace ramify
