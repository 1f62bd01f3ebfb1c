// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <catch2/catch.hpp>
#include <stdexcept>

#include "ramify/core/random.h"
#include "ramify/skeleton/radius_map.h"
#include "support/random_skeleton.h"

using namespace ramify;

namespace {

Skeleton some_skeleton(std::uint64_t seed) {
  return random_skeleton(Rng(seed), {200, 150}, 8, 20);
}

}  // namespace

TEST_CASE("mapped radii are the wanted ones, in the order they had") {
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    const Skeleton a = some_skeleton(seed), b = some_skeleton(seed + 1000);
    const RadiusSpread wanted = measure_radius_spread(b);
    const Skeleton mapped = map_radii(a, wanted);
    for (int i = 0; i < a.count(); ++i) {
      CHECK(mapped[i].radius >= wanted.radii.front());
      CHECK(mapped[i].radius <= wanted.radii.back());
      CHECK(mapped[i].position == a[i].position);
      for (int k = 0; k < i; ++k) {
        if (a[i].radius >= a[k].radius) CHECK(mapped[i].radius >= mapped[k].radius);
        if (a[i].radius == a[k].radius) CHECK(mapped[i].radius == mapped[k].radius);
      }
    }
  }
}

TEST_CASE("a skeleton's own spread changes nothing, and its unit does not matter") {
  const Skeleton a = some_skeleton(5);
  const RadiusSpread own = measure_radius_spread(a);
  const Skeleton same = map_radii(a, own);
  Skeleton large = a;
  for (int i = 0; i < large.count(); ++i) large.set_radius(i, 7.5 * large[i].radius);
  const Skeleton back = map_radii(large, own);
  for (int i = 0; i < a.count(); ++i) {
    const double radius = std::clamp(a[i].radius, own.radii.front(), own.radii.back());
    CHECK(same[i].radius == Approx(radius).epsilon(1e-12));
    CHECK(back[i].radius == Approx(radius).epsilon(1e-9));
  }
}

TEST_CASE("lines of one width become the median") {
  Skeleton line(Size{100, 10}), taper(Size{100, 10});
  for (int i = 0; i < 21; ++i) {
    line.append({Vec3(4.0 * i, 5, 0), 3.0, i - 1});
    taper.append({Vec3(4.0 * i, 5, 0), 10.0 - 0.4 * i, i - 1});
  }
  const Skeleton mapped = map_radii(line, measure_radius_spread(taper));
  for (const Node& node : mapped.nodes()) CHECK(node.radius == Approx(6.0));
  CHECK_THROWS_AS(measure_radius_spread(Skeleton(Size{3, 3})), std::invalid_argument);
  Skeleton dots(Size{9, 9});
  dots.append({Vec3(1, 1, 0), 1.0, kNone});
  dots.append({Vec3(7, 7, 0), 3.0, kNone});
  CHECK(measure_radius_spread(dots).radius_at(0.5) == Approx(2.0));
}
