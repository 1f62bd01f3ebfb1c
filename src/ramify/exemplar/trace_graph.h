// SPDX-License-Identifier: GPL-3.0-or-later
// The traced lines as a graph: junctions and ends as nodes, pixel chains as edges (ALGORITHMS 3.3-5, 3.3-6).
#pragma once

#include <vector>

#include "ramify/core/types.h"
#include "ramify/image/image.h"

namespace ramify {

struct TraceEdge {
  int from = kNone, to = kNone;  // nodes; equal for a closed ring
  std::vector<Vec2> line;        // px, from node to node, both included
  std::vector<double> radii;     // px, one per point; empty until measured
  double confidence = 1.0;       // 0..1
  double strength = 0.0;         // mean ridge strength along it
};

struct TraceGraph {
  std::vector<Vec2> nodes;  // px
  std::vector<TraceEdge> edges;

  std::vector<std::vector<int>> edges_of_nodes() const;  // a ring counts twice
};

double line_length(const std::vector<Vec2>& line);

// Lines one pixel wide, 8-connected. Touching junction pixels become one node at their centroid; a closed ring gets an
// artificial node; single pixels are dropped.
TraceGraph graph_from_lines(const Mask& lines);

struct PruneOptions {
  double spur_factor = 1.5;     // spurs shorter than spur_factor x radius at the junction + spur_length go
  double spur_length = 5.0;     // px
  double weak_spur = 0.0;       // px, limit for spurs that are not sure: weak_spur x 2 x (1 - confidence)
  double min_component = 20.0;  // px, components with less line in total go
  double merge_factor = 0.7;    // junctions closer than merge_factor x (r1 + r2) become one
};

// radius: px, about how thick the branch at a pixel is. Shortest spurs first; nodes left with two edges are dissolved.
TraceGraph pruned(TraceGraph graph, const ScalarImage& radius, const PruneOptions& options);

// Joins the two edges at every node of degree two.
TraceGraph without_passing_nodes(const TraceGraph& graph);

}  // namespace ramify
