// SPDX-License-Identifier: GPL-3.0-or-later
// How wide a branch is at every point of its centre line, and where its middle really runs (ALGORITHMS 3.2).
//
// The paper takes the strongest gradient across the branch, which jumps to other banks and shadows. Here a branch is a
// pair of opposite edges, and one pair per point is chosen for the whole branch at once by dynamic programming. Glowing
// branches have no edges: their radius is where the light has fallen to half.
#pragma once

#include <vector>

#include "ramify/core/types.h"
#include "ramify/image/image.h"

namespace ramify {

struct WidthProbeOptions {
  bool bright = true;         // branch brighter than its surround
  bool glow = false;          // half contrast instead of edge pairs
  double blur = 0.5;          // px, blur of the photo: thin bars look wider than they are by it
  double max_radius = 100.0;  // px
};

struct ProbedLine {
  std::vector<Vec2> points;        // px, re-centred
  std::vector<double> radii;       // px
  std::vector<double> confidence;  // 0 where the radius had to be interpolated, else 0..1
};

// line: points about 1 px apart; prior: px, first estimates of the radius, one per point. Two rounds: the second starts
// from the first's middle and radius.
ProbedLine probe_widths(const ScalarImage& picture, const std::vector<Vec2>& line, const std::vector<double>& prior,
                        const WidthProbeOptions& options);

// Half the true width of a bar whose edges, after smoothing by sigma px in total, appear at +-apparent px.
double bar_radius(double apparent, double sigma);

}  // namespace ramify
