// SPDX-License-Identifier: GPL-3.0-or-later
// Blurs, gradients, morphology and distances. Borders are mirrored without repeating the edge pixel (BORDER_REFLECT_101).
#pragma once

#include "ramify/image/image.h"

namespace ramify {

// Gaussian blur, sigma in px; truncated at 4 sigma; sigma <= 0 copies. Wide blurs (sigma > 12) run on a reduced picture
// and are smooth to within 1/1000 of the range.
ScalarImage gaussian_blur(const ScalarImage& image, double sigma);
ColorImage gaussian_blur(const ColorImage& image, double sigma);

// Blur that ignores pixels where weight is 0 (normalised convolution); where no weight is within reach, the plain blur.
ColorImage masked_blur(const ColorImage& image, const ScalarImage& weight, double sigma);
ScalarImage masked_blur(const ScalarImage& image, const ScalarImage& weight, double sigma);

// Central differences, one-sided at the borders; unit per px.
struct Gradient {
  ScalarImage dx, dy;
};
Gradient gradient(const ScalarImage& image);

// Discs of `radius` px.
Mask dilate(const Mask& mask, double radius);
Mask erode(const Mask& mask, double radius);
// Pixels of components (8-connected) with at least `pixels` pixels.
Mask drop_small_components(const Mask& mask, int pixels);
// Holes (4-connected zero regions not touching the frame) smaller than `pixels` are filled.
Mask fill_small_holes(const Mask& mask, int pixels);
// Components numbered 0, 1, … in reading order; kNone where the mask is 0. `count` receives their number.
LabelImage label_components(const Mask& mask, bool eight_connected, int& count);

// Exact Euclidean distance (px) from every pixel to the nearest pixel where the mask is not 0 (Felzenszwalb and
// Huttenlocher 2012); infinity when there is none. O(n), parallel.
ScalarImage distance_to(const Mask& mask);

Mask invert(const Mask& mask);
Mask threshold(const ScalarImage& image, float above);  // 255 where the value is greater
double mean_of(const Mask& mask);                        // share of pixels that are not 0

}  // namespace ramify
