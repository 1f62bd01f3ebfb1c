// SPDX-License-Identifier: GPL-3.0-or-later
// Branches that are sent somewhere: to a place that lacks one, or along a course.
#pragma once

#include <functional>

#include "ramify/growth/growth_state.h"

namespace ramify {

struct Errand {
  int parent = kNone;        // branch
  int node = 0;              // of the parent, where it leaves
  Vec2 goal = Vec2::Zero();  // px; a place it heads for, or one its course passes soon
  double length = 0.0;       // px, wanted; templates of about that length are taken
  double most_length = 0.0;  // px
  int followed = kNone;      // a course to follow
};

// The node, of a branch below most_order, that a child could leave from for the goal at the least cost below `most`;
// the parent is kNone when there is none. cost(branch, node, way to the goal, its length): px, at least the length;
// allowed(node's place): looked at last.
Errand cheapest_start(const GrowthState& state, const Vec2& goal, int most_order, double most,
                      const std::function<double(const GrowingBranch&, int, const Vec2&, double)>& cost,
                      const std::function<bool(const Vec2&)>& allowed);

// Sends a child with one of the best fitting templates; returns its number, or kNone when there is no room for any.
int send_branch(GrowthState& state, const Errand& errand, Rng& rng);

// Sends a child along a course from one of the parent's nodes nearest to the course's start; kNone when none has room.
int send_along(GrowthState& state, int course, int parent, Rng& rng);

}  // namespace ramify
