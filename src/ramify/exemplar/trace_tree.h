// SPDX-License-Identifier: GPL-3.0-or-later
// From the traced graph to branches with parents: root, order, loops as links (ALGORITHMS 3.3-8, 3.3-9).
#pragma once

#include <optional>

#include "ramify/exemplar/annotation.h"
#include "ramify/exemplar/trace_graph.h"

namespace ramify {

struct TreeOptions {
  std::optional<Vec2> root;    // px: the root of its component is the node nearest to it
  double frame_margin = 4.0;   // px, nodes nearer than this + their radius to the frame lie on it
};

// One tree per component. A component's root is the end from which its forks open forwards and get thinner; loops are
// cut at the weakest edge, which stays as a branch whose tip is linked to where it ended. Children start at their
// parent's rim. Radii must be measured. `size` is the canvas.
Annotation annotation_from_graph(const TraceGraph& graph, Size size, const TreeOptions& options);

}  // namespace ramify
