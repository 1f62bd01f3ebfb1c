// SPDX-License-Identifier: GPL-3.0-or-later
// Pictures from wanted gradients (Pérez et al. 2003, "Poisson image editing"), without drift.
//
// Gradients live between pixels: right(x, y) is the wanted u(x+1, y) - u(x, y), down(x, y) the wanted u(x, y+1) - u(x, y).
// The last column of `right` and the last row of `down` are not read.
#pragma once

#include "ramify/core/monitor.h"
#include "ramify/image/image.h"

namespace ramify {

struct ColorGradients {
  ColorImage right, down;
};

// The gradients a picture has.
ColorGradients gradients_of(const ColorImage& picture);

// Minimises sum (grad u - g)^2 + lambda sum (u - target)^2 over the whole rectangle, with natural borders: one cosine
// transform per channel, exact (Bhat et al. 2008). lambda > 0; the pull towards the target acts over about
// 1/sqrt(lambda) px. One solve over all pixels: nothing depends on an order, so no colour drifts along a branch.
ColorImage solve_screened_poisson(const ColorImage& target, const ColorGradients& wanted, double lambda,
                                  const Monitor& monitor);

// In the mask `unknown` of the solvers below: pixels that are no part of the domain; nothing is said about steps to them.
inline constexpr std::uint8_t kAbsentPixel = 128;

// Changes only the pixels where `unknown` is 255: minimises sum (grad u - g)^2 over all pairs of neighbours of which at
// least one is unknown; known pixels (0) are the border values, picture borders are natural. For holes that are small or
// thin (sparse Cholesky); larger ones are solved from coarse to fine by conjugate gradients. Unknown pixels without any
// known neighbour in their region keep their mean.
ColorImage solve_poisson(const ColorImage& picture, const Mask& unknown, const ColorGradients& wanted,
                         const Monitor& monitor);

// The smoothest filling: solve_poisson with gradients 0.
ColorImage fill_membrane(const ColorImage& picture, const Mask& unknown, const Monitor& monitor);
ScalarImage fill_membrane(const ScalarImage& picture, const Mask& unknown, const Monitor& monitor);

}  // namespace ramify
