// SPDX-License-Identifier: GPL-3.0-or-later
// From where and in which order strokes are entered: the hierarchy of a traced picture (PICTURES 12.2-2).
#pragma once

#include <vector>

#include "ramify/exemplar/trace_strokes.h"

namespace ramify {

struct StrokePlace {
  int stroke = kNone;
  int start = 0;          // index into the stroke's nodes; an inner one is entered both ways
  int parent = kNone;     // index of the parent's place, none for a root
  int parent_node = 0;    // index into the parent stroke's nodes
  double cosine = 1.0;    // between the parent's way and the child's
  double cost = 0.0;
};

// Where each stroke of a set is touched by others, and which strokes end on the frame.
struct StrokeNet {
  std::vector<TraceStroke> strokes;
  std::vector<std::vector<std::pair<int, int>>> touching;  // per graph node: stroke, index into its nodes
  std::vector<std::pair<int, int>> frame_ends;             // stroke, index into its nodes
};

StrokeNet stroke_net(const TraceGraph& graph, std::vector<TraceStroke> strokes, const std::vector<bool>& on_frame);

// Enters every stroke that can be reached where it costs least: each level costs one, and so does turning back, growing
// thicker along the way or being thicker than the parent. A stroke that comes from the frame may be a root of its own.
std::vector<StrokePlace> plan_from(const StrokeNet& net, const std::vector<std::pair<int, int>>& roots);

// How well the forks open forwards and get thinner (PICTURES 12.2-2). `frame` says whether the root lies on the frame.
double plan_score(const StrokeNet& net, const std::vector<StrokePlace>& plan, bool frame);

}  // namespace ramify
