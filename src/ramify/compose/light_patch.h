// SPDX-License-Identifier: GPL-3.0-or-later
// One copied disc of light: sampled through its warp, freed of its surround's slope and of foreign branches, faded at
// open ends (PICTURES 12.3-5 to 10).
#pragma once

#include <cstdint>
#include <vector>

#include "ramify/compose/light_match.h"
#include "ramify/compose/light_warp.h"

namespace ramify {

// What all sources for one place share: the geometry of the new branch within the box. Row by row.
struct PatchFrame {
  PatchBox box;
  int sample = 0;                           // of the new branch, at the centre
  double radius = 1.0;                      // px, of the branch at the centre
  std::vector<StrandPoint> points;          // as seen from the new branch
  std::vector<float> distance;              // px to the centre line
  std::vector<float> window;                // 0..1, how much of the copy is laid; 0 outside the disc
  std::vector<float> fade;                  // 0..1, open ends and what would stick out behind a parent
  std::vector<Eigen::Vector2f> mirror;      // px of the box: the place across the axis
  std::vector<std::uint8_t> core;           // 1 within 1.3 r + 2 px of the line and inside the disc
  bool mirrorable = true;                   // false at sharp bends, where mirrored banks make fans
};
PatchFrame patch_frame(const Strand& target, int sample, const LightRules& rules);

struct LightPatch {
  std::vector<Rgb> value;                   // of the layer, without the window
  std::vector<Eigen::Vector2f> source;      // photo px
  SourceSpot place;                         // what it is cut from
  double cost = 0.0;                        // match cost + foreign branches in the core + unevenness
};
// fine: Lanczos for the picture, bilinear for the choice.
LightPatch cut_patch(const LightSource& source, const LightLayer& layer, const PatchFrame& frame, const Strand& target,
                     const LightMatch& match, const LightRules& rules, bool fine);

}  // namespace ramify
