// SPDX-License-Identifier: GPL-3.0-or-later
// Which places of the photo could be copied to a place of a new branch: alike in course, width, brightness and distance
// to the tip, with few foreign branches about.
#pragma once

#include <vector>

#include "ramify/compose/light_source.h"

namespace ramify {

struct LightMatch {
  int spot = kNone;
  double angle = 0.0;  // rad; the source, mirrored if the spot says so, is turned by this about its place
  double gain = 1.0;   // brings the source's level near the one the branch has there
  double cost = 0.0;
};

// Sample indices of `target` at which fragments are centred: from target.first on, spaced by rules.spacing, the last one
// at the tip.
std::vector<int> fragment_centres(const Strand& target, const LightRules& rules);

// The best rules.candidates matches for the place `sample` of `target`, best first; at least one. uses: how often each
// spot was taken so far. Sources nearer than leave_out px to the place are banned.
std::vector<LightMatch> match_light(const LightSource& source, const Strand& target, int sample,
                                    const std::vector<int>& uses, const LightRules& rules, double leave_out, Rng rng);

}  // namespace ramify
