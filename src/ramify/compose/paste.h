// SPDX-License-Identifier: GPL-3.0-or-later
// Pasted branches: every placed fragment is warped, one labelling decides for each pixel between fragments and
// background, and one gradient-domain solve joins them (paper 002, section 5.3; PICTURES 12.1-5 and 6).
#pragma once

#include "ramify/compose/patch.h"
#include "ramify/compose/placement.h"

namespace ramify {

struct PasteOptions {
  double core_margin = 1.0;     // px beyond the branch's edge where the background should not be seen …
  double core_share = 0.3;      // … plus this share of the branch radius …
  double core_cap = 8.0;        // … which is at most this, px
  double apron = 0.0;           // px beyond the edge within which the ground is the branch's own (Habitat::apron); the
                                // background should not be seen there
  double crossing_weight = 3.0; // seams across the branch cost up to 1 + this times as much, so they cross it shortly
  double step_guard = 12.0;     // Lab difference above which a step between branch and no branch stays hard (else fog)
  double screen = 1e-3;         // pull towards the fragments' own colours, 1/px^2
  double sharpen = 0.3;         // unsharp mask on fragments: makes up for resampling and blending
  int sweeps = 2;
  bool paper_order = false;     // paper 002: branch by branch; where a child leaves, the parent's discs are deleted first
  bool paper_cut = false;       // paper 002: colour difference only, old seams forgotten
  bool paper_blend = false;     // paper 002: one Poisson problem per fragment, in order, rims held where they are free
  bool free_rims = false;       // with paper_blend: rims not held, the plain variant that drifts (figure 5)
};
std::vector<OptionField> describe(PasteOptions& options);

struct PasteResult {
  ColorImage color;    // sRGB
  LabelImage owner;    // index into PlacementPlan::placements, kNone = background
  VectorImage source;  // px on the photo, NaN where the background shows
  int uncovered = 0;   // pixels of branches that no fragment covers
};

PasteResult paste_fragments(const ColorImage& photo, const FragmentLibrary& library, const PlacementPlan& plan,
                            const ColorImage& background, const PasteOptions& options, const Monitor& monitor);

}  // namespace ramify
