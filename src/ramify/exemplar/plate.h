// SPDX-License-Identifier: GPL-3.0-or-later
// The branch-free plate: the photo as if its branches had never been there (PICTURES 7, 12.1-1, 12.3-1). New branches
// are laid on it or on what is made from it, and the light that branches give or take is measured against it.
#pragma once

#include "ramify/core/monitor.h"
#include "ramify/core/random.h"
#include "ramify/exemplar/exemplar.h"
#include "ramify/exemplar/habitat.h"

namespace ramify {

enum class PlateKind {
  Thin,  // branches are covered: a hole a little wider than each, filled with the ground's texture
  Halo,  // branches shine: their glow reaches far beyond them and is taken out as well
};

struct Plate {
  ColorImage color;    // photo size
  Mask hole;           // 255: filled anew
  Mask halo;           // Halo: 255 where only the slow tones were replaced; empty for Thin
  VectorImage source;  // photo pixel whose texture every pixel shows; NaN where it was filled smoothly
};

// Throws InputError when branches and masks leave nothing to copy.
Plate make_plate(const Exemplar& exemplar, const Habitat& habitat, PlateKind kind, Rng rng, const Monitor& monitor);

}  // namespace ramify
