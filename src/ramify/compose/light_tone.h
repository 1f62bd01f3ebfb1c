// SPDX-License-Identifier: GPL-3.0-or-later
// Brightness and colour along branches of light: which brightness a new branch is given, what colour the photo's light
// has at each brightness, and by how much a copy is changed to agree with both (PICTURES 12.3-9).
#pragma once

#include <vector>

#include "ramify/compose/light_source.h"
#include "ramify/core/random.h"

namespace ramify {

// Marks stretches bad whose colour is not the one the photo's branches have at that brightness: errors of the plate
// behind them (a bright cloud), or another thing.
void mark_odd_colours(std::vector<Strand>& strands);

// Gives every target strand a level: each takes the course of the brightness along the source strand most like it in
// radius and length, in the colour the photo has at that brightness, and near open ends at the brightness left by the
// fade (tip_fade of the rules). No child starts brighter than its parent is there.
void assign_levels(std::vector<Strand>& targets, const LightSource& source, double tip_fade, Rng rng);

// Factors per channel for the samples of a target round one of its places.
struct ToneGain {
  int first = 0;  // target sample of gains[0]
  std::vector<Vec3> gains;
  const Vec3& at(double along) const;
};
// Brings the level of the source, whose place lies on the target's sample, near the target's, over `reach` samples.
ToneGain tone_gain(const Strand& source, int place, const Strand& target, int sample, int reach);

}  // namespace ramify
