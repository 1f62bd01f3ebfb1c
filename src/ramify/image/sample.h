// SPDX-License-Identifier: GPL-3.0-or-later
// Values of a picture between its pixels, and pictures at other sizes. Outside the picture the nearest pixel counts.
#pragma once

#include "ramify/image/image.h"

namespace ramify {

// p in px, the centre of pixel (0,0) at (0,0).
float sample_bilinear(const ScalarImage& image, const Vec2& p);
Rgb sample_bilinear(const ColorImage& image, const Vec2& p);

// Separable Lanczos-3, weights normalised. Keeps 0.84 to 0.90 of the finest band of a photo where bilinear keeps half
// (ALGORITHMS 5.5).
Rgb sample_lanczos3(const ColorImage& image, const Vec2& p);
float sample_lanczos3(const ScalarImage& image, const Vec2& p);

// Area averaging when smaller, Catmull-Rom when larger. The outer edges of both pictures coincide.
ColorImage resize(const ColorImage& image, Size size);
ScalarImage resize(const ScalarImage& image, Size size);
// Nearest pixel: for masks and labels.
Mask resize_nearest(const Mask& image, Size size);
LabelImage resize_nearest(const LabelImage& image, Size size);

template <class T>
Image<T> crop(const Image<T>& image, int x0, int y0, int width, int height) {
  Image<T> out(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) out(x, y) = image.clamped(x0 + x, y0 + y);
  return out;
}

}  // namespace ramify
