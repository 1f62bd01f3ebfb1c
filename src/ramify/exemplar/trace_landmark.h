// SPDX-License-Identifier: GPL-3.0-or-later
// A landmark all thick branches come from, found without help: the optic disc of an eye, a collar of roots. It stays as
// it is in new pictures, and branches start at its rim where the photo's own did (PICTURES 8).
#pragma once

#include <optional>

#include "ramify/core/monitor.h"
#include "ramify/exemplar/trace_graph.h"

namespace ramify {

struct Landmark {
  Vec2 centre = Vec2::Zero();  // px
  double radius = 0.0;         // px
};

// A compact spot whose colour is odd against its surround, far more than spots of that size are in this photo, and whose
// rim at least four of the thicker branches cross outwards, into three of the four quarters at least, two of them of the
// thickest. Colour is looked at
// beside the branches only. Edges must be measured. excluded: may be empty.
std::optional<Landmark> find_landmark(const ColorImage& photo, const TraceGraph& graph, const Mask& excluded,
                                      const Monitor& monitor = {});

// The graph without what lies within `reach` px of the centre; the new ends on that circle are appended to `ends`.
TraceGraph cut_at(const TraceGraph& graph, const Vec2& centre, double reach, std::vector<int>& ends);

// The landmark's rim as a polygon.
std::vector<Vec2> outline_of(const Landmark& landmark);

}  // namespace ramify
