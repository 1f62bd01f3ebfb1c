// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/image/color.h"

#include <cmath>

#include "ramify/core/parallel.h"

namespace ramify {
namespace {

template <class In, class Function>
auto map_pixels(const Image<In>& image, const Function& function) {
  Image<decltype(function(In{}))> out(image.size());
  parallel_for(image.height(), [&](int y) {
    for (int x = 0; x < image.width(); ++x) out(x, y) = function(image(x, y));
  }, 32);
  return out;
}

// CIE Lab's cube root with its linear foot.
float lab_curve(float t) { return t > 0.008856452f ? std::cbrt(t) : t * 7.787037f + 16.0f / 116.0f; }
float lab_curve_inverse(float f) { return f > 6.0f / 29.0f ? f * f * f : (f - 16.0f / 116.0f) / 7.787037f; }

constexpr float kWhiteX = 0.950456f;
constexpr float kWhiteZ = 1.088754f;

}  // namespace

float linear_from_srgb(float v) {
  const float a = std::abs(v);
  return std::copysign(a <= 0.04045f ? a / 12.92f : std::pow((a + 0.055f) / 1.055f, 2.4f), v);
}

float srgb_from_linear(float v) {
  const float a = std::abs(v);
  return std::copysign(a <= 0.0031308f ? a * 12.92f : 1.055f * std::pow(a, 1.0f / 2.4f) - 0.055f, v);
}

ColorImage linear_from_srgb(const ColorImage& image) {
  return map_pixels(image, [](const Rgb& c) {
    return Rgb{linear_from_srgb(c.r), linear_from_srgb(c.g), linear_from_srgb(c.b)};
  });
}

ColorImage srgb_from_linear(const ColorImage& image) {
  return map_pixels(image, [](const Rgb& c) {
    return Rgb{srgb_from_linear(c.r), srgb_from_linear(c.g), srgb_from_linear(c.b)};
  });
}

ScalarImage luma(const ColorImage& image) {
  return map_pixels(image, [](const Rgb& c) { return luma(c); });
}

Rgb lab_from_srgb(const Rgb& color) {
  const float r = linear_from_srgb(color.r), g = linear_from_srgb(color.g), b = linear_from_srgb(color.b);
  const float x = lab_curve((0.412453f * r + 0.357580f * g + 0.180423f * b) / kWhiteX);
  const float y = lab_curve(0.212671f * r + 0.715160f * g + 0.072169f * b);
  const float z = lab_curve((0.019334f * r + 0.119193f * g + 0.950227f * b) / kWhiteZ);
  return {116.0f * y - 16.0f, 500.0f * (x - y), 200.0f * (y - z)};
}

Rgb srgb_from_lab(const Rgb& lab) {
  const float fy = (lab.r + 16.0f) / 116.0f;
  const float x = kWhiteX * lab_curve_inverse(fy + lab.g / 500.0f);
  const float y = lab_curve_inverse(fy);
  const float z = kWhiteZ * lab_curve_inverse(fy - lab.b / 200.0f);
  return {srgb_from_linear(3.240479f * x - 1.537150f * y - 0.498535f * z),
          srgb_from_linear(-0.969256f * x + 1.875992f * y + 0.041556f * z),
          srgb_from_linear(0.055648f * x - 0.204043f * y + 1.057311f * z)};
}

ColorImage lab_from_srgb(const ColorImage& image) {
  return map_pixels(image, [](const Rgb& c) { return lab_from_srgb(c); });
}

float delta_e(const Rgb& a, const Rgb& b) {
  const Rgb d = a - b;
  return std::sqrt(d.r * d.r + d.g * d.g + d.b * d.b);
}

ScalarImage channel(const ColorImage& image, int index) {
  return map_pixels(image, [index](const Rgb& c) { return c[index]; });
}

ColorImage merge_channels(const ScalarImage& r, const ScalarImage& g, const ScalarImage& b) {
  ColorImage out(r.size());
  for (std::size_t i = 0; i < out.pixels().size(); ++i) out.pixels()[i] = {r.pixels()[i], g.pixels()[i], b.pixels()[i]};
  return out;
}

}  // namespace ramify
