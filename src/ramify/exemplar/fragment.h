// SPDX-License-Identifier: GPL-3.0-or-later
// Discs along branches: what a photo is cut into, and the empty discs a skeleton is to be dressed with (paper 002,
// section 5.1; PICTURES 3 and 4). Both are made by the same functions, so that a target disc and a source disc of one
// kind have comparable shape vectors.
#pragma once

#include <optional>
#include <vector>

#include "ramify/exemplar/exemplar.h"
#include "ramify/skeleton/branch_field.h"
#include "ramify/skeleton/curve.h"

namespace ramify {

enum class FragmentKind {
  Along,     // a stretch of one branch
  Junction,  // a furcation whose child has at least side_ratio of the parent's width
  Side,      // a thinner child leaving its parent's bank
  Bank,      // one bank of a branch too wide for a disc that holds both (shore.h)
  Interior   // between the banks of such a branch
};

struct ShapeSample {
  Vec2 offset = Vec2::Zero();  // px from the disc's centre
  Vec2 normal = Vec2::Zero();  // unit, across the branch
  double radius = 0.0;         // px; 0 for samples of a bank line
};

struct Fragment {
  FragmentKind kind = FragmentKind::Along;
  int curve = kNone;               // the branch, or the parent at a furcation
  int child = kNone;               // the child at a furcation
  int vertex = 0;                  // of the centre, on `curve`
  int first = 0, last = 0;         // vertices of `curve` inside the disc
  int child_last = 0;              // the child's last vertex inside the disc
  Vec2 centre = Vec2::Zero();      // px
  double radius = 0.0;             // px, of the disc
  double branch_radius = 0.0;      // px, that decides which discs are comparable (a Side fragment's is its child's)
  bool tip = false;                // holds the free end of the branch
  std::vector<ShapeSample> shape;  // 11 samples along the branch (bank), + 6 along the child; as paper 002's shape vector
  double contrast = 0.0;           // Lab difference of branch and surround; sources only
};

struct FragmentOptions {
  double radius_factor = 3.0;  // disc radius in branch radii, before the clamp of PICTURES 4
  double least_surround = 8.0; // px of ground beyond a branch's edge that a disc holds at least
  double side_ratio = 0.4;     // child / parent radius below which a furcation is a Side fragment; 0 = never
  double source_spacing = 0.25;  // of the disc radius
  bool paper_spacing = false;  // sources lambda-spaced only (0.75 of the summed radii), discs clamp(3 r, 8, 0.2 side)
  double wide_radius = 28.0;   // px; wider branches are dressed bank by bank; 0 = never
  double bank_disc = 40.0;     // px, disc radius on banks and between them
  double canvas_side = 0.0;    // px, for paper_spacing; 0 = no upper bound
};

// r + clamp((factor - 1) r, least_surround, 40): the surround that matters does not grow with r.
double disc_radius(double branch_radius, const FragmentOptions& options);

// The disc centred on a vertex of a curve.
Fragment along_fragment(const std::vector<BranchCurve>& curves, int curve, int vertex, const FragmentOptions& options);

// The disc where a child leaves its parent; empty when the child hardly leaves it.
std::optional<Fragment> furcation_fragment(const std::vector<BranchCurve>& curves, int child,
                                           const FragmentOptions& options);

// Everything a photo offers.
struct FragmentLibrary {
  std::vector<BranchCurve> curves, shores;
  BranchField field;
  std::vector<Fragment> fragments;
  ColorImage lab;           // the photo in CIE Lab
  Mask shadow;              // 255 where there are unannotated branches
  Mask unusable;            // 255 where no pixel may be taken: ignored and outside regions, outliers
  double thinnest = 1.0, thickest = 1.0;  // px, 2 % and 98 % of the radius along the branches
  double light_strength = 0.0;  // 0..1: how far the brighter bank depends on the branch's direction
};

// Does light from one side shape the branches (ridges, furrows)? Then nothing may be mirrored and little turned. Measured on
// ten photos: ridges 0.36, mud 0.37, roots 0.44, all others below 0.2; neighbouring discs correlate by chance that far.
inline bool is_shaded(const FragmentLibrary& library) { return library.light_strength > 0.3; }

// Throws InputError when there is no fragment at all. Empty masks mean none.
FragmentLibrary make_fragment_library(const Exemplar& exemplar, Mask shadow, Mask unusable,
                                      const FragmentOptions& options);

// The contrast that branches of this radius usually have in the photo (60 % quantile); 0 when too few are alike.
double usual_contrast(const FragmentLibrary& library, double branch_radius);

}  // namespace ramify
