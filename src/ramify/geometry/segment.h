// SPDX-License-Identifier: GPL-3.0-or-later
// Straight segments: distances, and intersection tests whose answers are exact for the doubles given.
#pragma once

#include "ramify/core/types.h"

namespace ramify {

// Sign of the area of the triangle a, b, c: +1 when c lies clockwise (on the screen) of the line from a to b, -1 on the
// other side, 0 exactly on it. Exact for all doubles whose products neither overflow nor underflow (Shewchuk 1997).
int orientation(const Vec2& a, const Vec2& b, const Vec2& c);

struct PointOnSegment {
  double distance = 0.0;  // px
  double fraction = 0.0;  // 0 at a … 1 at b, of the nearest point
};
PointOnSegment nearest_on_segment(const Vec2& point, const Vec2& a, const Vec2& b);

enum class SegmentRelation {
  Apart,    // no common point
  Touching, // a common point, but an end of one lies on the other (or they overlap along a line)
  Crossing  // each has its ends strictly on both sides of the other
};
SegmentRelation segment_relation(const Vec2& a, const Vec2& b, const Vec2& c, const Vec2& d);

// Smallest distance between the segments ab and cd; 0 exactly when they have a common point.
double segment_distance(const Vec2& a, const Vec2& b, const Vec2& c, const Vec2& d);

// Where crossing segments cross: the fraction along ab. Only for segment_relation == Crossing.
double crossing_fraction(const Vec2& a, const Vec2& b, const Vec2& c, const Vec2& d);

}  // namespace ramify
