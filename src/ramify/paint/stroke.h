// SPDX-License-Identifier: GPL-3.0-or-later
// The branches of a skeleton as a pen would draw them: smooth centre lines with widths that taper to the tips, side
// branches that leave along their parent and widen into it, and for every point the length of the way from the root, so
// that a drawing can grow.
#pragma once

#include <vector>

#include "ramify/skeleton/skeleton.h"

namespace ramify {

struct Stroke {
  std::vector<Vec2> points;    // px, about `step` apart, base to tip; at least one
  std::vector<double> radii;   // px, half the width, one per point
  std::vector<double> births;  // px along the way from the root, one per point; never falls
  int order = 0;               // 0 = a main branch
  int parent = kNone;          // stroke it leaves; its index is smaller
  int parent_vertex = kNone;   // where on it
  int rim = 0;                 // first vertex outside the parent's body; 0 for a root
  bool tip = false;            // ends freely: tapers
};

struct StrokeOptions {
  double smoothing = 3.0;  // px, Gaussian along the centre line, >= 0
  double width = 1.0;      // factor on all radii, > 0
  double thinnest = 0.35;  // px, least radius before tapering, > 0
  double taper = 0.7;      // 0 = blunt tips as wide as the skeleton says, 1 = long fine points
  double flow = 0.6;       // 0 = side branches start as the skeleton says, 1 = along their parent, widening into it
};

// Stroke i is branch i of branch_tree(skeleton).
std::vector<Stroke> make_strokes(const Skeleton& skeleton, const StrokeOptions& options = {});

// The longest way from a root, px.
double growth_reach(const std::vector<Stroke>& strokes);

// What has grown when the front is `front` px away from the roots: points beyond are cut, points behind it have ripened
// over `ripening` px of the front's way. A stroke not yet born has no points.
std::vector<Stroke> grown_strokes(const std::vector<Stroke>& strokes, double front, double ripening);

// The closed outline of a stroke, by discs along the centre line: exact for the discs at the points, smooth in between,
// round at both ends. `grow` px are added to every radius. One polygon; inner sides of bends tighter than the stroke is
// wide are cut, so that it can be filled by the non-zero rule.
std::vector<Vec2> stroke_outline(const Stroke& stroke, double grow = 0.0);

}  // namespace ramify
