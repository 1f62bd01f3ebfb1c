// SPDX-License-Identifier: GPL-3.0-or-later
// Photographs made by ramify itself, with exact truth: the built-in exemplars (builtin:KIND), the measure of tracing and
// rendering, and the pictures of the manual (ALGORITHMS 3.4).
#pragma once

#include <string>
#include <vector>

#include "ramify/core/monitor.h"
#include "ramify/core/random.h"
#include "ramify/exemplar/exemplar.h"

namespace ramify {

enum class SyntheticKind { Lightning, River, Crack, Vein, Vessel };

// Names in the order of the enum: lightning, river, crack, vein, vessel.
const std::vector<std::string>& synthetic_kind_names();
// Throws InputError listing the kinds.
SyntheticKind synthetic_kind(const std::string& name);
// The size the kind is made for.
Size natural_size(SyntheticKind kind);

struct SyntheticExemplar {
  Photo photo;              // 8-bit values, sRGB; name "builtin:KIND"
  Annotation annotation;    // every branch, with radii; polarity set; regions where the kind has some
  Skeleton skeleton;        // the same branches
  Mask branch_mask;         // exact share of every pixel inside the branches, 0 … 255 (skeleton/draw.h)
  Vec3 light = {0, 0, 1};   // unit vector towards the light, x right, y down, z towards the camera
};

// Width and height 64 … 16384 px; branch widths keep the proportions of the natural size. Deterministic for any number
// of threads. Throws OptionError for other sizes.
SyntheticExemplar make_synthetic(SyntheticKind kind, Size size, const Rng& rng, const Monitor& monitor);

}  // namespace ramify
