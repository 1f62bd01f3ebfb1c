// SPDX-License-Identifier: GPL-3.0-or-later
#include <catch2/catch.hpp>
#include <cmath>

#include "ramify/compose/wider_plate.h"
#include "ramify/image/color.h"
#include "ramify/image/filter.h"

using namespace ramify;

namespace {

constexpr int kWidth = 300, kHeight = 200, kSkyline = 170;

// Cloud-like noise of several scales, without a trend.
ColorImage clouds(std::uint64_t seed) {
  Rng rng(seed);
  ScalarImage sum(kWidth, kHeight, 0.0f);
  for (const double sigma : {2.0, 6.0, 12.0}) {
    ScalarImage noise(kWidth, kHeight);
    for (float& v : noise.pixels()) v = static_cast<float>(rng.normal());
    noise = gaussian_blur(noise, sigma);
    for (std::size_t i = 0; i < sum.pixels().size(); ++i) sum.pixels()[i] += static_cast<float>(sigma) * noise.pixels()[i];
  }
  ColorImage out(kWidth, kHeight);
  for (std::size_t i = 0; i < out.pixels().size(); ++i) {
    const float v = 0.5f + 0.1f * sum.pixels()[i];
    out.pixels()[i] = {v, v, v};
  }
  return out;
}

WiderPlateJob job_with(std::array<int, 4> add) {
  return {Mask(kWidth, kHeight, 0), Mask(kWidth, kHeight, 0), add, {kWidth, kHeight, kWidth, kHeight}};
}

// Pearson's correlation of the `reach` columns right of `axis` with the ones left of it, mirrored.
double mirror_correlation(const ScalarImage& image, int axis, int reach) {
  double n = 0.0, a = 0.0, b = 0.0, aa = 0.0, bb = 0.0, ab = 0.0;
  for (int y = 0; y < image.height(); ++y) {
    for (int d = 0; d < reach; ++d) {
      const double p = image(axis - 1 - d, y), q = image(axis + d, y);
      n += 1.0, a += p, b += q, aa += p * p, bb += q * q, ab += p * q;
    }
  }
  return (ab - a * b / n) / std::sqrt((aa - a * a / n) * (bb - b * b / n));
}

}  // namespace

TEST_CASE("a widened plate is nowhere its own mirror image") {
  constexpr int kAdd = 200, kReach = 60;
  for (const std::uint64_t seed : {1, 2, 3}) {
    const ColorImage plate = clouds(seed);
    const ScalarImage own = luma(plate), wide = luma(widen_plate(plate, job_with({kAdd, 0, kAdd, 0}), Rng(seed)).color);
    double by_chance = 0.0, most = 0.0;  // around axes within the photo there is no symmetry but by chance
    for (int axis = kReach; axis <= kWidth - kReach; ++axis) by_chance = std::max(by_chance, mirror_correlation(own, axis, kReach));
    for (int axis = kReach; axis <= wide.width() - kReach; ++axis) most = std::max(most, mirror_correlation(wide, axis, kReach));
    CHECK(by_chance < 0.5);
    CHECK(most < by_chance + 0.15);
  }
}

TEST_CASE("a widened plate keeps the photo, and says which of its pixels it shows") {
  const ColorImage plate = clouds(4);
  const WiderPlate wide = widen_plate(plate, job_with({70, 40, 0, 90}), Rng(1));
  REQUIRE(wide.color.size() == Size{kWidth + 70, kHeight + 130});
  CHECK(wide.left == 70);
  CHECK(wide.top == 40);
  for (int y = kHeight / 6 + 1; y < kHeight - kHeight / 6 - 1; ++y) {
    for (int x = kWidth / 6 + 1; x < kWidth; ++x) REQUIRE(wide.color(x + 70, y + 40) == plate(x, y));
  }
  double off = 0.0;  // quick tones are the source's; slow ones are blended
  const auto quick = [](const ColorImage& image) {
    ScalarImage light = luma(image);
    const ScalarImage calm = gaussian_blur(light, 3.0);
    for (std::size_t i = 0; i < light.pixels().size(); ++i) light.pixels()[i] -= calm.pixels()[i];
    return light;
  };
  const ScalarImage have = quick(wide.color), want = quick(plate);
  double power = 0.0;
  for (int y = 0; y < have.height(); ++y) {
    for (int x = 0; x < have.width(); ++x) {
      const auto s = wide.source(x, y);
      REQUIRE(plate.contains(static_cast<int>(s.x()), static_cast<int>(s.y())));
      off += std::pow(have(x, y) - want(static_cast<int>(s.x()), static_cast<int>(s.y())), 2);
      power += std::pow(have(x, y), 2);
    }
  }
  CHECK(off < 0.1 * power);
}

TEST_CASE("a skyline goes on at its height and is not repeated above, and a landmark is not shown twice") {
  WiderPlateJob job = job_with({150, 120, 150, 60});
  job.margins[3] = 10;
  for (int y = kSkyline; y < kHeight; ++y) std::fill_n(job.outside.row(y), kWidth, std::uint8_t{255});
  for (int y = 80; y < 110; ++y) std::fill_n(job.landmark.row(y) + 60, 30, std::uint8_t{255});
  const WiderPlate wide = widen_plate(clouds(5), job, Rng(1));
  int landmark = 0;
  for (int y = 0; y < wide.color.height(); ++y) {
    for (int x = 0; x < wide.color.width(); ++x) {
      const int u = static_cast<int>(wide.source(x, y).x()), v = static_cast<int>(wide.source(x, y).y());
      REQUIRE((job.outside(u, v) != 0) == (y >= 120 + kSkyline));
      landmark += job.landmark(u, v) != 0;
    }
  }
  CHECK(landmark == 30 * 30);
}
