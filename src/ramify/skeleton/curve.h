// SPDX-License-Identifier: GPL-3.0-or-later
// The branches of a 2D skeleton as smooth curves with a vertex every pixel: what discs are laid along, and what distances
// are measured to. Clicked polylines become curves, loop ends are joined to what they touch (an end on another branch is
// no tip: PICTURES 12.1-8).
#pragma once

#include <vector>

#include "ramify/skeleton/skeleton.h"

namespace ramify {

struct BranchCurve {
  std::vector<Vec2> points;   // px, about 1 px apart, base to tip; a child starts on its parent; empty for a single node
  std::vector<double> radii;  // px, one per point
  int parent = kNone;         // curve it leaves
  int parent_vertex = kNone;  // where on it
  int rim = 0;                // first vertex outside the parent's width; 0 for a root
  bool tip = false;           // ends freely inside the canvas: not at the frame and not on another branch

  int count() const { return static_cast<int>(points.size()); }
};

struct CurveOptions {
  double smoothing = 2.5;    // px, Gaussian along the arc: takes the pixel staircase out of traced skeletons
  double join_reach = 2.0;   // an end within this many radii + 6 px of another branch ahead is joined to it; 0 = never
};

// Curve i is branch i of branch_tree(skeleton).
std::vector<BranchCurve> branch_curves(const Skeleton& skeleton, const CurveOptions& options = {});

// Point at a vertex position that may lie between vertices, or beyond an end: then straight on from it.
Vec2 point_along(const BranchCurve& curve, double vertex);
double radius_along(const BranchCurve& curve, double vertex);
// Unit tangent over 3 px on both sides.
Vec2 tangent_along(const BranchCurve& curve, double vertex);

}  // namespace ramify
