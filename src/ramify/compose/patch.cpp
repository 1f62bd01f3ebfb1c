// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/compose/patch.h"

#include <algorithm>
#include <cmath>

#include "ramify/core/rounding.h"
#include "ramify/image/sample.h"

namespace ramify {
namespace {

constexpr double kMargin = 3.0;  // px around the disc

// color + strength (color - blurred), blurred with the 3 x 3 Gaussian of sigma 0.7, where all nine pixels are there.
ColorImage sharpened(const Patch& patch, double strength) {
  constexpr float kSide = 0.36044779f;  // exp(-1 / (2 0.7^2))
  constexpr float kSum = (1.0f + 2.0f * kSide) * (1.0f + 2.0f * kSide);
  ColorImage result = patch.color;
  for (int y = 1; y + 1 < result.height(); ++y) {
    for (int x = 1; x + 1 < result.width(); ++x) {
      Rgb blurred;
      bool whole = true;
      for (int dy = -1; dy <= 1; ++dy) {
        for (int dx = -1; dx <= 1; ++dx) {
          whole = whole && patch.state(x + dx, y + dy) != PatchPixel::Missing;
          blurred = blurred + ((dx ? kSide : 1.0f) * (dy ? kSide : 1.0f) / kSum) * patch.color(x + dx, y + dy);
        }
      }
      if (whole) result(x, y) = patch.color(x, y) + static_cast<float>(strength) * (patch.color(x, y) - blurred);
    }
  }
  return result;
}

}  // namespace

Patch warp_patch(const ColorImage& photo, const FragmentLibrary& library, const Placement& placement, Size canvas,
                 double sharpen) {
  const double reach = placement.radius + kMargin;
  Patch patch;
  patch.left = std::max(0, static_cast<int>(std::floor(placement.centre.x() - reach)));
  patch.top = std::max(0, static_cast<int>(std::floor(placement.centre.y() - reach)));
  const int right = std::min(canvas.width - 1, static_cast<int>(std::ceil(placement.centre.x() + reach)));
  const int bottom = std::min(canvas.height - 1, static_cast<int>(std::ceil(placement.centre.y() + reach)));
  const Size size{std::max(0, right - patch.left + 1), std::max(0, bottom - patch.top + 1)};
  patch.color = ColorImage(size);
  patch.signed_distance = ScalarImage(size, 99.0f);
  patch.state = Image<PatchPixel>(size, PatchPixel::Missing);
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      const Vec2 p(patch.left + x, patch.top + y);
      if ((p - placement.centre).norm() > reach) continue;
      const Vec2 q = placement.photo_from_canvas(p);
      const int u = round_to_int(q.x()), v = round_to_int(q.y());
      if (!photo.contains(u, v) || library.unusable(u, v)) continue;
      patch.color(x, y) = sample_lanczos3(photo, q);
      patch.signed_distance(x, y) = sample_bilinear(library.field.signed_distance, q);
      patch.state(x, y) = library.shadow(u, v) ? PatchPixel::Shadowed : PatchPixel::Usable;
    }
  }
  if (sharpen > 0.0) patch.color = sharpened(patch, sharpen);
  return patch;
}

}  // namespace ramify
