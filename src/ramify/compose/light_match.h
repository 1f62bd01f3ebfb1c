// SPDX-License-Identifier: GPL-3.0-or-later
// Which places of the photo could be copied to a place of a new branch: alike in course, width, brightness and distance
// to the tip, with few foreign branches about.
#pragma once

#include <optional>
#include <vector>

#include "ramify/compose/light_source.h"

namespace ramify {

struct LightMatch {
  SourceSpot place;
  int spot = kNone;    // of the source, at the place or the one before it: where its use is counted
  double cost = 0.0;
};

// Sample indices of `target` at which fragments are centred: from target.first on, spaced by rules.spacing, the last one
// at the tip.
std::vector<int> fragment_centres(const Strand& target, const LightRules& rules);

// The place that lies as far behind `before` on its source as `sample` lies behind before_sample on the target: there the
// copy goes on without a seam. Empty where the source ends or offers nothing to copy. Cost as by match_light.
std::optional<LightMatch> continue_light(const LightSource& source, const Strand& target, int before_sample,
                                         const LightMatch& before, int sample, const LightRules& rules, double leave_out);

// The best rules.candidates matches for the place `sample` of `target`, best first; at least one. uses: how often each
// spot was taken so far. Sources nearer than leave_out px to the place are banned.
std::vector<LightMatch> match_light(const LightSource& source, const Strand& target, int sample,
                                    const std::vector<int>& uses, const LightRules& rules, double leave_out, Rng rng);

}  // namespace ramify
