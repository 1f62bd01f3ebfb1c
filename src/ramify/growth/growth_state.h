// SPDX-License-Identifier: GPL-3.0-or-later
// Everything a growth run knows while it runs.
#pragma once

#include "ramify/growth/course.h"
#include "ramify/growth/coverage.h"
#include "ramify/growth/demand.h"
#include "ramify/growth/drawn_courses.h"
#include "ramify/growth/occupancy.h"
#include "ramify/growth/window_matcher.h"

namespace ramify {

struct GrowthState {
  GrowthState(const Style& style, const GrowthTarget& target, const GrowOptions& options, Rng rng, const Monitor& monitor);

  // Puts an extension at the tip of branch `number`.
  void commit(int number, const Extension& extension);
  // Takes back the last `count` nodes of the branch grown last, never its first.
  void step_back(int number, int count);
  // Takes back the branch started last, wholly.
  void take_back(int number);
  // Books a branch that has its first node; returns its number.
  int start(const GrowingBranch& branch);
  // +1 when a child with this template leaves clockwise, else -1.
  int side_of(int source, bool mirrored) const;
  // The template profile's radius at an arc length, px.
  double template_radius(const GrowingBranch& branch, double arc) const;

  // Half of rho, px: over it D falls (half, because the clear space counts from rims).
  double spread() const { return 0.5 * spacing; }
  // What is wanted at the point and not there yet, 0..1; 0 off the canvas.
  double unfilled(const Vec2& point) const { return ground.painted() ? demand.unfilled(point) : coverage.unfilled(point); }
  // Px a branch has come along the course it follows.
  double progress(const GrowingBranch& branch) const;
  // Whether most of the exemplar's length lies in branches that end on others: its free ends are accidents of what was
  // annotated, and every end runs on until it meets something.
  bool net() const { return nets; }
  bool full() const { return grown_length >= wanted_length; }
  int forks() const;
  std::vector<int> twigs() const;  // the exemplar's children from the shortest, the shorter half
  double left_for_twigs() const;   // px that may still grow, less what the twigs need that are missing; <= 0 = none
  double wanted_forks() const;  // for what has grown, at the exemplar's rate

  const Style& style;
  const GrowthTarget& target;
  const GrowOptions& options;
  const Monitor& monitor;
  Rng rng;
  Ground ground;
  std::vector<DrawnCourse> drawn;
  std::vector<Course> courses;      // the drawn ones, then those laid out to reach painted places
  double spacing;                   // rho, px from a branch to halfway to its neighbour
  bool nets = false;
  bool twigs_added = false;         // what is left may be filled
  double crowding = 1.0;            // length per area in the exemplar over what paint asks for, at most 1
  Coverage coverage;
  Demand demand;                    // empty without a painted map
  Occupancy occupancy;
  WindowMatcher matcher;
  std::vector<GrowingBranch> branches;
  Histogram angles;                 // of what has grown, over the exemplar's ranges
  Histogram radii;
  std::vector<int> window_uses;     // per exemplar vertex
  std::vector<int> template_uses;   // per exemplar branch
  double grown_length = 0.0;        // px
  double wanted_length = 0.0;       // px
};

}  // namespace ramify
