// SPDX-License-Identifier: GPL-3.0-or-later
// Branches that are sent somewhere: to a place that lacks one, or along a course.
#pragma once

#include "ramify/growth/growth_state.h"

namespace ramify {

struct Errand {
  int parent = kNone;       // branch
  int node = 0;             // of the parent, where it leaves
  Vec2 goal = Vec2::Zero(); // px; a place it heads for, or one its course passes soon
  double length = 0.0;      // px, wanted; templates of about that length are taken
  double most_length = 0.0; // px
  int followed = kNone;     // a course to follow
};

// Sends a child with one of the best fitting templates; returns its number, or kNone when there is no room for any.
int send_branch(GrowthState& state, const Errand& errand, Rng& rng);

// Sends a child along a course from one of the parent's nodes nearest to the course's start; kNone when none has room.
int send_along(GrowthState& state, int course, int parent, Rng& rng);

}  // namespace ramify
