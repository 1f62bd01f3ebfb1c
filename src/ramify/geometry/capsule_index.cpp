// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/geometry/capsule_index.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "ramify/geometry/segment.h"

namespace ramify {

double rim_distance(const Capsule& capsule, const Vec2& point) {
  const PointOnSegment foot = nearest_on_segment(point, capsule.a, capsule.b);
  const double radius = capsule.radius_a + (capsule.radius_b - capsule.radius_a) * foot.fraction;
  return std::max(0.0, foot.distance - radius);
}

double capsule_gap(const Capsule& first, const Capsule& second) {
  return segment_distance(first.a, first.b, second.a, second.b) - first.widest() - second.widest();
}

CapsuleIndex::CapsuleIndex(const Vec2& low, const Vec2& high, double cell) : low_(low), cell_(cell) {
  if (!(cell > 0.0) || !(high.x() >= low.x()) || !(high.y() >= low.y())) {
    throw std::invalid_argument("CapsuleIndex: empty range or cell");
  }
  columns_ = 1 + static_cast<int>((high.x() - low.x()) / cell);
  rows_ = 1 + static_cast<int>((high.y() - low.y()) / cell);
  grid_.resize(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_));
}

int CapsuleIndex::column(double x) const {
  return static_cast<int>(std::clamp((x - low_.x()) / cell_, 0.0, columns_ - 1.0));
}

int CapsuleIndex::row(double y) const {
  return static_cast<int>(std::clamp((y - low_.y()) / cell_, 0.0, rows_ - 1.0));
}

CapsuleIndex::Cells CapsuleIndex::cells_of(const Vec2& low, const Vec2& high) const {
  return {column(low.x()), row(low.y()), column(high.x()), row(high.y())};
}

int CapsuleIndex::add(const Capsule& capsule) {
  const Vec2 reach(capsule.widest(), capsule.widest());
  const Cells cells = cells_of(capsule.a.cwiseMin(capsule.b) - reach, capsule.a.cwiseMax(capsule.b) + reach);
  const int number = count();
  items_.push_back({capsule, cells});
  for (int y = cells.y0; y <= cells.y1; ++y) {
    for (int x = cells.x0; x <= cells.x1; ++x) grid_[static_cast<std::size_t>(y) * columns_ + x].push_back(number);
  }
  return number;
}

void CapsuleIndex::remove_last() {
  if (items_.empty()) throw std::logic_error("CapsuleIndex: nothing to remove");
  const Cells cells = items_.back().cells;
  for (int y = cells.y0; y <= cells.y1; ++y) {
    for (int x = cells.x0; x <= cells.x1; ++x) grid_[static_cast<std::size_t>(y) * columns_ + x].pop_back();
  }
  items_.pop_back();
}

}  // namespace ramify
