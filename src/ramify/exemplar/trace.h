// SPDX-License-Identifier: GPL-3.0-or-later
// From a photo to its branches without a mouse: `ramify trace` (ALGORITHMS 3). Automatic extraction, live wire through
// given points, or both; widths measured; root, order and loops found.
#pragma once

#include <string>
#include <vector>

#include "ramify/core/monitor.h"
#include "ramify/core/options.h"
#include "ramify/exemplar/exemplar.h"
#include "ramify/exemplar/ridge_channel.h"

namespace ramify {

enum class TraceMode { Auto, Ridge, Area };
enum class TracePolarity { Auto, Dark, Bright, Glow };

struct TraceOptions {
  TraceMode mode = TraceMode::Auto;              // ridges, a two-class mask, or ridges plus a mask of what is thicker
  TracePolarity polarity = TracePolarity::Auto;  // of the branches against their surround
  Channel channel = Channel::Auto;
  double min_radius = 1.0;   // px, 0.5 … 100: half width of the thinnest branches
  double max_radius = 10.0;  // px, 0.5 … 1000: half width of the thickest branches found as ridges
  double sensitivity = 1.0;  // 0.05 … 20: more finds fainter branches
  double min_length = 30.0;  // px, 1 … 10000: shorter pieces are dropped
  double gap = 6.0;          // radii, 0 … 50: interruptions that are bridged
  bool flatten = true;       // even out slow changes of tone and contrast first
  std::string through;       // px "x,y x,y …; x,y …": strokes to follow by live wire
  bool automatic = false;    // with `through`: find the other branches as well
  bool straight = false;     // with `through`: follow the points alone, not the picture
  bool as_drawn = false;     // with `through`: every stroke is a branch of its own; points may be x,y,radius
  double banks = 40.0;       // px, 0 … 10000: with `through`, wider branches are traced by their two banks; 0: never
  std::string root;          // px "x,y x,y …": where the structure starts
  std::string regions;       // "outside: x,y x,y x,y …; keep: …; ignore: …; landmark: …" polygons, px
  bool find_regions = true;  // without `regions`: a black surround is outside, a spot in its field where thick branches
                             // meet a landmark
};
std::vector<OptionField> describe(TraceOptions& options);

// Nothing is traced in outside, ignore and keep regions. A landmark found without help is where the branches start.
// Throws InputError when no branch is found, OptionError when an option cannot be read.
Annotation trace_photo(const Photo& photo, const TraceOptions& options, const Monitor& monitor = {});

// The same branches with radii measured again (and points re-centred by at most half a radius).
Annotation remeasure_widths(const Photo& photo, const Annotation& annotation, const TraceOptions& options,
                            const Monitor& monitor = {});

}  // namespace ramify
