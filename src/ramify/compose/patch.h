// SPDX-License-Identifier: GPL-3.0-or-later
// A placed fragment as pixels of the canvas: the photo resampled through the placement's map.
#pragma once

#include "ramify/compose/placement.h"

namespace ramify {

enum class PatchPixel : std::uint8_t { Missing, Usable, Shadowed };  // Shadowed: an unannotated branch lies there

struct Patch {
  int left = 0, top = 0;             // px on the canvas
  ColorImage color;                  // sRGB
  ScalarImage signed_distance;       // px, of the photo's branches, negative inside
  Image<PatchPixel> state;

  bool covers(int x, int y) const { return color.contains(x - left, y - top); }
  bool usable(int x, int y) const { return covers(x, y) && state(x - left, y - top) != PatchPixel::Missing; }
  const Rgb& color_at(int x, int y) const { return color(x - left, y - top); }
  float distance_at(int x, int y) const { return signed_distance(x - left, y - top); }
};

// Lanczos-3 (bilinear loses half of the grain, ALGORITHMS 5.5), then a light unsharp mask of the given strength.
Patch warp_patch(const ColorImage& photo, const FragmentLibrary& library, const Placement& placement, Size canvas,
                 double sharpen);

}  // namespace ramify
