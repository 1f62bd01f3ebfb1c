// SPDX-License-Identifier: GPL-3.0-or-later
// Skeletons as pictures: exact masks, labels and distances. All of them see the same body (capsules.h), and branch ids are
// indices into branch_tree(skeleton).branches everywhere.
#pragma once

#include <limits>
#include <vector>

#include "ramify/image/image.h"
#include "ramify/skeleton/skeleton.h"

namespace ramify {

// Share of every pixel's area inside the body, 0..255 (8 x 8 samples in pixels that the boundary crosses).
Mask draw_branch_mask(const Skeleton& skeleton, Size canvas);

// Signed distance of every pixel's centre to the body's boundary, px, negative inside, at most `reach`.
ScalarImage draw_signed_distance(const Skeleton& skeleton, Size canvas, double reach);

// The branch whose surface comes nearest to a pixel's centre.
struct NearestBranch {
  float distance = std::numeric_limits<float>::infinity();  // px to the nearest disc's centre on the centre line
  float radius = 0.0f;                                      // px there; distance - radius is the signed distance
  float arc = 0.0f;                                         // px along the branch (branch_polyline)
  std::int32_t branch = kNone;                              // kNone beyond the reach
  Eigen::Vector2f tangent = Eigen::Vector2f::Zero();        // unit, towards the tip; zero for a branch of one node
};

// Pixels whose signed distance exceeds `reach` (px, may be infinite) may keep branch kNone.
Image<NearestBranch> draw_nearest_branch(const Skeleton& skeleton, Size canvas,
                                         double reach = std::numeric_limits<double>::infinity());

// Everything a training set needs.
struct SkeletonMasks {
  Mask branch;                     // as draw_branch_mask
  Image<std::uint16_t> radius;     // 1/256 px, saturating at 255.99; 0 where there is no label
  LabelImage branch_id;            // where the pixel's centre is inside or the centre line crosses the pixel, else kNone
  LabelImage order;                // the branch's order, else kNone
};
SkeletonMasks draw_masks(const Skeleton& skeleton, Size canvas);

// Labels as 16-bit grey: label + 1, 0 for kNone, saturating.
Image<std::uint16_t> label_picture(const LabelImage& labels);

// One side branch leaving its parent.
struct Furcation {
  int parent_branch = kNone, child_branch = kNone;
  int parent_node = kNone, child_node = kNone;
  Vec2 position = Vec2::Zero();  // px, of the parent's node
};
std::vector<Furcation> list_furcations(const Skeleton& skeleton);

}  // namespace ramify
