// SPDX-License-Identifier: GPL-3.0-or-later
// Cheapest path between two pixels of a picture, for the live wire: whole costs, dearer across a preferred direction
// (ALGORITHMS 3.1, 8.3). The same search as plan.h's, on a box.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "ramify/core/monitor.h"
#include "ramify/image/image.h"

namespace ramify {

struct Pixel {
  int x = 0, y = 0;
  friend bool operator==(const Pixel&, const Pixel&) = default;
};

struct LatticeCosts {
  Image<std::uint16_t> cost;  // 1 … 4095 per px of way through the pixel; 0 = forbidden
  VectorImage tangent;        // preferred direction, unit, sign arbitrary; empty = none
  double turn_weight = 1.0;   // an edge across the tangent costs 1 + turn_weight times as much
};

struct PixelBox {
  int left = 0, top = 0, right = 0, bottom = 0;  // inclusive
};

struct CheapestPath {
  std::vector<Pixel> pixels;   // from start to target, 8-connected
  std::uint64_t cost = 0;      // sum over edges of length x mean cost x turn factor
  bool touches_rim = false;    // runs along the box's rim: a larger box may give a cheaper path
};

// Dijkstra with a bucket queue inside `box` (clipped to the picture); stops when a target settles. Ties are broken by
// pixel index, so the path is unique. No value when no target can be reached. Throws std::invalid_argument when
// start or all targets lie outside.
std::optional<CheapestPath> cheapest_path(const LatticeCosts& costs, Pixel start, const std::vector<Pixel>& targets,
                                          PixelBox box, const Monitor& monitor = {});

}  // namespace ramify
