// SPDX-License-Identifier: GPL-3.0-or-later
// Ridge filters: where a picture has a bright or dark line, how strong, how wide, which way it runs (ALGORITHMS 3.3).
//
// At every scale sigma the Hessian of the smoothed picture gives the second derivative across the line, normalised by
// sigma^2 (Sato et al. 1998). A bar of half width w answers strongest at sigma = w. A step edge answers too, half as
// strong, beside itself: so the response is weighted by how equal the contrast is on both sides of the line.
#pragma once

#include "ramify/core/monitor.h"
#include "ramify/image/image.h"

namespace ramify {

struct RidgeOptions {
  bool bright = true;      // lines brighter than their surround; else darker
  double min_sigma = 1.0;  // px, > 0
  double max_sigma = 8.0;  // px, >= min_sigma
};

struct RidgeField {
  ScalarImage strength;  // Sato response weighted by two-sidedness, in units of the picture's contrast, >= 0
  ScalarImage sato;      // Sato response alone: does not fade at junctions
  ScalarImage sigma;     // px, scale of the strongest response: a first estimate of the half width
  VectorImage tangent;   // unit vector along the line, sign arbitrary
};

// Two scales an octave; scales above 4 px are computed on reduced pictures.
RidgeField ridge_field(const ScalarImage& picture, const RidgeOptions& options, const Monitor& monitor = {});

// Gaussian smoothing, borders mirrored; `order` 0, 1, 2 = derivative along that axis (per px, per px^2).
ScalarImage gaussian_filter(const ScalarImage& picture, double sigma, int order_x = 0, int order_y = 0);

}  // namespace ramify
