// SPDX-License-Identifier: GPL-3.0-or-later
// Everything a growth run knows while it runs.
#pragma once

#include "ramify/growth/coverage.h"
#include "ramify/growth/guide.h"
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

  double spread() const { return 0.5 * style.hierarchy.spacing; }  // rho, px
  bool full() const { return grown_length >= wanted_length; }

  const Style& style;
  const GrowthTarget& target;
  const GrowOptions& options;
  const Monitor& monitor;
  Rng rng;
  Ground ground;
  Guide guide;
  Coverage coverage;
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
