// SPDX-License-Identifier: GPL-3.0-or-later
// From the traced graph to branches with parents: root, order, loops as links (ALGORITHMS 3.3-8, 3.3-9).
#pragma once

#include <vector>

#include "ramify/exemplar/annotation.h"
#include "ramify/exemplar/trace_graph.h"

namespace ramify {

struct TreeOptions {
  std::vector<Vec2> roots;     // px: the node nearest to each is a root; a component without one chooses its own
  double frame_margin = 4.0;   // px, nodes nearer than this + their radius to the frame lie on it
};

// Strokes (trace_strokes.h) hung from their roots (trace_plan.h). A component's own root is the end from which its forks
// open forwards and get thinner. What ends on another branch is linked to it. Children start at their parent's rim;
// strokes that never leave their parent are dropped. Radii must be measured. `size` is the canvas.
Annotation annotation_from_graph(const TraceGraph& graph, Size size, const TreeOptions& options);

// A stroke that is a branch of its own, from a point of an earlier one on.
struct OwnStroke {
  std::vector<Vec2> line;     // px
  std::vector<double> radii;  // px, one per point
  int parent = kNone;         // an earlier stroke; a root has none
  int parent_at = 0;          // index into the parent's line
};

// The strokes as branches: what crosses or ends near another is not joined.
Annotation annotation_from_strokes(const std::vector<OwnStroke>& strokes, Size size, const TreeOptions& options);

}  // namespace ramify
