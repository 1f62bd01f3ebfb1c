// SPDX-License-Identifier: GPL-3.0-or-later
// A quilt: part of a canvas covered by large patches of a photo, fitted together along least visible seams (Efros and
// Freeman 2001, Kwatra et al. 2003; PICTURES 12.1-1/2). Patches are chosen one after another against what is already
// there and against guides, from places that are not forbidden; seams are found by expansion moves.
//
// On ramify's photos this keeps texture crisp where averaging patch methods end as grey felt.
#pragma once

#include <vector>

#include "ramify/core/monitor.h"
#include "ramify/core/options.h"
#include "ramify/core/random.h"
#include "ramify/image/image.h"

namespace ramify {

// A field known in the photo and wanted on the canvas: the patches' values should agree. A difference of 1 over the
// whole patch costs `weight`; 1 is also what a patch costs whose overlap differs by the photo's own standard deviation.
struct GuideChannel {
  ScalarImage source;  // photo size
  ScalarImage target;  // canvas size
  double weight = 1.0;
};

struct QuiltJob {
  ColorImage source;     // the photo
  Mask forbidden;        // photo size; 255 = never copied
  Mask precious;         // photo size or empty; seams through it cost six times as much (creeks, ridges kept as texture)
  ColorImage canvas;     // known colours; what it holds in the hole is never looked at
  Mask hole;             // canvas size; 255 = to be covered
  std::vector<GuideChannel> guides;
};

struct QuiltOptions {
  int patch = 0;         // px, side of a patch; 0 = structure_length of the photo and the hole decide
  int tries = 900;       // random places tried for every patch
  double reuse = 0.3;    // cost of taking a place that one patch has used already
  double nearby = 0.0;   // px; where sources are drawn from around the patch's own place (canvas = photo); 0 = everywhere
  bool mirror_x = false; // patches may be mirrored left-right
  bool mirror_y = false; // and top-bottom
  int sweeps = 2;        // rounds of seam search
};
std::vector<OptionField> describe(QuiltOptions& options);

// A patch: canvas pixel (x, y) of the box shows photo pixel (sx + fx (x - tx), sy + fy (y - ty)).
struct QuiltPatch {
  int tx = 0, ty = 0, side = 0;  // px, box on the canvas
  int sx = 0, sy = 0;            // px, photo pixel shown at (tx, ty)
  int fx = 1, fy = 1;            // -1 = mirrored

  int source_x(int x) const { return sx + fx * (x - tx); }
  int source_y(int y) const { return sy + fy * (y - ty); }
};

struct Quilt {
  std::vector<QuiltPatch> patches;
  LabelImage label;  // canvas size: patch of every pixel; kNone outside the hole, or where no place was allowed
};

// Throws InputError when everything in the photo is forbidden.
Quilt make_quilt(const QuiltJob& job, const QuiltOptions& options, Rng rng, const Monitor& monitor);

// Photo pixel shown at every pixel of the canvas; NaN where there is none.
VectorImage quilt_sources(const Quilt& quilt);

// How far the photo's structure reaches: the lag (px) at which the autocorrelation of its luminance falls below 0.15,
// measured where it is not forbidden. Patches should be at least three times as large.
double structure_length(const ColorImage& photo, const Mask& forbidden);

}  // namespace ramify
