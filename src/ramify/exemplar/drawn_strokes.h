// SPDX-License-Identifier: GPL-3.0-or-later
// Strokes along points a person gave: by live wire on the ridges, by both banks where the branch is wide, or straight.
#pragma once

#include "ramify/core/monitor.h"
#include "ramify/exemplar/line_finder.h"
#include "ramify/exemplar/trace.h"

namespace ramify {

struct DrawnStrokes {
  Mask lines;          // one pixel wide
  Mask wide;           // 255 inside strokes that were traced by their banks
  ScalarImage radius;  // px to the nearer bank, there
};
DrawnStrokes no_strokes(Size size);

// options.through, stroke after stroke: one that starts or ends near an earlier one, or in a wide one, joins it. Throws
// OptionError when the points cannot be read.
DrawnStrokes draw_strokes(const RidgeEvidence& evidence, const LatticeCosts& costs, const TraceOptions& options,
                          const Monitor& monitor = {});

// The pixels of one stroke by itself, from its first point to its last.
std::vector<Pixel> draw_stroke(const RidgeEvidence& evidence, const LatticeCosts& costs,
                               const std::vector<Vec2>& points, bool straight, const Mask& fixed,
                               const Monitor& monitor = {});

// Within wide strokes no other thick branch is looked for; afterwards they count as thick branches themselves.
void leave_out(RidgeEvidence& evidence, const DrawnStrokes& drawn);
void take_in(RidgeEvidence& evidence, const DrawnStrokes& drawn);

// Lines that end at the bank of a wide stroke are led on to its middle.
void join_at_banks(Mask& lines, const DrawnStrokes& drawn);

}  // namespace ramify
