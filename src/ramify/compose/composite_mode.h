// SPDX-License-Identifier: GPL-3.0-or-later
// Light or paste? (PICTURES 6) What shines or only darkens a smooth ground is copied as light; everything that has an edge
// and a surface of its own is pasted.
#pragma once

#include "ramify/compose/compose.h"
#include "ramify/exemplar/fragment.h"

namespace ramify {

struct BranchLook {
  double contrast = 0.0;   // luma of the branches' cores minus that of the ground beside them; positive = brighter
  double ground = 0.0;     // 0..1, median luma of the ground beside the branches
  double roughness = 0.0;  // grain and texture of the ground (high-pass deviation, sigma 6 px) relative to the contrast
  double radius = 0.0;     // px, median along the branches
};
BranchLook measure_branch_look(const ColorImage& photo, const FragmentLibrary& library);

// Emit, Absorb or Paste, by polarity Glow or by the look.
CompositeMode choose_composite_mode(const Exemplar& exemplar, const FragmentLibrary& library);

}  // namespace ramify
