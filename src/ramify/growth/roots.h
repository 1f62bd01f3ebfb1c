// SPDX-License-Identifier: GPL-3.0-or-later
// Where trees begin: at the user's roots, along the guide, or as the exemplar's own roots do (PICTURES 2).
#pragma once

#include "ramify/growth/growth_state.h"

namespace ramify {

// Starts and grows the root branches; returns their numbers.
std::vector<int> grow_roots(GrowthState& state);

// Starts and grows one root branch with template `source`; kNone when it finds no room at all. px, rad.
struct RootPlan {
  int source = 0;
  Vec2 position = Vec2::Zero();
  double direction = 0.0;
  std::optional<double> radius;
  std::optional<double> heading;   // of the whole branch; the direction when empty
  double length = 0.0;
  int followed = kNone;            // a course to follow instead of a heading
};
int place_root(GrowthState& state, const RootPlan& plan, Rng& rng);

// Numbers of the exemplar's root branches, longest first.
std::vector<int> root_templates(const Style& style);

}  // namespace ramify
