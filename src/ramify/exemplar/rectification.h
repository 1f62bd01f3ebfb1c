// SPDX-License-Identifier: GPL-3.0-or-later
// Taking the perspective out of a photo of something flat, and putting it back into the result (fig. 8 of the paper).
#pragma once

#include <array>

#include "ramify/core/monitor.h"
#include "ramify/geometry/homography.h"
#include "ramify/image/image.h"

namespace ramify {

struct Warped {
  ColorImage color;
  Mask valid;  // 255 where the source covers the pixel whole, less at its rim, 0 outside
};

struct Rectification {
  Homography rectified_from_photo = Homography::Identity();
  Size size;  // px, of the rectified picture
};

// corners: the picture's top left, top right, bottom right, bottom left in the photo, px. The rectified size keeps the
// longer of opposite sides. Throws InputError for a degenerate quadrilateral, LimitError when the result would have more
// than `pixel_limit` pixels.
Rectification rectification_from_corners(const std::array<Vec2, 4>& corners, double pixel_limit = 256e6);

// Every target pixel is the mean of n x n Lanczos samples of the source, n chosen from how much the map shrinks there
// (1 … 8), so that nothing aliases. `target_from_source` maps source px to target px.
Warped warp_picture(const ColorImage& source, const Mask& alpha, const Homography& target_from_source, Size target,
                    const Monitor& monitor = {});

// The photo with the finished rectified picture laid over it in the photo's perspective.
ColorImage distort_back(const ColorImage& photo, const ColorImage& rectified, const Homography& rectified_from_photo,
                        const Monitor& monitor = {});

}  // namespace ramify
