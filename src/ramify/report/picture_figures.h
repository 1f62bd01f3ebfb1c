// SPDX-License-Identifier: GPL-3.0-or-later
// How far a picture is from its exemplar (ALGORITHMS 7.2 to 7.6, PICTURES 10). Pictures are sRGB; the branch zone is what
// lies within 4 px of a branch.
#pragma once

#include <vector>

#include "ramify/core/monitor.h"
#include "ramify/core/random.h"
#include "ramify/image/image.h"
#include "ramify/report/figure.h"
#include "ramify/skeleton/skeleton.h"

namespace ramify {

Mask branch_zone(const Skeleton& skeleton, Size canvas);

// Mean |Laplacian of L| inside the mask: 1 between equally sharp pictures when divided.
double measure_sharpness(const ColorImage& lab, const Mask& where);

// Step across the edges between two owners over the step 6 px beside them, pooled; 1 = seams cannot be told from what is
// around them. NaN without seams.
double measure_seam_ratio(const ColorImage& color, const LabelImage& owner);

// The tiles of 96 px with the worst seams, worst first; at most `count`, and none whose ratio is below 1.
struct WorstSeam {
  int x = 0, y = 0;   // px, the tile's corner
  double ratio = 0.0;
};
inline constexpr int kSeamTile = 96;  // px
std::vector<WorstSeam> find_worst_seams(const ColorImage& color, const LabelImage& owner, int count);

// Share of the owned pixels that were moved by the commonest translation (rounded to whole px). NaN when none is owned.
double measure_offset_peak(const LabelImage& owner, const Image<Eigen::Vector2f>& source);

// Share of textured 9 x 9 patches (s.d. > 6/255) with a near-identical one (r.m.s. < 0.1 s.d.) more than 9 px away; from
// `queries` patches drawn at random.
double measure_repetition(const ColorImage& color, Rng rng, const Monitor& monitor, int queries = 600);

// Share of 48 px blocks touching the branch zone that correlate above 0.98 with the photo at the same place, or with the
// photo flipped either way. Pictures of equal size.
double measure_copied_blocks(const ColorImage& photo_lab, const ColorImage& result_lab, const Mask& result_zone);

// Median colour difference (Lab) inside the mask after a box blur of 25 px. Pictures of equal size.
double measure_lowpass_difference(const ColorImage& a, const ColorImage& b, const Mask& where);

struct PictureSubject {
  const ColorImage& color;
  const Skeleton& skeleton;
};
// Where the result's pixels come from; null pointers when that is not known.
struct Provenance {
  const LabelImage* owner = nullptr;
  const Image<Eigen::Vector2f>* source = nullptr;
  bool glow = false;  // branches are laid as emitted light
};
std::vector<Figure> compare_pictures(const PictureSubject& exemplar, const PictureSubject& result, const Provenance& provenance,
                                     Rng rng, const Monitor& monitor);

}  // namespace ramify
