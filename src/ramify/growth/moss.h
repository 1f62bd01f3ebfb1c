// SPDX-License-Identifier: GPL-3.0-or-later
// A picture overgrown with moss (Xu & Mould 2007, figure 15): hairs are least-cost paths that stand on rows of ground, every
// row a generator; each hair has the picture's colour where it stands, and lies in the shadow of the hair above.
#pragma once

#include <vector>

#include "ramify/core/monitor.h"
#include "ramify/core/options.h"
#include "ramify/core/random.h"
#include "ramify/image/image.h"

namespace ramify {

struct MossOptions {
  double height = 18.0;    // px, of the longest hairs
  double rows = 4.0;       // px from one row of ground to the next
  double density = 0.35;   // hairs per px of a row
  double roughness = 5.0;  // r of W = 1 + r u: straight or curly
  double shadow = 0.35;    // kappa: light is exp(-kappa * hairs above)
  double thickness = 0.55; // px, radius of a hair where it stands; its tip has half of it
};
std::vector<OptionField> describe(MossOptions& options);

struct MossHair {
  std::vector<Vec2> points;   // px, from the ground (or the hair it parts from) to the tip, about one per px
  std::vector<double> radii;  // px, one a point
  std::vector<float> light;   // 0..1, one a point
  Rgb color;                  // sRGB-encoded, in full light
};

// Rows from the back to the front, to be painted in this order. The canvas is as wide as the picture and moss_headroom px
// higher: a row that stands on the picture's row y stands at y + headroom. Deterministic in (inputs, rng) for any number of
// threads. Throws InputError for an empty picture. O(width * height of hairs * rows).
std::vector<MossHair> grow_moss(const ColorImage& picture, const MossOptions& options, const Rng& rng, const Monitor& monitor);
int moss_headroom(const MossOptions& options);

}  // namespace ramify
