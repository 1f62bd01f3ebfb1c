// SPDX-License-Identifier: GPL-3.0-or-later
// Where the pixels round a place of a new branch come from: from as far along the source branch and as far across it.
// So widths and courses agree without a solver, nothing folds, and neighbouring places of one source meet exactly.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "ramify/compose/light_source.h"

namespace ramify {

// Pixels [x0, x0 + size) x [y0, y0 + size) of the new picture round a target sample.
struct PatchBox {
  int x0 = 0, y0 = 0, size = 0;
  Vec2 centre = Vec2::Zero();  // px, the target sample
  double s = 0.0;              // px, radius of the disc
};
PatchBox patch_box(const Strand& target, int sample, const LightRules& rules);

// A pixel seen from a strand.
struct StrandPoint {
  float along = 0.0f;   // samples from the strand's base, not rounded; beyond the ends measured along the tangent
  float across = 0.0f;  // px from the centre line, positive on the normals' side
};

// p as seen from the samples [from, to) of the strand.
StrandPoint locate(const Strand& strand, const Vec2& p, int from, int to);

// Photo position (px) of every one of `points`, when the target's sample lies on the source's place. Across the branch the
// source is scaled to the target's width within its edges and only shifted outside of them.
std::vector<Eigen::Vector2f> photo_from_strand(const LightSource& source, const SourceSpot& place, const Strand& target,
                                               int sample, const std::vector<StrandPoint>& points);

}  // namespace ramify
