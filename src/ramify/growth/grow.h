// SPDX-License-Identifier: GPL-3.0-or-later
// Grows a new skeleton in a learnt style (paper 002, sections 4.1 to 4.5; PICTURES 1, 2, 9, 12.2).
#pragma once

#include <optional>
#include <vector>

#include "ramify/core/monitor.h"
#include "ramify/core/options.h"
#include "ramify/core/random.h"
#include "ramify/image/image.h"
#include "ramify/skeleton/skeleton.h"
#include "ramify/style/style.h"

namespace ramify {

struct GrowthRoot {
  Vec2 position = Vec2::Zero();          // px
  std::optional<double> direction;       // rad; drawn from the style when empty
  std::optional<double> radius;          // px; from the style when empty
};

// Where the exemplar's own ground lies on the canvas: canvas = scale * exemplar + shift.
struct KeptGround {
  double scale = 1.0;
  Vec2 shift = Vec2::Zero();  // px
};

struct GrowthTarget {
  Size size;                    // px, the canvas
  std::vector<GrowthRoot> roots;// empty: the style's own (frame roots and landmark roots)
  ScalarImage density;          // empty, or painted: <= 8/255 never entered, 1 = grow and fill (PICTURES 9)
  std::vector<std::vector<Vec2>> guide_paths;  // px; courses branches follow from their first points on: the longest, and
                                // those that start on no other, are main branches (paper 002, section 4.5)
  ScalarImage guide_map;        // empty, or 1 on the courses and 0 elsewhere
  Mask outside;                 // empty, or 255 where growth leaves as through the frame
  Mask obstacles;               // empty, or 255 where nothing may grow
  std::optional<KeptGround> kept;  // given: roots on a landmark start exactly where the exemplar's do
};

struct GrowOptions {
  double tropism = -1.0;        // strength of the learnt absolute direction, 0..2; -1 = from the style
  double length = 1.0;          // total length relative to the exemplar's per area
  int levels = 0;               // how many orders may grow (1 = main branches only); 0 = as many as come
  double guide_width = 0.0;     // px; 0 = 4 x the style's bend amplitude
  double histogram_weight = 50.0;  // omega_G of the paper
  int candidates = 3;           // c: draw among the best c
  // Single departures back to the paper (ALGORITHMS 17); paper_exact sets all of them.
  bool raw_distance = false;      // windows compared without normalisation
  bool radius_histogram = false;  // histogram matching of radii as well as of angles
  bool raster_density = false;    // D on a raster with the down-up-down test instead of exact capsules
  bool parent_first = false;      // furcations by probability alone, branch after branch, parents first
  bool copy_stem = false;         // the main stem starts as a copy of the exemplar's
  bool free_direction = false;    // no absolute direction
  bool free_radius = false;       // radii copied with the bends instead of from a template
  bool paper_exact = false;
};
std::vector<OptionField> describe(GrowOptions& options);

// No two branches ever cross or touch (but where a branch ends on another as the exemplar's do, and with raster_density).
// Deterministic in (inputs, seed). Node tags name the exemplar vertex a node's bend was copied from, plus one (an index
// into style.bending; 0 = not copied), negative when mirrored, for the verbatim-run figure. Throws OptionError for options
// out of range and InputError when nothing can grow on the target (it says why).
Skeleton grow_from_style(const Style& style, const GrowthTarget& target, const GrowOptions& options, Rng rng,
                         const Monitor& monitor);

}  // namespace ramify
