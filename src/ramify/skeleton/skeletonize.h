// SPDX-License-Identifier: GPL-3.0-or-later
// From areas to lines one pixel wide. Thinning keeps the topology: as many pieces and holes as before.
#pragma once

#include "ramify/core/monitor.h"
#include "ramify/image/image.h"

namespace ramify {

// Guo & Hall 1989 (the variant of MATLAB's bwmorph and scikit-image's `thin`). Non-zero pixels are foreground, outside
// the picture is background: pad the mask first where branches leave the frame, or they fork along it (PICTURES 12.1-8).
Mask thin(const Mask& mask, const Monitor& monitor = {});

// Thinning in the order of `height`, lowest first, so that the lines run along the crests of `height` instead of the
// middle of the mask. A line's end stays only where `anchors` is non-zero; everything else that can go without changing
// the topology (8-connected lines) goes. height: any finite values; sizes must agree.
Mask thin_along_crests(const Mask& mask, const ScalarImage& height, const Mask& anchors, const Monitor& monitor = {});

// The mask with `border` more pixels on every side, copies of the nearest one; and back.
Mask padded(const Mask& mask, int border);
Mask cropped(const Mask& mask, int border);

}  // namespace ramify
