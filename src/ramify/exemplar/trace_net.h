// SPDX-License-Identifier: GPL-3.0-or-later
// Veins and the net between them: a leaf's finest veins close hundreds of small meshes. They are the ground's texture, and
// the hierarchy that is to be learnt lies above them (PICTURES 8).
#pragma once

#include "ramify/exemplar/trace_graph.h"

namespace ramify {

// When the lines close many meshes and fall into two classes of strength, the stronger at least twice as strong as the
// weaker, the weaker class is the net and goes; short weak pieces between two strong ones stay. Else nothing changes:
// cracks that enclose fields are of one class. TraceEdge::strength must be set.
TraceGraph without_net(const TraceGraph& graph);

}  // namespace ramify
