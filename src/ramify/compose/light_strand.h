// SPDX-License-Identifier: GPL-3.0-or-later
// A branch as a dense line, the form in which light is matched and laid: one sample for every pixel of arc length, with
// normal, radius and brightness level. Source and target skeletons become strands by the same steps.
#pragma once

#include <cstdint>
#include <vector>

#include "ramify/image/image.h"
#include "ramify/skeleton/skeleton.h"

namespace ramify {

struct Strand {
  std::vector<Vec2> points;       // px, base to tip, 1 px apart; a child starts on its parent's centre line
  std::vector<Vec2> normals;      // unit, the tangent turned by +90 degrees
  std::vector<double> radii;      // px
  std::vector<Vec3> level;        // layer on the centre line, r g b; empty until it is measured or drawn
  std::vector<std::uint8_t> bad;  // 1 where the photo offers nothing to copy; empty for a target
  int parent = kNone;             // index of an earlier strand
  int parent_sample = kNone;      // the parent's sample nearest to points[0]
  int first = 0;                  // first sample to dress: what lies before is inside the parent
  double behind = 0.0;            // px before `first` that may still be dressed without showing beyond the parent
  bool open_start = false;        // ends freely at its base: fades in
  bool open_end = false;          // ends freely at its tip: fades out

  int count() const { return static_cast<int>(points.size()); }
};

// Strands of all branches with at least 3 px outside their parent, parents first. A child begins at its parent's rim,
// or, where it is not thinner than 0.4 of the parent, at a quarter of the way to it (PICTURES 12.3-7). A tip is open
// unless it ends at the frame (8 px) or on another strand.
std::vector<Strand> make_strands(const Skeleton& skeleton);

// Lets the thin children of new branches begin halfway inside their parents. A parent's light is often narrower than
// its width says; what begins at its rim would float beside it. Where it is not, the stronger light hides the start.
void begin_inside_parents(std::vector<Strand>& strands);

// Ends within 8 px of where `hidden` is not 0 (a skyline, the rim of a field; may be empty) go on behind it: they are
// not open.
void close_hidden_ends(std::vector<Strand>& strands, const Mask& hidden);

// Unit normals of a line of at least two points, from tangents smoothed by 2 px.
std::vector<Vec2> line_normals(const std::vector<Vec2>& points);

// Smoothed by a Gaussian of `sigma` samples; the ends count as continuing.
std::vector<double> smooth(const std::vector<double>& values, double sigma);
std::vector<Vec3> smooth(const std::vector<Vec3>& values, double sigma);

// 1 + index of the strand a pixel lies on within grow * radius + add px, 0 elsewhere. Where strands overlap, thick ones
// win, except close to a thin one's own centre line inside its own width.
LabelImage strand_labels(const std::vector<Strand>& strands, Size size, double grow, double add);

// 255 within grow * radius + add px of any strand.
Mask strand_mask(const std::vector<Strand>& strands, Size size, double grow, double add);

// 1 on the strands' centre lines, falling to 0 across their rims over `softness` of their radius to both sides, but over
// at least 1.2 px.
ScalarImage strand_share(const std::vector<Strand>& strands, Size size, double softness);

// 0..1: how much of a strand's light is left at sample t, where open ends fade over tip_fade * (1 + 1.2 r) px.
double end_fade(const Strand& strand, int t, double tip_fade);

// Radius of the disc in which a strand's surround is copied: r + clamp(factor * r, 8, cap) (PICTURES 4, 12.3-6).
double surround_radius(double radius, double factor, double cap);

}  // namespace ramify
