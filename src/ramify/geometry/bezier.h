// SPDX-License-Identifier: GPL-3.0-or-later
// Cubic Bezier curves, and few of them through many points: what a drawing program's node tool shows (Schneider 1990, "An
// algorithm for automatically fitting digitized curves", Graphics Gems).
#pragma once

#include <array>
#include <span>
#include <vector>

#include "ramify/core/types.h"

namespace ramify {

using CubicBezier = std::array<Vec2, 4>;  // px; start, two control points, end

Vec2 point_on(const CubicBezier& curve, double t);        // t in 0..1
Vec2 derivative_on(const CubicBezier& curve, double t);   // d/dt, px
CubicBezier straight_bezier(const Vec2& from, const Vec2& to);

// Where the curves of a path start and the tangent may break.
struct FitOptions {
  double tolerance = 0.15;  // px, largest distance of a point from the curves, > 0
  double corner = 0.7;      // rad; a turn at one point of more than this is a corner
};

// A chain of curves along points in order (coinciding neighbours count once): ends at the ends, smooth but at corners.
// Fewer than two different points give no curve.
std::vector<CubicBezier> fit_beziers(std::span<const Vec2> points, const FitOptions& options = {});

// The same around a closed polygon: the last curve ends where the first starts.
std::vector<CubicBezier> fit_closed_beziers(std::span<const Vec2> polygon, const FitOptions& options = {});

}  // namespace ramify
