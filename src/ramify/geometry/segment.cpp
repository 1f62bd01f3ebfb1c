// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/geometry/segment.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace ramify {
namespace {

// A sum of doubles without rounding: components that do not overlap, growing in size (Shewchuk 1997, grow-expansion).
class ExactSum {
 public:
  void add(double value) {
    int kept = 0;
    for (int i = 0; i < count_; ++i) {
      const double sum = value + parts_[i];
      const double other = sum - value;
      const double error = (value - (sum - other)) + (parts_[i] - other);
      if (error != 0.0) parts_[kept++] = error;
      value = sum;
    }
    parts_[kept++] = value;
    count_ = kept;
  }
  void add_product(double a, double b) {
    const double product = a * b;
    add(std::fma(a, b, -product));
    add(product);
  }
  int sign() const {
    for (int i = count_ - 1; i >= 0; --i) {
      if (parts_[i] != 0.0) return parts_[i] > 0.0 ? 1 : -1;
    }
    return 0;
  }

 private:
  std::array<double, 16> parts_{};
  int count_ = 0;
};

bool within(double low, double high, double value) { return std::min(low, high) <= value && value <= std::max(low, high); }

// For a point known to lie on the line through a and b.
bool between(const Vec2& a, const Vec2& b, const Vec2& point) {
  return within(a.x(), b.x(), point.x()) && within(a.y(), b.y(), point.y());
}

}  // namespace

int orientation(const Vec2& a, const Vec2& b, const Vec2& c) {
  const double left = (b.x() - a.x()) * (c.y() - a.y());
  const double right = (b.y() - a.y()) * (c.x() - a.x());
  const double area = left - right;
  const double bound = 4.0e-16 * (std::abs(left) + std::abs(right));  // Shewchuk's (3 + 16 eps) eps, rounded up
  if (area > bound) return 1;
  if (area < -bound) return -1;
  ExactSum sum;
  sum.add_product(a.x(), b.y());
  sum.add_product(-a.y(), b.x());
  sum.add_product(b.x(), c.y());
  sum.add_product(-b.y(), c.x());
  sum.add_product(c.x(), a.y());
  sum.add_product(-c.y(), a.x());
  return sum.sign();
}

PointOnSegment nearest_on_segment(const Vec2& point, const Vec2& a, const Vec2& b) {
  const Vec2 edge = b - a;
  const double square = edge.squaredNorm();
  const double t = square > 0.0 ? std::clamp((point - a).dot(edge) / square, 0.0, 1.0) : 0.0;
  const Vec2 foot = t < 1.0 ? Vec2(a + t * edge) : b;  // a + (b - a) need not be b
  return {(point - foot).norm(), t};
}

SegmentRelation segment_relation(const Vec2& a, const Vec2& b, const Vec2& c, const Vec2& d) {
  if (std::max(a.x(), b.x()) < std::min(c.x(), d.x()) || std::max(c.x(), d.x()) < std::min(a.x(), b.x()) ||
      std::max(a.y(), b.y()) < std::min(c.y(), d.y()) || std::max(c.y(), d.y()) < std::min(a.y(), b.y())) {
    return SegmentRelation::Apart;
  }
  const int abc = orientation(a, b, c), abd = orientation(a, b, d);
  const int cda = orientation(c, d, a), cdb = orientation(c, d, b);
  if (abc * abd < 0 && cda * cdb < 0) return SegmentRelation::Crossing;
  const bool touch = (abc == 0 && between(a, b, c)) || (abd == 0 && between(a, b, d)) ||
                     (cda == 0 && between(c, d, a)) || (cdb == 0 && between(c, d, b));
  return touch ? SegmentRelation::Touching : SegmentRelation::Apart;
}

double segment_distance(const Vec2& a, const Vec2& b, const Vec2& c, const Vec2& d) {
  if (segment_relation(a, b, c, d) != SegmentRelation::Apart) return 0.0;
  return std::min({nearest_on_segment(a, c, d).distance, nearest_on_segment(b, c, d).distance,
                   nearest_on_segment(c, a, b).distance, nearest_on_segment(d, a, b).distance});
}

double crossing_fraction(const Vec2& a, const Vec2& b, const Vec2& c, const Vec2& d) {
  const Vec2 ab = b - a, cd = d - c;
  const double area = cross(ab, cd);
  return area != 0.0 ? std::clamp(cross(c - a, cd) / area, 0.0, 1.0) : 0.5;
}

}  // namespace ramify
