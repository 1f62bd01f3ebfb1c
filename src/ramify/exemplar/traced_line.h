// SPDX-License-Identifier: GPL-3.0-or-later
// Lines of pixels made smooth: the pixel staircase must not be learnt as style (PICTURES 10).
#pragma once

#include <vector>

#include "ramify/core/types.h"

namespace ramify {

// Points every `step` px (the last one nearer), first and last point kept. At least two points in, at least two out.
std::vector<Vec2> evenly_spaced(const std::vector<Vec2>& line, double step);

// Gaussian along the line, sigma in points; the ends stay (the line is continued by point reflection).
std::vector<Vec2> smoothed(const std::vector<Vec2>& line, double sigma);
std::vector<double> smoothed(const std::vector<double>& values, double sigma);

// Unit tangent at point i, from the points `reach` before and after it.
Vec2 tangent_at(const std::vector<Vec2>& line, int i, int reach);

}  // namespace ramify
