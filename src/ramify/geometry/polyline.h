// SPDX-License-Identifier: GPL-3.0-or-later
// Curves given by points in order, measured along their arc. All lengths in px, angles in rad. A polyline may have no
// point or one point, and neighbouring points may coincide; what a function does then is said beside it.
#pragma once

#include <span>
#include <vector>

#include "ramify/core/types.h"

namespace ramify {

// Arc length from the first point to every point: starts with 0, never falls, one entry per point.
std::vector<double> arc_lengths(std::span<const Vec2> points);
double polyline_length(std::span<const Vec2> points);

// Where an arc length lies: between entry `segment` and the next, at `fraction` 0..1. Clamped to the ends; needs at least
// one entry, and gives {0, 0} for one. O(log n).
struct ArcPosition {
  int segment = 0;
  double fraction = 0.0;
};
ArcPosition locate_arc(std::span<const double> arcs, double arc);

// Point and value (radius, …) at an arc length, linear in between, clamped to the ends.
Vec2 point_at_arc(std::span<const Vec2> points, std::span<const double> arcs, double arc);
double value_at_arc(std::span<const double> values, std::span<const double> arcs, double arc);

// Points with the arc length of the original polyline they were taken at, so that radii can be taken along
// (value_at_arc).
struct SampledPolyline {
  std::vector<Vec2> points;
  std::vector<double> arcs;
};

// `count` points (>= 2) at equal arc steps, both ends included.
SampledPolyline resample_count(std::span<const Vec2> points, int count);

// Equal arc steps as near to `step` (> 0) as both ends allow; at least the two ends.
SampledPolyline resample_arc(std::span<const Vec2> points, double step);

// Constant chord: every point lies exactly `chord` (> 0) from the one before, as the bending model needs it (equal arc
// steps would cut corners; ALGORITHMS 4.1). Starts at the first point; each next one is where the curve first leaves the
// circle around the last (solved in closed form). What is left at the end, shorter than a chord, is dropped.
SampledPolyline resample_chord(std::span<const Vec2> points, double chord);

// A smooth curve through all points, sampled about every `step` px: centripetal Catmull-Rom (no loops, no cusps; Yuksel
// et al. 2011). Coinciding neighbours count once. Fewer than 3 points come back as a straight line.
std::vector<Vec2> refine_polyline(std::span<const Vec2> points, double step);

// Gaussian along the arc, sigma in px, sampled at the points' own arcs. Both ends stay where they are: the curve is
// continued beyond them by reflection in the end point. sigma <= 0 changes nothing.
std::vector<Vec2> smooth_polyline(std::span<const Vec2> points, double sigma);

// The same for values along a curve, continued by mirroring (so a constant stays a constant).
std::vector<double> smooth_values(std::span<const double> values, std::span<const double> arcs, double sigma);

// Signed turn at every point from the edge before to the edge after, in (-pi, pi], positive = clockwise on the screen.
// One entry per point; 0 at both ends and where an edge has no length.
std::vector<double> turning_angles(std::span<const Vec2> points);

// Unit tangent at every point (towards the next neighbour that differs; central where there are two). Zero vectors when
// all points coincide.
std::vector<Vec2> tangents(std::span<const Vec2> points);

// Index of the point nearest to `to`, the first of several; needs at least one point.
int nearest_point(std::span<const Vec2> points, const Vec2& to);

// Indices of the points that keep the polyline within `tolerance` px (Douglas and Peucker 1973); both ends are kept.
std::vector<int> simplify_polyline(std::span<const Vec2> points, double tolerance);

}  // namespace ramify
