// SPDX-License-Identifier: GPL-3.0-or-later
// A plate continued beyond its frame, for canvases that reach beyond the photo. A mirror axis is what people see first in
// a picture, so that the plate is not reflected: pieces of it from elsewhere are laid on, each overlapping what is there,
// parted by the cut that shows least (Efros and Freeman 2001, "Image Quilting", section 2.1) and blended band by band
// (Burt and Adelson 1983, "A Multiresolution Spline").
#pragma once

#include <array>

#include "ramify/core/random.h"
#include "ramify/image/image.h"

namespace ramify {

// What may be laid where. Edges are left, top, right, bottom.
struct WiderPlateJob {
  Mask outside;              // 255: outside the habitat or kept; goes on as it meets the edge, so that a skyline stays one
  Mask landmark;             // 255: never shown twice
  std::array<int, 4> add{};  // px wanted beyond each edge
  // Edges that mostly lie outside the habitat (paper, the dark below a skyline) go on by reflecting so many px of theirs;
  // at least the picture's extent along that axis for the others.
  std::array<int, 4> margins{};
};

struct WiderPlate {
  int left = 0, top = 0;  // px added there: photo pixel (x, y) is at (x + left, y + top)
  ColorImage color;
  VectorImage source;     // photo pixel shown, px
};

// Of the photo's pixels only those in the sixth beside an edge with `add` > 0 may change. Where no third of the
// picture is free of landmarks and like the edge, an edge goes on by reflection, as far as a landmark. Linear in the result.
WiderPlate widen_plate(const ColorImage& plate, const WiderPlateJob& job, Rng rng);

}  // namespace ramify
