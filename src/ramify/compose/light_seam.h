// SPDX-License-Identifier: GPL-3.0-or-later
// How consecutive copies along a branch are chosen to fit each other, and the line on which one gives way to the next.
#pragma once

#include <vector>

#include "ramify/compose/light_patch.h"

namespace ramify {

// For every place the index of the source to take, so that the sum of the patches' costs and of the differences between
// neighbours (shape of the light in the overlap, and its hue) is least. Exact, by dynamic programming.
std::vector<int> choose_chain(const std::vector<PatchFrame>& frames, const std::vector<std::vector<LightPatch>>& patches,
                              const LightRules& rules);

// A line across the branch between two neighbouring places, bent to where their copies differ least.
struct LightSeam {
  Vec2 middle = Vec2::Zero();   // px
  Vec2 axis = Vec2::UnitX();    // from the first place to the second
  int half_length = 0;          // px across
  std::vector<double> path;     // px along the axis, for each px across from -half_length to half_length
  // Share of the second patch at p: 0 before the seam, 1 behind it, over 0.6 px.
  double second_share(const Vec2& p) const;
};
LightSeam find_seam(const PatchFrame& first, const LightPatch& first_patch, const PatchFrame& second,
                    const LightPatch& second_patch);

}  // namespace ramify
