// SPDX-License-Identifier: GPL-3.0-or-later
// The conventions every layer shares, stated once.
//
// Pixels: x to the right, y down, the centre of pixel (0,0) is at (0,0). A picture of W x H pixels covers
// [-0.5, W-0.5) x [-0.5, H-0.5).
// Angles: radians in (-pi, pi]; positive from +x towards +y (clockwise on the screen). Degrees appear only at the
// program's edges, with _deg in the name.
// Radius: half the width of a branch, in the unit of its positions (px in 2D).
// Transforms are named b_from_a, so that products read by cancelling letters.
// 3D: right-handed, z up; 2D structures have z = 0.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace ramify {

using Vec2 = Eigen::Vector2d;
using Vec3 = Eigen::Vector3d;

// The index that names nothing: no parent, no branch, no owner.
inline constexpr int kNone = -1;

inline constexpr double kPi = 3.14159265358979323846;

struct Size {
  int width = 0;   // px
  int height = 0;  // px
  friend bool operator==(const Size&, const Size&) = default;
};

// z component of the cross product: positive when b lies clockwise (on the screen) of a.
inline double cross(const Vec2& a, const Vec2& b) { return a.x() * b.y() - a.y() * b.x(); }

// Angle of v from +x, in (-pi, pi]; 0 for the zero vector.
double angle_of(const Vec2& v);

// The same angle in (-pi, pi].
double wrap_angle(double angle);

inline Vec2 direction_of(double angle) { return {std::cos(angle), std::sin(angle)}; }

// v turned by +90 degrees (clockwise on the screen).
inline Vec2 perpendicular(const Vec2& v) { return {-v.y(), v.x()}; }

}  // namespace ramify
