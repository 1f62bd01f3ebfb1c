// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <set>

#include "ramify/core/random.h"
#include "ramify/geometry/capsule_field.h"
#include "ramify/geometry/capsule_index.h"

using namespace ramify;

namespace {

Capsule random_capsule(Rng& rng, double spread) {
  const Vec2 a(rng.uniform(-20, spread + 20), rng.uniform(-20, spread + 20));
  return {a, a + Vec2(rng.uniform(-15, 15), rng.uniform(-15, 15)), rng.uniform(0.5, 6), rng.uniform(0.5, 6), rng.below(5), 0};
}

// Distance from a point to the rim by sampling the axis finely: no formula shared with the library.
double sampled_rim(const Capsule& c, const Vec2& p) {
  double nearest = 1e300, radius = 0.0;
  for (int i = 0; i <= 2000; ++i) {
    const double t = i / 2000.0, d = (c.a + t * (c.b - c.a) - p).norm();
    if (d < nearest) {
      nearest = d;
      radius = c.radius_a + t * (c.radius_b - c.radius_a);
    }
  }
  return std::max(0.0, nearest - radius);
}

}  // namespace

TEST_CASE("the rim distance agrees with a sampled axis") {
  Rng rng(3);
  for (int i = 0; i < 200; ++i) {
    const Capsule c = random_capsule(rng, 50);
    const Vec2 p(rng.uniform(-30, 80), rng.uniform(-30, 80));
    CHECK(rim_distance(c, p) == Approx(sampled_rim(c, p)).margin(0.02));
  }
}

TEST_CASE("queries of the capsule index agree with a walk over all capsules") {
  Rng rng(4);
  for (const double cell : {4.0, 17.0, 300.0}) {
    CapsuleIndex index(Vec2(0, 0), Vec2(200, 200), cell);
    std::vector<Capsule> all;
    for (int i = 0; i < 400; ++i) {
      all.push_back(random_capsule(rng, 200));
      CHECK(index.add(all.back()) == i);
      // Taking back the latest must leave no trace.
      if (i % 3 == 0) {
        index.add(random_capsule(rng, 200));
        index.remove_last();
      }
    }
    REQUIRE(index.count() == 400);
    for (int q = 0; q < 200; ++q) {
      const Vec2 p(rng.uniform(-40, 240), rng.uniform(-40, 240));
      const double limit = rng.uniform(1, 60);
      const int owner = rng.below(5);
      double nearest = limit;
      for (const Capsule& c : all) {
        if (c.owner != owner) nearest = std::min(nearest, rim_distance(c, p));
      }
      CHECK(index.nearest_rim(p, limit, [&](const Capsule& c) { return c.owner != owner; }) == nearest);
      std::multiset<int> seen;
      index.visit_box(p - Vec2(limit, limit), p + Vec2(limit, limit), [&](int number) {
        seen.insert(number);
        return true;
      });
      for (int i = 0; i < 400; ++i) {
        CHECK(seen.count(i) <= 1);
        if (rim_distance(all[i], p) < 0.5 * limit) CHECK(seen.count(i) == 1);
      }
    }
  }
}

TEST_CASE("the gap between capsules never exceeds a sampled one") {
  Rng rng(5);
  for (int i = 0; i < 300; ++i) {
    const Capsule a = random_capsule(rng, 40), b = random_capsule(rng, 40);
    double sampled = 1e300;
    for (int s = 0; s <= 60; ++s) {
      const double t = s / 60.0;
      const double ra = a.radius_a + t * (a.radius_b - a.radius_a);
      for (int u = 0; u <= 60; ++u) {
        const double v = u / 60.0, rb = b.radius_a + v * (b.radius_b - b.radius_a);
        sampled = std::min(sampled, (a.a + t * (a.b - a.a) - b.a - v * (b.b - b.a)).norm() - ra - rb);
      }
    }
    CHECK(capsule_gap(a, b) <= sampled + 1e-9);
  }
}

TEST_CASE("the capsule field holds the distance to the nearest rim") {
  Rng rng(6);
  std::vector<Capsule> all;
  for (int i = 0; i < 60; ++i) all.push_back(random_capsule(rng, 160));
  const CapsuleField field = capsule_field(all, Size{160, 120}, 2.0);
  double worst = 0.0;
  for (int y = 0; y < field.rows; ++y) {
    for (int x = 0; x < field.columns; ++x) {
      double nearest = 1e300;
      for (const Capsule& c : all) nearest = std::min(nearest, rim_distance(c, Vec2(2.0 * x, 2.0 * y)));
      worst = std::max(worst, field.at(x, y) - nearest);
    }
  }
  CHECK(worst < 1.0);
}

TEST_CASE("midway between two parallel lines the ridge is half their gap") {
  std::vector<Capsule> lines;
  for (const double y : {20.0, 100.0, 180.0}) lines.push_back({Vec2(-50, y), Vec2(350, y), 5.0, 5.0, 0, 0});
  CHECK(median_ridge(capsule_field(lines, Size{300, 200}, 2.0), 2.0) == Approx(35.0).margin(1.1));
  CHECK(median_ridge(capsule_field({}, Size{30, 20}, 2.0), 2.0) == 0.0);
}
