// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/geometry/thin_plate.h"

#include <Eigen/LU>
#include <algorithm>
#include <limits>
#include <stdexcept>

namespace ramify {
namespace {

double phi(double squared) { return squared < 1e-12 ? 0.0 : 0.5 * squared * std::log(squared); }

}  // namespace

ThinPlate::ThinPlate(std::span<const Vec2> points, std::span<const Vec2> values, double scale, double smoothing)
    : scale_(scale) {
  const int n = static_cast<int>(points.size());
  if (n < 3 || values.size() != points.size() || !(scale > 0.0)) {
    throw std::invalid_argument("ThinPlate: needs a positive scale and at least three points with one value each");
  }
  for (const Vec2& p : points) points_.push_back(p / scale);
  Eigen::MatrixXd system = Eigen::MatrixXd::Zero(n + 3, n + 3), rhs = Eigen::MatrixXd::Zero(n + 3, 2);
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < i; ++j) system(i, j) = system(j, i) = phi((points_[i] - points_[j]).squaredNorm());
    system(i, i) = smoothing;
    system(i, n) = system(n, i) = 1.0;
    system(i, n + 1) = system(n + 1, i) = points_[i].x();
    system(i, n + 2) = system(n + 2, i) = points_[i].y();
    rhs.row(i) = values[i].transpose();
  }
  const Eigen::MatrixXd solution = system.partialPivLu().solve(rhs);
  for (int i = 0; i < n; ++i) weights_.emplace_back(solution.row(i).transpose());
  offset_ = solution.row(n).transpose();
  slope_x_ = solution.row(n + 1).transpose();
  slope_y_ = solution.row(n + 2).transpose();
}

Vec2 ThinPlate::operator()(const Vec2& x) const {
  const Vec2 u = x / scale_;
  Vec2 sum = offset_ + u.x() * slope_x_ + u.y() * slope_y_;
  for (std::size_t i = 0; i < points_.size(); ++i) sum += phi((u - points_[i]).squaredNorm()) * weights_[i];
  return sum;
}

Vec2 WarpGrid::operator()(const Vec2& p) const {
  const Vec2 u = (p - origin) / step;
  const int x = std::clamp(static_cast<int>(std::floor(u.x())), 0, columns - 2);
  const int y = std::clamp(static_cast<int>(std::floor(u.y())), 0, rows - 2);
  const double fx = u.x() - x, fy = u.y() - y;
  const Vec2* v = values.data() + static_cast<std::size_t>(y) * columns + x;
  return (1 - fy) * ((1 - fx) * v[0] + fx * v[1]) + fy * ((1 - fx) * v[columns] + fx * v[columns + 1]);
}

JacobianRange measure_jacobian(const WarpGrid& warp, const Vec2& centre, double radius) {
  JacobianRange range{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  for (int y = 0; y + 1 < warp.rows; ++y) {
    for (int x = 0; x + 1 < warp.columns; ++x) {
      if ((warp.origin + warp.step * Vec2(x, y) - centre).norm() > radius) continue;
      const Vec2* v = warp.values.data() + static_cast<std::size_t>(y) * warp.columns + x;
      const double area = cross(v[1] - v[0], v[warp.columns] - v[0]) / (warp.step * warp.step);
      range.low = std::min(range.low, area);
      range.high = std::max(range.high, area);
    }
  }
  return range.low > range.high ? JacobianRange{} : range;
}

}  // namespace ramify
