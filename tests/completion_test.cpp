// SPDX-License-Identifier: GPL-3.0-or-later
#include <catch2/catch.hpp>
#include <cmath>

#include "ramify/core/parallel.h"
#include "ramify/image/color.h"
#include "ramify/image/completion.h"
#include "ramify/image/filter.h"
#include "ramify/image/gradient_blend.h"
#include "ramify/image/morphology.h"

using namespace ramify;

namespace {

// Grain of two sizes on a slow gradient: a texture whose statistics are known to be the same everywhere.
ColorImage texture(int width, int height, std::uint64_t seed) {
  ScalarImage noise(width, height);
  Rng rng(seed);
  for (float& v : noise.pixels()) v = static_cast<float>(rng.normal());
  const ScalarImage fine = gaussian_blur(noise, 0.8), coarse = gaussian_blur(noise, 4.0);
  ColorImage out(width, height);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const float v = 0.5f + 0.06f * fine(x, y) + 0.35f * coarse(x, y) + 0.1f * x / width;
      out(x, y) = {v, 0.9f * v, 0.8f * v};
    }
  }
  return out;
}

Mask box(Size size, int x0, int y0, int x1, int y1) {
  Mask mask(size, 0);
  for (int y = y0; y < y1; ++y) {
    for (int x = x0; x < x1; ++x) mask(x, y) = 255;
  }
  return mask;
}

// Mean squared step between neighbours that both lie in (or both out of) the mask.
double sharpness(const ColorImage& image, const Mask& mask, bool inside) {
  double sum = 0.0, count = 0.0;
  for (int y = 0; y + 1 < image.height(); ++y) {
    for (int x = 0; x + 1 < image.width(); ++x) {
      if ((mask(x, y) != 0) != inside || (mask(x + 1, y) != 0) != inside || (mask(x, y + 1) != 0) != inside) continue;
      const float here = luma(image(x, y));
      sum += std::pow(luma(image(x + 1, y)) - here, 2) + std::pow(luma(image(x, y + 1)) - here, 2);
      count += 1.0;
    }
  }
  return std::sqrt(sum / count);
}

// Standard deviation of a band of the spectrum: the picture blurred by one sigma minus blurred by another.
double band(const ColorImage& image, const Mask& where, double fine, double coarse) {
  const ScalarImage light = luma(image), a = gaussian_blur(light, fine), b = gaussian_blur(light, coarse);
  double sum = 0.0, count = 0.0;
  for (std::size_t i = 0; i < light.pixels().size(); ++i) {
    if (!where.pixels()[i]) continue;
    sum += std::pow(a.pixels()[i] - b.pixels()[i], 2);
    count += 1.0;
  }
  return std::sqrt(sum / count);
}

struct Threads {
  explicit Threads(int n) { set_thread_count(n); }
  ~Threads() { set_thread_count(0); }
};

}  // namespace

TEST_CASE("completion fills the whole hole and leaves the rest alone") {
  const ColorImage image = texture(300, 220, 1);
  const Mask hole = box(image.size(), 90, 60, 210, 160);
  ColorImage damaged = image;
  for (std::size_t i = 0; i < hole.pixels().size(); ++i) {
    if (hole.pixels()[i]) damaged.pixels()[i] = {5.0f, -3.0f, 9.0f};  // must never be read
  }
  const Completion result = complete(damaged, hole, {}, {}, Rng(1), {});
  for (int y = 0; y < hole.height(); ++y) {
    for (int x = 0; x < hole.width(); ++x) {
      const Rgb c = result.color(x, y);
      if (!hole(x, y)) {
        REQUIRE(c == damaged(x, y));
      } else {
        REQUIRE(c.r > 0.0f);
        REQUIRE(c.r < 1.2f);
      }
    }
  }
}

TEST_CASE("completion copies nothing from the hole or from forbidden places") {
  const ColorImage image = texture(300, 220, 2);
  const Mask hole = box(image.size(), 90, 60, 210, 160), forbidden = box(image.size(), 0, 0, 80, 220);
  const Completion result = complete(image, hole, forbidden, {}, Rng(3), {});
  int copied = 0;
  for (int y = 0; y < hole.height(); ++y) {
    for (int x = 0; x < hole.width(); ++x) {
      if (!hole(x, y) || std::isnan(result.source(x, y).x())) continue;
      const int u = static_cast<int>(result.source(x, y).x()), v = static_cast<int>(result.source(x, y).y());
      REQUIRE(image.contains(u, v));
      REQUIRE(hole(u, v) == 0);
      REQUIRE(forbidden(u, v) == 0);
      ++copied;
    }
  }
  CHECK(copied > 0.99 * 120 * 100);
}

TEST_CASE("completion keeps sharpness and spectrum of a texture") {
  const ColorImage image = texture(420, 320, 5);
  const Mask hole = box(image.size(), 120, 80, 320, 250);
  const Completion result = complete(image, hole, {}, {}, Rng(1), {});
  CHECK(sharpness(result.color, hole, true) / sharpness(image, hole, false) == Approx(1.0).margin(0.05));
  for (const auto& [fine, coarse] : {std::pair{0.0, 1.0}, {1.0, 2.0}, {2.0, 4.0}}) {
    INFO("band between blurs of " << fine << " and " << coarse << " px");
    CHECK(band(result.color, hole, fine, coarse) / band(image, hole, fine, coarse) == Approx(1.0).margin(0.12));
  }
}

TEST_CASE("completion of a thin hole follows the tones around it") {
  const ColorImage image = texture(300, 200, 7);
  const Mask hole = box(image.size(), 0, 92, 300, 108);
  const Completion result = complete(image, hole, {}, {}, Rng(1), {});
  const ColorImage before = gaussian_blur(image, 12.0), after = gaussian_blur(result.color, 12.0);
  double worst = 0.0;
  for (int x = 0; x < 300; ++x) worst = std::max<double>(worst, std::abs(luma(before(x, 100)) - luma(after(x, 100))));
  CHECK(worst < 0.05);  // the hidden strip's own slow swings are unknown; a wrong tone would be off by the gradient's 0.1
}

TEST_CASE("completion gives the same bytes with any number of threads") {
  const ColorImage image = texture(260, 200, 9);
  const Mask hole = box(image.size(), 60, 40, 200, 170);
  Completion first;
  for (const int n : {1, 2, 5}) {
    const Threads threads(n);
    const Completion result = complete(image, hole, {}, {}, Rng(4), {});
    if (n == 1) first = result;
    CHECK(result.color == first.color);
  }
  CHECK_FALSE(complete(image, hole, {}, {}, Rng(5), {}).color == first.color);
}

TEST_CASE("completion without anything to copy says so") {
  const ColorImage image = texture(64, 64, 1);
  CHECK_THROWS_AS(complete(image, box(image.size(), 0, 0, 64, 64), {}, {}, Rng(1), {}), InputError);
  CHECK_THROWS_AS(complete(image, Mask(10, 10, 0), {}, {}, Rng(1), {}), std::invalid_argument);
  CHECK(complete(image, Mask(image.size(), 0), {}, {}, Rng(1), {}).color == image);
}

TEST_CASE("completion stops when asked to") {
  const ColorImage image = texture(300, 300, 1);
  Monitor monitor([](double, const std::string&) {});
  monitor.cancel();
  CHECK_THROWS_AS(complete(image, box(image.size(), 50, 50, 250, 250), {}, {}, Rng(1), monitor), Cancelled);
}

TEST_CASE("a large hole is cut at half resolution without losing pixels") {
  const ColorImage image = texture(801, 603, 11);  // odd sides
  const Mask hole = box(image.size(), 61, 51, 741, 553);
  const Completion result = complete(image, hole, {}, {}, Rng(1), {});
  int empty = 0;
  for (int y = 0; y < hole.height(); ++y) {
    for (int x = 0; x < hole.width(); ++x) {
      if (hole(x, y) && std::isnan(result.source(x, y).x())) ++empty;
    }
  }
  CHECK(empty == 0);
  CHECK(sharpness(result.color, hole, true) / sharpness(image, hole, false) == Approx(1.0).margin(0.05));
}

TEST_CASE("a membrane over a linear ramp is that ramp") {
  ColorImage ramp(90, 70);
  for (int y = 0; y < 70; ++y) {
    for (int x = 0; x < 90; ++x) ramp(x, y) = {0.01f * x, 0.005f * y, 0.3f + 0.002f * x + 0.003f * y};
  }
  const Mask hole = box(ramp.size(), 10, 12, 80, 60);
  ColorImage damaged = ramp;
  for (std::size_t i = 0; i < hole.pixels().size(); ++i) {
    if (hole.pixels()[i]) damaged.pixels()[i] = {};
  }
  const ColorImage filled = membrane(damaged, hole, {});
  double worst = 0.0;
  for (std::size_t i = 0; i < ramp.pixels().size(); ++i) {
    for (int c = 0; c < 3; ++c) worst = std::max<double>(worst, std::abs(filled.pixels()[i][c] - ramp.pixels()[i][c]));
  }
  CHECK(worst < 0.01);  // linear functions are harmonic
}

TEST_CASE("grey extremes agree with brute force") {
  ScalarImage image(23, 17);
  Rng rng(3);
  for (float& v : image.pixels()) v = static_cast<float>(rng.uniform());
  for (const int radius : {1, 2, 5, 9}) {
    const ScalarImage low = lowest_around(image, radius), high = highest_around(image, radius);
    for (int y = 0; y < 17; ++y) {
      for (int x = 0; x < 23; ++x) {
        float lowest = 9.0f, highest = -9.0f;
        for (int v = std::max(0, y - radius); v <= std::min(16, y + radius); ++v) {
          for (int u = std::max(0, x - radius); u <= std::min(22, x + radius); ++u) {
            lowest = std::min(lowest, image(u, v));
            highest = std::max(highest, image(u, v));
          }
        }
        REQUIRE(low(x, y) == lowest);
        REQUIRE(high(x, y) == highest);
      }
    }
  }
}

TEST_CASE("the structure length grows with the grain") {
  ScalarImage noise(200, 200);
  Rng rng(1);
  for (float& v : noise.pixels()) v = static_cast<float>(rng.normal());
  double before = 0.0;
  for (const double sigma : {1.0, 3.0, 6.0}) {
    const ScalarImage blurred = gaussian_blur(noise, sigma);
    const double length = structure_length(merge_channels(blurred, blurred, blurred), Mask(200, 200, 0));
    CHECK(length > before);
    // The autocorrelation of white noise blurred by sigma is exp(-lag^2 / 4 sigma^2): 0.15 at lag 2.75 sigma.
    CHECK(length == Approx(2.75 * sigma).margin(0.35 * 2.75 * sigma + 1.5));
    before = length;
  }
}
