// SPDX-License-Identifier: GPL-3.0-or-later
#include <catch2/catch.hpp>

#include "ramify/core/random.h"
#include "ramify/geometry/bezier.h"

using namespace ramify;

namespace {

// Largest distance of a point from the curves, by dense sampling: independent of how they were fitted.
double farthest(const std::vector<Vec2>& points, const std::vector<CubicBezier>& curves) {
  double worst = 0.0;
  for (const Vec2& p : points) {
    double nearest = 1e300;
    for (const CubicBezier& curve : curves) {
      for (int i = 0; i <= 200; ++i) nearest = std::min(nearest, (point_on(curve, i / 200.0) - p).norm());
    }
    worst = std::max(worst, nearest);
  }
  return worst;
}

std::vector<Vec2> circle(double radius, int count) {
  std::vector<Vec2> out;
  for (int i = 0; i < count; ++i) out.push_back(Vec2(50, 50) + radius * direction_of(2 * kPi * i / count));
  return out;
}

}  // namespace

TEST_CASE("a circle becomes few curves that stay on it") {
  const double tolerance = 0.05;
  const std::vector<CubicBezier> curves = fit_closed_beziers(circle(30, 200), {tolerance, 0.7});
  CHECK(curves.size() <= 8);
  CHECK(curves.size() >= 3);
  for (std::size_t i = 0; i < curves.size(); ++i) {
    CHECK((curves[i][3] - curves[(i + 1) % curves.size()][0]).norm() < 1e-12);  // closed
    const Vec2 in = derivative_on(curves[i], 1.0).normalized(), out = derivative_on(curves[(i + 1) % curves.size()], 0.0).normalized();
    CHECK(in.dot(out) > 0.9999);  // smooth, the seam too
    for (int k = 0; k <= 50; ++k) CHECK(std::abs((point_on(curves[i], k / 50.0) - Vec2(50, 50)).norm() - 30.0) < 2 * tolerance);
  }
}

TEST_CASE("corners stay corners") {
  std::vector<Vec2> square;
  for (int side = 0; side < 4; ++side) {
    const Vec2 from = 20.0 * direction_of(side * kPi / 2), to = 20.0 * direction_of((side + 1) * kPi / 2);
    for (int i = 0; i < 20; ++i) square.push_back(from + (to - from) * (i / 20.0));
  }
  const std::vector<CubicBezier> curves = fit_closed_beziers(square, {0.1, 0.7});
  REQUIRE(curves.size() == 4);
  for (const CubicBezier& curve : curves) CHECK(std::abs(curve[0].norm() - 20.0) < 1e-9);
}

TEST_CASE("every point of a random walk lies within the tolerance") {
  for (int seed = 1; seed <= 30; ++seed) {
    Rng rng = Rng(seed).child("walk");
    std::vector<Vec2> points{Vec2(0, 0)};
    double heading = 0.0;
    for (int i = 0; i < 300; ++i) points.push_back(points.back() + direction_of(heading += 0.25 * rng.normal()));
    for (const double tolerance : {0.05, 0.3, 1.0}) {
      const std::vector<CubicBezier> curves = fit_beziers(points, {tolerance, 0.7});
      CHECK(farthest(points, curves) <= tolerance + 0.02);
      CHECK((curves.front()[0] - points.front()).norm() == 0.0);
      CHECK((curves.back()[3] - points.back()).norm() == 0.0);
    }
    CHECK(fit_beziers(points, {1.0, 0.7}).size() < fit_beziers(points, {0.05, 0.7}).size());
  }
}

TEST_CASE("degenerate runs give no curve or one") {
  CHECK(fit_beziers(std::vector<Vec2>{}).empty());
  CHECK(fit_beziers(std::vector<Vec2>{{1, 1}, {1, 1}}).empty());
  CHECK(fit_closed_beziers(std::vector<Vec2>{{1, 1}, {2, 1}}).empty());
  CHECK(fit_beziers(std::vector<Vec2>{{1, 1}, {4, 5}}).size() == 1);
}
