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

struct GrowthTarget {
  Size size;                    // px, the canvas
  std::vector<GrowthRoot> roots;// empty: the style's own (frame roots and landmark roots)
  ScalarImage density;          // empty, or painted: 0 never entered, 1 = grow and fill (PICTURES 9)
  std::vector<Vec2> guide_path; // px; empty, or a course the main branch follows (paper 002, section 4.5)
  ScalarImage guide_map;        // empty, or 1 on the course and 0 elsewhere
  Mask outside;                 // empty, or 255 where growth leaves as through the frame
  Mask obstacles;               // empty, or 255 where nothing may grow
};

struct GrowOptions {
  double tropism = -1.0;        // strength of the learnt absolute direction, 0..2; -1 = from the style
  double length = 1.0;          // total length relative to the exemplar's per habitat area
  int levels = 0;               // highest order that may grow; 0 = as the exemplar
  double guide_width = 0.0;     // px; 0 = 1.5 x the style's bend amplitude
  double histogram_weight = 50.0;  // omega_G of the paper
  int candidates = 3;           // c: draw among the best c
  bool paper_exact = false;
};
std::vector<OptionField> describe(GrowOptions& options);

// No two branches ever cross or touch. Deterministic in (inputs, seed). Node tags name the exemplar vertex a node's bend
// was copied from (index into style.bending), for the verbatim-run figure.
Skeleton grow_from_style(const Style& style, const GrowthTarget& target, const GrowOptions& options, Rng rng,
                         const Monitor& monitor);

}  // namespace ramify
