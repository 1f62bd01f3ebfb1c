// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/geometry/homography.h"

#include <Eigen/LU>
#include <cmath>

#include "ramify/core/error.h"

namespace ramify {
namespace {

constexpr double kSmallestSine = 0.02;  // about one degree: flatter corners make the map explode

// The map from the unit square's corners (0,0) (1,0) (1,1) (0,1) to a quadrilateral, closed form (Heckbert 1989).
Homography from_unit_square(const std::array<Vec2, 4>& q) {
  const Vec2 sum = q[0] - q[1] + q[2] - q[3], a = q[1] - q[2], b = q[3] - q[2];
  const double determinant = cross(a, b);
  const double g = cross(sum, b) / determinant, h = cross(a, sum) / determinant;
  Homography m;
  m << q[1].x() - q[0].x() + g * q[1].x(), q[3].x() - q[0].x() + h * q[3].x(), q[0].x(),
      q[1].y() - q[0].y() + g * q[1].y(), q[3].y() - q[0].y() + h * q[3].y(), q[0].y(), g, h, 1.0;
  return m;
}

}  // namespace

const char* fault_of_corners(const std::array<Vec2, 4>& corners) {
  int turns = 0;
  for (int i = 0; i < 4; ++i) {
    const Vec2 in = corners[(i + 1) % 4] - corners[i], out = corners[(i + 2) % 4] - corners[(i + 1) % 4];
    if (!in.allFinite() || !out.allFinite()) return "a corner is not a finite point";
    if (in.norm() < 1.0 || out.norm() < 1.0) return "two corners fall together";
    const double sine = cross(in, out) / (in.norm() * out.norm());
    if (std::abs(sine) < kSmallestSine) return "three corners lie nearly in one line";
    turns += sine > 0.0 ? 1 : -1;
  }
  if (turns == 0) return "its sides cross; give the corners in order around it";
  if (turns != 4 && turns != -4) return "it is not convex; give the corners in order around it";
  return nullptr;
}

Homography homography_from_corners(const std::array<Vec2, 4>& from, const std::array<Vec2, 4>& to) {
  for (const auto* quad : {&from, &to}) {
    if (const char* why = fault_of_corners(*quad)) throw InputError("corners", std::string("the quadrilateral cannot be rectified: ") + why);
  }
  const Homography map = from_unit_square(to) * from_unit_square(from).inverse();
  if (std::abs(map(2, 2)) < 1e-12 * map.norm()) throw InputError("corners", "the horizon runs through the picture's origin");
  return map / map(2, 2);
}

Vec2 apply(const Homography& map, const Vec2& p) {
  const Eigen::Vector3d q = map * Eigen::Vector3d(p.x(), p.y(), 1.0);
  return q.head<2>() / q.z();
}

Homography inverse(const Homography& map) {
  const Homography inverted = map.inverse();
  if (!inverted.allFinite() || std::abs(inverted(2, 2)) < 1e-12 * inverted.norm()) {
    throw InputError("homography", "has no usable inverse");
  }
  return inverted / inverted(2, 2);
}

Eigen::Matrix2d jacobian(const Homography& map, const Vec2& p) {
  const Eigen::Vector3d q = map * Eigen::Vector3d(p.x(), p.y(), 1.0);
  Eigen::Matrix2d j;
  for (int row = 0; row < 2; ++row) {
    for (int column = 0; column < 2; ++column) {
      j(row, column) = (map(row, column) - q[row] / q.z() * map(2, column)) / q.z();
    }
  }
  return j;
}

bool in_front(const Homography& map, const Vec2& p) {
  return map(2, 0) * p.x() + map(2, 1) * p.y() + map(2, 2) > 1e-9;
}

Homography homography_from_row_major(const std::array<double, 9>& v) {
  Homography m;
  m << v[0], v[1], v[2], v[3], v[4], v[5], v[6], v[7], v[8];
  return m;
}

std::array<double, 9> row_major(const Homography& m) {
  return {m(0, 0), m(0, 1), m(0, 2), m(1, 0), m(1, 1), m(1, 2), m(2, 0), m(2, 1), m(2, 2)};
}

}  // namespace ramify
