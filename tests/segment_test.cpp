// SPDX-License-Identifier: GPL-3.0-or-later
#include <catch2/catch.hpp>
#include <cmath>

#include "ramify/core/random.h"
#include "ramify/geometry/segment.h"

using namespace ramify;

TEST_CASE("orientation is exact where rounding decides wrongly") {
  // Kettner et al. 2008, "Classroom examples of robustness problems": points near a line through (12,12) and (24,24).
  const double ulp = std::ldexp(1.0, -53);
  const Vec2 q(12.0, 12.0), r(24.0, 24.0);
  for (int i = 0; i < 64; ++i) {
    for (int j = 0; j < 64; ++j) {
      const Vec2 p(0.5 + i * ulp, 0.5 + j * ulp);  // the line is y = x, so the sign is that of y - x
      const int truth = i == j ? 0 : i < j ? 1 : -1;
      CHECK(orientation(q, r, p) == truth);
      CHECK(orientation(r, q, p) == -truth);
    }
  }
}

TEST_CASE("orientation agrees with integer arithmetic") {
  Rng rng(5);
  for (int i = 0; i < 20000; ++i) {
    long long v[6];
    for (long long& x : v) x = rng.below(7) - 3 + 1000000LL * rng.below(2);
    const long long area = (v[2] - v[0]) * (v[5] - v[1]) - (v[3] - v[1]) * (v[4] - v[0]);
    CHECK(orientation(Vec2(v[0], v[1]), Vec2(v[2], v[3]), Vec2(v[4], v[5])) == (area > 0) - (area < 0));
  }
}

TEST_CASE("segments cross touch or stay apart") {
  const Vec2 o(0, 0), x(4, 0);
  CHECK(segment_relation(o, x, {2, -1}, {2, 1}) == SegmentRelation::Crossing);
  CHECK(crossing_fraction(o, x, {1, -1}, {1, 3}) == Approx(0.25));
  CHECK(segment_relation(o, x, {2, 0}, {2, 1}) == SegmentRelation::Touching);
  CHECK(segment_relation(o, x, {3, 0}, {9, 0}) == SegmentRelation::Touching);
  CHECK(segment_relation(o, x, {4, 0}, {9, 5}) == SegmentRelation::Touching);
  CHECK(segment_relation(o, x, {5, 0}, {9, 0}) == SegmentRelation::Apart);
  CHECK(segment_relation(o, x, {2, 1}, {2, 3}) == SegmentRelation::Apart);
  CHECK(segment_relation(o, o, {-1, -1}, {1, 1}) == SegmentRelation::Touching);
  CHECK(segment_distance(o, x, {2, 1}, {2, 3}) == 1.0);
  CHECK(segment_distance(o, x, {7, 4}, {7, 9}) == 5.0);
  CHECK(segment_distance(o, x, {2, -1}, {2, 1}) == 0.0);
}

TEST_CASE("segment distance is the minimum over densely sampled points") {
  Rng rng(8);
  const auto point = [&] { return Vec2(rng.uniform(0, 10), rng.uniform(0, 10)); };
  for (int trial = 0; trial < 200; ++trial) {
    const Vec2 a = point(), b = point(), c = point(), d = point();
    double best = 1e9;
    for (int i = 0; i <= 400; ++i) best = std::min(best, nearest_on_segment(a + (b - a) * i / 400.0, c, d).distance);
    const double distance = segment_distance(a, b, c, d);
    CHECK(distance <= best + 1e-12);
    CHECK(distance >= best - (b - a).norm() / 400.0);
    const bool crossing = segment_relation(a, b, c, d) == SegmentRelation::Crossing;
    if (crossing) {
      const double t = crossing_fraction(a, b, c, d);
      CHECK(nearest_on_segment(a + t * (b - a), c, d).distance < 1e-9);
    }
    CHECK((distance == 0.0) == crossing);
  }
}
