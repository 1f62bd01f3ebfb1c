// SPDX-License-Identifier: GPL-3.0-or-later
// What dressing a skeleton with fragments of a photo takes and gives (paper 002, section 5). The whole road is scene.h;
// paste.h and light.h are its two ways.
#pragma once

#include <string>
#include <vector>

#include "ramify/core/monitor.h"
#include "ramify/core/options.h"
#include "ramify/core/random.h"
#include "ramify/exemplar/exemplar.h"
#include "ramify/image/image.h"
#include "ramify/skeleton/skeleton.h"

namespace ramify {

enum class CompositeMode { Auto, Paste, Emit, Absorb };
enum class BackgroundMode { Auto, Keep, Vary, New };

struct ComposeOptions {
  CompositeMode composite = CompositeMode::Auto;
  BackgroundMode background = BackgroundMode::Auto;
  bool mirror = true;        // sources and background may be mirrored where light allows
  double leave_out = 0.0;    // disc radii, 0 … 100; sources nearer than this to their own place are banned
  // Single departures back to the paper (ALGORITHMS 17); paper_exact sets all of them. They paste only.
  bool paper_spacing = false;  // source discs lambda-spaced, lambda = 0.75
  bool paper_greedy = false;   // greedy choice with summed overlap colour, random among the best two
  bool paper_order = false;    // parents first, furcations laid over them
  bool paper_rigid = false;    // no warp
  bool paper_warp = false;     // warp by the squared Laplacian through the centre line
  bool paper_cut = false;      // seams by colour difference alone, without history
  bool paper_blend = false;    // one Poisson problem after the other
  bool free_rims = false;      // with paper_blend: rims not held, the plain variant that drifts
  bool paper_exact = false;    // all of them but paper_rigid and free_rims
};
std::vector<OptionField> describe(ComposeOptions& options);

struct Composite {
  ColorImage color;     // sRGB
  ColorImage plate;     // the background that was used, without branches
  LabelImage owner;     // fragment index of every pixel, kNone for background
  VectorImage source;   // photo pixel every pixel was taken from (px), NaN where there is none
  CompositeMode composite = CompositeMode::Paste;   // what Auto chose
  BackgroundMode background = BackgroundMode::Keep;
};

}  // namespace ramify
