// SPDX-License-Identifier: GPL-3.0-or-later
#include <catch2/catch.hpp>
#include <cmath>

#include "ramify/core/random.h"
#include "ramify/image/contour.h"

using namespace ramify;

TEST_CASE("the contour of a cone is a circle with the low side to its right") {
  const Vec2 centre(30.3, 24.7);
  ScalarImage cone(64, 50);
  for (int y = 0; y < 50; ++y) {
    for (int x = 0; x < 64; ++x) cone(x, y) = static_cast<float>((Vec2(x, y) - centre).norm());
  }
  const std::vector<Contour> contours = trace_contours(cone, 15.0f);
  REQUIRE(contours.size() == 1);
  CHECK(contours[0].closed);
  double length = 0.0, area = 0.0;
  const std::vector<Vec2>& p = contours[0].points;
  for (std::size_t i = 0; i < p.size(); ++i) {
    const Vec2 &a = p[i], &b = p[(i + 1) % p.size()];
    CHECK((a - centre).norm() == Approx(15.0).margin(0.03));
    length += (b - a).norm();
    area += 0.5 * cross(a, b);
  }
  CHECK(length == Approx(2 * kPi * 15).epsilon(0.01));
  // Clockwise on the screen: positive with y down.
  CHECK(area == Approx(kPi * 15 * 15).epsilon(0.01));
}

TEST_CASE("a contour that meets the border is open and every crossing is on exactly one contour") {
  ScalarImage image(20, 12);
  for (int y = 0; y < 12; ++y) {
    for (int x = 0; x < 20; ++x) image(x, y) = static_cast<float>(hash01(3, x, y));
  }
  std::size_t crossings = 0;
  for (int y = 0; y < 12; ++y) {
    for (int x = 0; x < 20; ++x) {
      if (x + 1 < 20) crossings += (image(x, y) < 0.5f) != (image(x + 1, y) < 0.5f);
      if (y + 1 < 12) crossings += (image(x, y) < 0.5f) != (image(x, y + 1) < 0.5f);
    }
  }
  std::size_t points = 0;
  for (const Contour& c : trace_contours(image, 0.5f)) {
    points += c.points.size();
    if (c.closed) continue;
    for (const Vec2& end : {c.points.front(), c.points.back()}) {
      CHECK((end.x() == 0 || end.y() == 0 || end.x() == 19 || end.y() == 11));
    }
  }
  CHECK(points == crossings);
}
