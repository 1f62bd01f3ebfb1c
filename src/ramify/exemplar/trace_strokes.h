// SPDX-License-Identifier: GPL-3.0-or-later
// Traced edges joined to strokes: at every junction the two ends that go straightest on belong together, so that a
// crossing is two lines passing and a T is one line met by another. Order and hierarchy are then those of whole strokes
// and not of a spanning tree's pieces.
#pragma once

#include <vector>

#include "ramify/exemplar/trace_graph.h"

namespace ramify {

struct TraceStroke {
  std::vector<int> nodes;      // graph nodes passed, both ends included
  std::vector<int> at;         // index into `line` of each of them
  std::vector<Vec2> line;      // px
  std::vector<double> radii;   // px
  double confidence = 0.0;     // mean over the length
};

// Edges must be measured. No stroke passes through the nodes listed in `stops`.
std::vector<TraceStroke> strokes_of(const TraceGraph& graph, const std::vector<int>& stops);

// Unit direction in which the stroke goes on from point `at`, towards its end (sign +1) or its start (-1), and its radius
// there (px): both looked at beyond the radius at `at`, so that the stretch inside another branch does not count.
Vec2 heading(const TraceStroke& stroke, int at, int sign);
double clear_radius(const TraceStroke& stroke, int at, int sign);

}  // namespace ramify
