// SPDX-License-Identifier: GPL-3.0-or-later
// The courses a user has drawn, as paths or as white on black, made ready to be followed: cut to where growth can go, and
// each either a main branch or one that leaves an earlier one.
#pragma once

#include <vector>

#include "ramify/core/monitor.h"
#include "ramify/growth/ground.h"

namespace ramify {

struct DrawnCourse {
  std::vector<Vec2> path;  // px, from where the branch starts; it goes on beyond the frame where the drawing does
  int parent = kNone;      // an earlier course it leaves
};

// Longest first, but parents before children. join: px from an earlier course within which a stroke's end belongs to it;
// least: px, shorter strokes are dropped. Notes what lies where nothing can grow; throws InputError when all of it does.
std::vector<DrawnCourse> drawn_courses(const GrowthTarget& target, const Ground& ground, double join, double least,
                                       const Monitor& monitor);

}  // namespace ramify
