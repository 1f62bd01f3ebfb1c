// SPDX-License-Identifier: GPL-3.0-or-later
// A branch while it grows, and the step it grows by.
#pragma once

#include <optional>
#include <vector>

#include "ramify/core/types.h"
#include "ramify/skeleton/skeleton.h"

namespace ramify {

enum class GrowthStop {
  None,   // still growing, or as long as intended
  Frame,  // left the canvas or entered an outside region: ends at full width
  Join,   // ends on another branch
  Stuck   // found no way on
};

struct Fork {
  int node = 0;
  int side = 0;  // +1 clockwise of the parent's direction, -1 the other way
};

struct GrowingBranch {
  int source = 0;                 // template: a branch of the exemplar
  bool mirrored = false;          // the template is used mirrored
  int parent = kNone;             // an earlier branch
  int parent_node = kNone;        // where it leaves, counted along the parent
  int order = 0;
  std::vector<Vec2> points;       // px; a child starts at its parent's rim
  std::vector<double> radii;      // px
  std::vector<double> turns;      // rad, turn at every point; 0 at the first, and at the last until it grows on
  std::vector<int> copied;        // exemplar vertex + 1 of every point, negative when mirrored, 0 = none
  double start_direction = 0.0;   // rad
  double length = 0.0;            // px, intended
  double radius_scale = 1.0;      // of the template's profile
  double most_radius = 1e9;       // px: a child never grows thicker than its parent is where it leaves
  std::optional<double> heading;  // rad, intended direction of its chord
  double course = 0.0;            // 0 = straight along the heading, 1 = bending at large as the template does
  int followed = kNone;           // the course it follows, or none
  bool joins = false;             // it is to end on another branch, as its template does
  GrowthStop stop = GrowthStop::None;
  std::vector<Fork> forks;        // where children leave, in the order they were placed
  bool grown = true;              // false once taken back

  int count() const { return static_cast<int>(points.size()); }
  double arc(double step) const { return (count() - 1) * step; }  // px grown so far
};

struct Extension {
  std::vector<Vec2> points;    // px
  std::vector<double> radii;   // px
  std::vector<double> turns;   // rad, at the node before each point
  std::vector<int> copied;
  GrowthStop stop = GrowthStop::None;
};

// Direction of the edge that ends at node `at` (> 0), or the start direction for node 0; rad.
double direction_at(const GrowingBranch& branch, int at);

// All grown branches as one skeleton: parents before children, the continuation of a branch before its children.
Skeleton skeleton_from(const std::vector<GrowingBranch>& branches, Size size);

}  // namespace ramify
