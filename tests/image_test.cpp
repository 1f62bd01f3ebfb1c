// SPDX-License-Identifier: GPL-3.0-or-later
#include <catch2/catch.hpp>
#include <cmath>

#include "ramify/core/parallel.h"
#include "ramify/core/random.h"
#include "ramify/image/color.h"
#include "ramify/image/filter.h"
#include "ramify/image/sample.h"

using namespace ramify;

namespace {

Mask random_mask(int w, int h, double share, Rng rng) {
  Mask mask(w, h);
  for (auto& p : mask.pixels()) p = rng.uniform() < share ? 255 : 0;
  return mask;
}

ScalarImage random_image(int w, int h, Rng rng) {
  ScalarImage image(w, h);
  for (auto& p : image.pixels()) p = static_cast<float>(rng.uniform());
  return image;
}

}  // namespace

TEST_CASE("distances equal brute force") {
  for (int trial = 0; trial < 8; ++trial) {
    const Mask mask = random_mask(37, 23, trial == 0 ? 0.0 : 0.02 * trial, Rng(trial));
    const ScalarImage d = distance_to(mask);
    for (int y = 0; y < 23; ++y) {
      for (int x = 0; x < 37; ++x) {
        double best = INFINITY;
        for (int v = 0; v < 23; ++v)
          for (int u = 0; u < 37; ++u)
            if (mask(u, v)) best = std::min(best, std::hypot(u - x, v - y));
        if (std::isinf(best)) CHECK(std::isinf(d(x, y)));
        else CHECK(d(x, y) == Approx(best).margin(1e-4));
      }
    }
  }
}

TEST_CASE("a blur keeps a plane and the mean and spreads a point by its sigma") {
  for (const double sigma : {0.7, 3.0, 20.0}) {
    ScalarImage point(201, 181, 0.0f);
    point(100, 90) = 1000.0f;
    const ScalarImage out = gaussian_blur(point, sigma);
    double sum = 0, xx = 0, yy = 0;
    for (int y = 0; y < 181; ++y)
      for (int x = 0; x < 201; ++x) {
        sum += out(x, y);
        xx += out(x, y) * (x - 100) * (x - 100);
        yy += out(x, y) * (y - 90) * (y - 90);
      }
    CHECK(sum == Approx(1000.0).epsilon(0.01));
    CHECK(std::sqrt(xx / sum) == Approx(sigma).epsilon(0.03));
    CHECK(std::sqrt(yy / sum) == Approx(sigma).epsilon(0.03));
    const ScalarImage flat(64, 64, 0.25f);
    for (const float v : gaussian_blur(flat, sigma).pixels()) REQUIRE(v == Approx(0.25f));
  }
}

TEST_CASE("filters give the same bytes with any number of threads") {
  const ScalarImage image = random_image(150, 90, Rng(5));
  const Mask mask = random_mask(150, 90, 0.03, Rng(6));
  std::vector<ScalarImage> blurred, wide, far;
  for (const int threads : {1, 2, 8}) {
    set_thread_count(threads);
    blurred.push_back(gaussian_blur(image, 2.0));
    wide.push_back(gaussian_blur(image, 30.0));
    far.push_back(distance_to(mask));
  }
  set_thread_count(0);
  for (int i = 1; i < 3; ++i) {
    CHECK(blurred[0] == blurred[i]);
    CHECK(wide[0] == wide[i]);
    CHECK(far[0] == far[i]);
  }
}

TEST_CASE("colour conversions invert each other and meet reference values") {
  Rng rng(1);
  for (int i = 0; i < 2000; ++i) {
    const Rgb c{static_cast<float>(rng.uniform()), static_cast<float>(rng.uniform()), static_cast<float>(rng.uniform())};
    const Rgb back = srgb_from_lab(lab_from_srgb(c));
    for (int k = 0; k < 3; ++k) {
      CHECK(back[k] == Approx(c[k]).margin(2e-4));
      CHECK(srgb_from_linear(linear_from_srgb(c[k])) == Approx(c[k]).margin(1e-5));
    }
  }
  // CIE Lab of the sRGB primaries under D65 (Lindbloom).
  const Rgb red = lab_from_srgb(Rgb{1, 0, 0});
  CHECK(red.r == Approx(53.24).margin(0.05));
  CHECK(red.g == Approx(80.09).margin(0.1));
  CHECK(red.b == Approx(67.20).margin(0.1));
  CHECK(lab_from_srgb(Rgb{1, 1, 1}).r == Approx(100.0).margin(0.01));
  CHECK(linear_from_srgb(0.5f) == Approx(0.21404f).margin(1e-4));
}

TEST_CASE("resampling reproduces a smooth picture between its pixels") {
  ColorImage image(64, 48);
  const auto truth = [](double x, double y) { return 0.5 + 0.3 * std::sin(0.35 * x + 0.2) * std::cos(0.3 * y); };
  for (int y = 0; y < 48; ++y)
    for (int x = 0; x < 64; ++x) image(x, y) = Rgb{static_cast<float>(truth(x, y)), 0.5f, static_cast<float>(x)};
  Rng rng(2);
  for (int i = 0; i < 500; ++i) {
    const Vec2 p(rng.uniform(4, 58), rng.uniform(4, 42));
    CHECK(sample_lanczos3(image, p).r == Approx(truth(p.x(), p.y())).margin(4e-3));
    CHECK(sample_lanczos3(image, p).g == Approx(0.5).margin(1e-5));
    CHECK(sample_bilinear(image, p).b == Approx(p.x()).margin(1e-4));
  }
  CHECK(sample_lanczos3(image, Vec2(7, 9)) == image(7, 9));
}

TEST_CASE("small components and holes are told from large ones and from bays at the frame") {
  Mask mask(20, 12, 0);
  for (int y = 2; y < 10; ++y)
    for (int x = 2; x < 12; ++x) mask(x, y) = 255;
  mask(5, 5) = 0;
  mask(17, 6) = 255;
  CHECK(drop_small_components(mask, 2)(17, 6) == 0);
  CHECK(drop_small_components(mask, 2)(3, 3) == 255);
  CHECK(fill_small_holes(mask, 4)(5, 5) == 255);
  CHECK(fill_small_holes(mask, 500)(0, 0) == 0);
  int count = 0;
  label_components(mask, true, count);
  CHECK(count == 2);
  CHECK(mean_of(mask) == Approx((80 - 1 + 1) / 240.0));
}

TEST_CASE("dilation and erosion by a disc") {
  Mask mask(31, 31, 0);
  mask(15, 15) = 255;
  const Mask disc = dilate(mask, 5.0);
  int area = 0;
  for (const auto p : disc.pixels()) area += p != 0;
  CHECK(area == 81);  // lattice points within 5 of the origin
  CHECK(erode(disc, 5.0)(15, 15) == 255);
  CHECK(erode(disc, 5.2)(15, 15) == 0);
}
