// SPDX-License-Identifier: GPL-3.0-or-later
// Where the branches run, as lines one pixel wide: ridges, thick masks, live wire (ALGORITHMS 3.1, 3.3).
#pragma once

#include <vector>

#include "ramify/core/monitor.h"
#include "ramify/exemplar/trace.h"
#include "ramify/graph/least_cost_path.h"
#include "ramify/image/ridge.h"

namespace ramify {

// All that is measured once for a photo before lines are looked for.
struct RidgeEvidence {
  ScalarImage picture;   // the chosen channel, as it is
  bool bright = true;    // branches are brighter than their surround in it
  bool glow = false;
  RidgeField field;      // of the flattened channel
  double high = 0.0;     // strength that starts a line
  double low = 0.0;      // strength that continues one
  Mask thick;            // branches wider than the ridges looked for; 0 everywhere when there are none
  ScalarImage radius;    // px, first estimate: scale of the ridge, or distance to the bank inside `thick`
};

// excluded: non-zero where nothing may be traced; its rim gives no ridge either.
RidgeEvidence gather_evidence(const ColorImage& photo, const Mask& excluded, const TraceOptions& options,
                              const Monitor& monitor = {});

Mask find_lines(const RidgeEvidence& evidence, const Mask& excluded, const TraceOptions& options,
                const Monitor& monitor = {});

// Pixel costs of ALGORITHMS 3.1: 0.02 + (1 - V)^2, times 1024.
LatticeCosts live_wire_costs(const RidgeEvidence& evidence);

// The cheapest way through the points one after the other, each first snapped to the strongest ridge within `snap` px;
// points that lie on `fixed` pixels (earlier strokes) stay where they are. `fixed` may be empty.
std::vector<Pixel> live_wire(const RidgeEvidence& evidence, const LatticeCosts& costs, const std::vector<Vec2>& points,
                             double snap, const Mask& fixed, const Monitor& monitor = {});

// The lines with interruptions of up to gap radii bridged where the way across is cheap and goes straight on.
Mask bridge_gaps(const RidgeEvidence& evidence, const LatticeCosts& costs, const Mask& lines, double gap,
                 const Monitor& monitor = {});

}  // namespace ramify
