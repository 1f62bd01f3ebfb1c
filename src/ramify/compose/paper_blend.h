// SPDX-License-Identifier: GPL-3.0-or-later
// Blending as paper 002 does it (section 5.3, figure 5), for comparison: fragment after fragment, each corrected to meet
// those before it.
#pragma once

#include "ramify/compose/paste_cost.h"

namespace ramify {

// picture: every pixel in its owner's own colour. Along the rim that touches earlier fragments a fragment takes their
// colours; where it touches nothing yet its own colours are held - or, with free_rims, nothing is said, and the colours
// drift from fragment to fragment. The background stays as it is.
ColorImage blend_in_order(const PasteCost& cost, const LabelImage& owner, const ColorImage& picture, bool free_rims,
                          const Monitor& monitor);

}  // namespace ramify
