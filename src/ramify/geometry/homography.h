// SPDX-License-Identifier: GPL-3.0-or-later
// Plane projective maps: perspective of a photo of a flat wall or ground (ALGORITHMS 1.1 A6).
#pragma once

#include <Eigen/Core>
#include <array>

#include "ramify/core/types.h"

namespace ramify {

// Row-major 3x3 with h33 = 1, as annotation files store it.
using Homography = Eigen::Matrix3d;

// The map that takes corner i of `from` to corner i of `to`. Throws InputError when either quadrilateral is degenerate:
// crossed, not convex, three corners nearly in line, or without area.
Homography homography_from_corners(const std::array<Vec2, 4>& from, const std::array<Vec2, 4>& to);

// Why a quadrilateral cannot be rectified, or nullptr when it can.
const char* fault_of_corners(const std::array<Vec2, 4>& corners);

Vec2 apply(const Homography& map, const Vec2& p);           // p must not lie on the horizon
Homography inverse(const Homography& map);                  // h33 = 1; throws InputError when it has none
Eigen::Matrix2d jacobian(const Homography& map, const Vec2& p);
bool in_front(const Homography& map, const Vec2& p);        // on the same side of the horizon as where h33 = 1 is

Homography homography_from_row_major(const std::array<double, 9>& values);
std::array<double, 9> row_major(const Homography& map);

}  // namespace ramify
