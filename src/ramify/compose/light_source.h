// SPDX-License-Identifier: GPL-3.0-or-later
// The photo's branches as places to copy light from.
#pragma once

#include <vector>

#include "ramify/compose/light_layer.h"
#include "ramify/compose/light_rules.h"
#include "ramify/compose/light_strand.h"

namespace ramify {

// A place on a source strand, seen as it is or in a mirror.
struct SourceSpot {
  int strand = kNone;
  int sample = 0;
  bool mirrored = false;   // x reversed before turning
  double penalty = 0.0;    // cost of a place that would bring something along (bright surround of a thin branch)
};

struct LightSource {
  std::vector<Strand> strands;    // re-centred on the layer, with level and bad set
  LabelImage labels;              // 1 + strand, kForeignLabel on unannotated branches, 0 elsewhere
  ScalarImage cover;              // 0..1, softened: branches of any kind
  std::vector<SourceSpot> spots;
  double weakest = 0.0;           // level below which a stretch of branch is not copied

  const Strand& strand_of(const SourceSpot& spot) const { return strands[spot.strand]; }
  Vec2 position(const SourceSpot& spot) const { return strands[spot.strand].points[spot.sample]; }
};
inline constexpr int kForeignLabel = 1 << 20;

// shadow: 255 on branch-like things that are not annotated (may be empty); unusable: 255 where nothing may be copied
// from (may be empty). Throws InputError when no place is left.
LightSource make_light_source(std::vector<Strand> strands, const LightLayer& layer, const Mask& shadow,
                              const Mask& unusable, const LightRules& rules);

}  // namespace ramify
