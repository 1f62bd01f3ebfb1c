// SPDX-License-Identifier: GPL-3.0-or-later
// Watercolour in pixels: what a wash of pigment takes from the light that the paper throws back. Pigment dries darker along
// the rim of a wash, settles in the hollows of the paper and drifts while it is wet (Curtis et al. 1997, "Computer-generated
// watercolor"; Bousseau et al. 2006). Private to this layer.
#pragma once

#include <cstdint>

#include "ramify/core/monitor.h"
#include "ramify/image/image.h"

namespace ramify {

// A wet layer on the canvas: colours multiplied by opacity, and opacity.
struct WetLayer {
  ColorImage color;
  ScalarImage alpha;
  double bleeding = 1.5;  // px of the canvas: how far water carries pigment
};

// Where a picture's pixels lie on the canvas: paper and drift are the canvas's, so every size shows the same.
struct PaperView {
  double scale = 1.0;             // picture px per canvas px
  Vec2 shift = Vec2::Zero();      // px of the picture: where the canvas's corner lies
};

// Optical density (natural logarithm of paper to reflected light, encoded values) for every pixel, 0 = bare paper.
// The same for any number of threads.
ColorImage optical_density(const WetLayer& layer, const PaperView& view, const Monitor& monitor);

}  // namespace ramify
