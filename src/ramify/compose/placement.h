// SPDX-License-Identifier: GPL-3.0-or-later
// Which piece of the photo covers which piece of the skeleton, and how it is turned and bent to fit (paper 002, section
// 5.2 and 5.3; PICTURES 3, 4, 12.1). No pixel is pasted here: a placement is a map from the canvas to the photo, and any
// layer that lies on the photo's pixels (colour, emitted or absorbed light, masks) can be taken through it.
#pragma once

#include <vector>

#include "ramify/compose/target.h"
#include "ramify/core/monitor.h"
#include "ramify/core/options.h"
#include "ramify/core/random.h"
#include "ramify/exemplar/fragment.h"
#include "ramify/geometry/thin_plate.h"
#include "ramify/image/image.h"

namespace ramify {

struct PlacementOptions {
  double mask_weight = 2.0;      // share of the disc where branch meets no branch: the decisive term (PICTURES 12.1-3)
  double colour_weight = 0.03;   // squared low-pass Lab difference / 100 of source surround and background
  double contrast_weight = 0.2;  // sources fainter than 0.9 of the usual contrast make branches vanish
  double overlap_weight = 0.5;   // colour difference to the disc before, relative to the shape cost
  double reuse_weight = 0.02;    // for every use of a source or its neighbours
  int reuse_cap = 4;             // uses of one place of the photo
  double variation = 0.01;       // scale of the Gumbel noise added to every cost: another seed, another choice
  double leave_out = 0.0;  // disc radii; sources nearer than this to the target's own or mirrored place are banned
  bool mirror = true;            // also try every source mirrored (never where light decides)
  bool paper_greedy = false;     // shape + summed overlap colour, random among the best `paper_best`
  int paper_best = 2;
  bool bend = true;              // thin plate on three rows; false: rigid only
  bool paper_warp = false;       // the paper's squared Laplacian through the centre line instead
};
std::vector<OptionField> describe(PlacementOptions& options);

struct Placement {
  int target = kNone;             // index into PlacementPlan::targets
  int source = kNone;             // index into FragmentLibrary::fragments
  bool mirrored = false;          // x of the photo flipped about the source's centre
  double angle = 0.0;             // rad, turns the (mirrored) source onto the target
  double scale = 1.0;             // canvas px per photo px; 1 unless the widths differ much
  double cost = 0.0;
  double disagreement = 0.0;      // 0..1, share of the disc where branch meets no branch
  double torn = 0.0;              // 0..1, share of the target's own branches that are not shown (compose/coverage.h)
  Vec2 centre = Vec2::Zero();     // px on the canvas
  double radius = 0.0;            // px, of the disc on the canvas
  WarpGrid photo_from_canvas;     // bent map; covers the disc and 3 px around it
};

struct PlacementPlan {
  std::vector<BranchCurve> curves;
  BranchField field;               // of the canvas
  TargetSet targets;
  std::vector<Placement> placements;  // in the order of the targets; a target without any source has none
};

// The skeleton is dressed as it is. Its radii should be ones the photo has (match_radii).
// background: the canvas without branches, for the low-pass colour term; empty = no such term.
PlacementPlan place_fragments(const FragmentLibrary& library, const Skeleton& skeleton, const ColorImage& background,
                              const TargetOptions& target_options, const PlacementOptions& options, Rng rng,
                              const Monitor& monitor);

// Radii outside the range of the photo's branches are mapped into it by quantiles of their logarithm, so that any
// skeleton can be dressed with any photo. A skeleton within the range (to 25 %) is returned as it is.
Skeleton match_radii(const Skeleton& skeleton, const FragmentLibrary& library);

}  // namespace ramify
