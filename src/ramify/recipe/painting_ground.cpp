// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/recipe/painting_ground.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numeric>

#include "ramify/image/color.h"
#include "ramify/image/filter.h"
#include "ramify/image/sample.h"

namespace ramify {
namespace {

std::string hex_of(const Rgb& color) {
  const auto level = [](float v) { return static_cast<unsigned>(std::lround(255.0f * std::clamp(v, 0.0f, 1.0f))); };
  char text[8];
  std::snprintf(text, sizeof text, "#%02x%02x%02x", level(color.r), level(color.g), level(color.b));
  return text;
}

}  // namespace

std::string palette_of_photo(const ColorImage& photo) {
  constexpr std::array<double, 3> kShares{0.01, 0.04, 0.12};
  const ScalarImage light = luma(photo);
  std::vector<int> order(light.pixels().size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return light.pixels()[static_cast<std::size_t>(a)] < light.pixels()[static_cast<std::size_t>(b)]; });
  std::string out;
  std::size_t from = 0;
  for (const double share : kShares) {
    const std::size_t to = std::clamp(static_cast<std::size_t>(share * static_cast<double>(order.size())), std::min(from + 1, order.size()), order.size());
    Rgb sum;
    for (std::size_t i = from; i < to; ++i) sum = sum + photo.pixels()[static_cast<std::size_t>(order[i])];
    if (to > from) out += (out.empty() ? "" : ",") + hex_of((1.0f / static_cast<float>(to - from)) * sum);
    from = to;
  }
  return out;
}

void fill_drawn(Raster& raster, const ColorImage& fill, const Vec2& shift) {
  for (int y = 0; y < raster.color.height(); ++y) {
    for (int x = 0; x < raster.color.width(); ++x) {
      if (raster.alpha(x, y) > 0) raster.color(x, y) = sample_bilinear(fill, Vec2(x, y) - shift);
    }
  }
}

void soften(Raster& raster, double sigma) {
  if (sigma <= 0.0) return;
  ScalarImage alpha(raster.alpha.size());
  for (std::size_t i = 0; i < alpha.pixels().size(); ++i) {
    alpha.pixels()[i] = raster.alpha.pixels()[i] / 255.0f;
    raster.color.pixels()[i] = alpha.pixels()[i] * raster.color.pixels()[i];
  }
  raster.color = gaussian_blur(raster.color, sigma);
  alpha = gaussian_blur(alpha, sigma);
  for (std::size_t i = 0; i < alpha.pixels().size(); ++i) {
    const float level = std::clamp(std::ceil(255.0f * alpha.pixels()[i] - 1e-2f), 0.0f, 255.0f);
    raster.alpha.pixels()[i] = static_cast<std::uint8_t>(level);
    raster.color.pixels()[i] = level > 0.0f ? (255.0f / level) * raster.color.pixels()[i] : Rgb{};
  }
}

void lay_over(Raster& raster, const ColorImage& ground) {
  for (std::size_t i = 0; i < ground.pixels().size(); ++i) {
    const float a = raster.alpha.pixels()[i] / 255.0f;
    raster.color.pixels()[i] = a * raster.color.pixels()[i] + (1.0f - a) * ground.pixels()[i];
    raster.alpha.pixels()[i] = 255;
  }
}

}  // namespace ramify
