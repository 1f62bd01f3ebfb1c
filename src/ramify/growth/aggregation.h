// SPDX-License-Identifier: GPL-3.0-or-later
// Diffusion-limited aggregation (Witten & Sander 1981): walkers wander over a square lattice of four neighbours, one after
// the other, and stay where they first touch what is there. The reference that dendrites by paths are compared with
// (Xu & Mould 2007, figure 11).
#pragma once

#include <span>
#include <vector>

#include "ramify/core/monitor.h"
#include "ramify/core/options.h"
#include "ramify/core/random.h"
#include "ramify/skeleton/skeleton.h"

namespace ramify {

// Where walkers start. AnyNode: at any free node of the canvas, whose walls throw them back; the naive way, slow while
// little is there. Circle: around what is there, just outside; who strays leaps as far as nothing can be met, and comes
// back from far away in one draw (far_walker.h), so nobody is lost: exact in an open plane but for the lattice.
enum class WalkerLaunch { AnyNode, Circle };

struct AggregationOptions {
  int walkers = 10000;
  WalkerLaunch launch = WalkerLaunch::Circle;
};
std::vector<OptionField> describe(AggregationOptions& options);

// In the order of arrival; the seed in the middle is the first.
struct Aggregate {
  Size size;                 // px, one node a px
  std::vector<int> nodes;    // y * width + x
  std::vector<int> parents;  // index of the neighbour each one touched first (east, west, south, north); kNone for the seed
};

// At most as many walkers as the canvas has room for; Circle ends, with a note, where the canvas's edge is reached. Deterministic in (size, options, rng). Throws InputError for a canvas with a side below 3.
Aggregate grow_aggregate(Size size, const AggregationOptions& options, Rng rng, const Monitor& monitor);

// Links of one px, all of one radius (px).
Skeleton aggregate_skeleton(const Aggregate& aggregate, double radius);

// The exponent of the number of points within a distance of the middle (mass-radius dimension): the slope of its logarithm
// between 0.1 and 0.7 of the root mean square distance. Aggregates in the plane have 1.71. 0 for less than 100.
double mass_radius_dimension(std::span<const Vec2> points, const Vec2& middle);

}  // namespace ramify
