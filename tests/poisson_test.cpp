// SPDX-License-Identifier: GPL-3.0-or-later
#include <catch2/catch.hpp>
#include <cmath>

#include "ramify/core/parallel.h"
#include "ramify/core/random.h"
#include "ramify/image/poisson.h"

using namespace ramify;

namespace {

ColorImage random_picture(Size size, std::uint64_t seed) {
  Rng rng(seed);
  ColorImage image(size);
  for (Rgb& p : image.pixels()) p = {float(rng.uniform()), float(rng.uniform()), float(rng.uniform())};
  return image;
}

// Largest violation of the normal equations of the screened problem.
double screened_residual(const ColorImage& u, const ColorImage& target, const ColorGradients& g, double lambda) {
  double worst = 0.0;
  for (int y = 0; y < u.height(); ++y) {
    for (int x = 0; x < u.width(); ++x) {
      for (int c = 0; c < 3; ++c) {
        double r = lambda * (u(x, y)[c] - target(x, y)[c]);
        if (x + 1 < u.width()) r -= u(x + 1, y)[c] - u(x, y)[c] - g.right(x, y)[c];
        if (x > 0) r += u(x, y)[c] - u(x - 1, y)[c] - g.right(x - 1, y)[c];
        if (y + 1 < u.height()) r -= u(x, y + 1)[c] - u(x, y)[c] - g.down(x, y)[c];
        if (y > 0) r += u(x, y)[c] - u(x, y - 1)[c] - g.down(x, y - 1)[c];
        worst = std::max(worst, std::abs(r));
      }
    }
  }
  return worst;
}

double largest_difference(const ColorImage& a, const ColorImage& b) {
  double worst = 0.0;
  for (std::size_t i = 0; i < a.pixels().size(); ++i) {
    for (int c = 0; c < 3; ++c) worst = std::max(worst, std::abs(double(a.pixels()[i][c]) - b.pixels()[i][c]));
  }
  return worst;
}

}  // namespace

TEST_CASE("the screened solution satisfies its normal equations for any length") {
  for (const Size size : {Size{1, 1}, Size{37, 1}, Size{64, 48}, Size{101, 67}, Size{269, 31}}) {
    for (const double lambda : {1e-5, 1e-3, 1.0}) {
      const ColorImage target = random_picture(size, 1);
      const ColorGradients g = gradients_of(random_picture(size, 2));
      const ColorImage u = solve_screened_poisson(target, g, lambda, Monitor());
      CHECK(screened_residual(u, target, g, lambda) < 1e-4);
    }
  }
}

TEST_CASE("a picture's own gradients give it back and a weak screen keeps shape but not level") {
  const ColorImage picture = random_picture({90, 70}, 3);
  CHECK(largest_difference(solve_screened_poisson(picture, gradients_of(picture), 1e-3, Monitor()), picture) < 1e-6);
  // Gradients of the picture with the target 0: closed form for a cosine, amplitude s / (s + lambda).
  const int width = 64;
  ColorImage cosine(width, 8);
  const double s = 2.0 - 2.0 * std::cos(kPi * 5 / width), lambda = 0.02;
  for (int y = 0; y < 8; ++y) {
    for (int x = 0; x < width; ++x) cosine(x, y).r = float(std::cos(kPi * 5 * (x + 0.5) / width));
  }
  const ColorImage u = solve_screened_poisson(ColorImage(width, 8), gradients_of(cosine), lambda, Monitor());
  for (int x = 0; x < width; ++x) CHECK(u(x, 3).r == Approx(cosine(x, 3).r * s / (s + lambda)).margin(1e-5));
}

TEST_CASE("a membrane over a ring is the logarithm") {
  // Laplace between two circles: u = log(r / r0) / log(r1 / r0), up to the pixel staircase of the circles.
  const int n = 141, centre = 70;
  const double r0 = 12, r1 = 64;
  ScalarImage picture(n, n);
  Mask unknown(n, n);
  auto exact = [&](int x, int y) { return std::log(std::hypot(x - centre, y - centre) / r0) / std::log(r1 / r0); };
  for (int y = 0; y < n; ++y) {
    for (int x = 0; x < n; ++x) {
      const double r = std::hypot(x - centre, y - centre);
      unknown(x, y) = r > r0 && r < r1 ? 255 : 0;
      picture(x, y) = unknown(x, y) ? 0.5f : r <= 0.0 ? 0.0f : static_cast<float>(exact(x, y));
    }
  }
  const ScalarImage u = fill_membrane(picture, unknown, Monitor());
  for (int y = 0; y < n; ++y) {
    for (int x = 0; x < n; ++x) {
      if (unknown(x, y)) CHECK(u(x, y) == Approx(exact(x, y)).margin(1.5e-3));
    }
  }
}

TEST_CASE("wanted gradients rebuild what was cut out and large holes agree with the small solver's answer") {
  const ColorImage picture = random_picture({320, 260}, 4);
  const ColorGradients g = gradients_of(picture);
  for (const int margin : {120, 20}) {  // few unknowns: Cholesky; 280 x 220: coarse to fine
    Mask unknown(320, 260);
    ColorImage holed = picture;
    for (int y = margin; y < 260 - margin; ++y) {
      for (int x = margin; x < 320 - margin; ++x) {
        unknown(x, y) = 255;
        holed(x, y) = {0.5f, 0.5f, 0.5f};
      }
    }
    CHECK(largest_difference(solve_poisson(holed, unknown, g, Monitor()), picture) < 2e-3);
  }
}

TEST_CASE("a region without any known pixel keeps its mean") {
  const ColorImage picture = random_picture({12, 9}, 5);
  const ColorImage u = fill_membrane(picture, Mask(12, 9, 255), Monitor());
  double mean = 0.0;
  for (const Rgb& p : picture.pixels()) mean += p.g / picture.pixels().size();
  for (const Rgb& p : u.pixels()) CHECK(p.g == Approx(mean).margin(1e-3));
}
