// SPDX-License-Identifier: GPL-3.0-or-later
// The black around a round field of view: an eye's fundus, a microscope, an endoscope.
#pragma once

#include <optional>

#include "ramify/exemplar/annotation.h"
#include "ramify/image/image.h"

namespace ramify {

// An Outside region (the frame with the field as its hole) when at least three corners of the photo belong to one or more
// black areas and what these leave is one convex field. A night sky over a skyline is no surround.
std::optional<Region> dark_surround(const ColorImage& photo);

}  // namespace ramify
