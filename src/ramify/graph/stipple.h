// SPDX-License-Identifier: GPL-3.0-or-later
// Points spread over a picture by distance in a weighted graph (Mould 2007, "Stipple placement using distance in a
// weighted graph"; the endpoints of dendritic stylization): a front runs over the pixels, and wherever it has paid more
// than a threshold since the last point, it sets the next one. Points fall dense where pixels are expensive, and on edges.
#pragma once

#include <cstdint>
#include <vector>

#include "ramify/core/monitor.h"
#include "ramify/image/image.h"

namespace ramify {

struct StippleOptions {
  double jitter = 0.15;           // 0..1, random share of every edge's cost; 0 gives a lattice of diamonds on flat cost
  bool eight_connected = false;   // the paper's graph has four neighbours
  double floor = 0.02;            // cost added everywhere, so that the front pays for flat white ground too; > 0
  std::uint64_t seed = 1;
  bool keep_cost = false;         // fill Stipples::cost
};

struct Stipples {
  std::vector<int> pixels;        // y * width + x, in the order they were set; the sources are not among them
  std::vector<int> hops;          // edges from the sources to each point along the front's way
  double threshold = 0.0;         // cost between points
  ScalarImage cost;               // what the front had paid since the nearest point, at the end; -1 where it never came
};

// cost: >= 0 per pixel, an edge costs the mean of its two (finite). sources: where the front starts (indices as above);
// they count as points already set. allowed: empty, or 0 where the front may not go. Deterministic. O(n log n); a pixel
// may be visited again when a new point comes near. Throws std::invalid_argument when a source lies outside or there is
// none, or the threshold is not positive.
Stipples stipple(const ScalarImage& cost, const Mask& allowed, const std::vector<int>& sources, double threshold,
                 const StippleOptions& options, const Monitor& monitor = {});

// The same, with the threshold searched so that `count` points (>= 1) result, within 2 % where that can be had (with few
// points, or where pixels run out, the nearest count found in ten runs).
Stipples stipple_count(const ScalarImage& cost, const Mask& allowed, const std::vector<int>& sources, int count,
                       const StippleOptions& options, const Monitor& monitor = {});

}  // namespace ramify
