// SPDX-License-Identifier: GPL-3.0-or-later
// Bends a copied disc onto a new course: a thin plate through three rows of points (centre line and both banks) that
// goes over into the rigid placement outside (PICTURES 12.1-5).
#pragma once

#include <Eigen/Core>
#include <vector>

#include "ramify/compose/light_match.h"
#include "ramify/compose/light_source.h"

namespace ramify {

// Pixels [x0, x0 + size) x [y0, y0 + size) of the new picture round a target sample.
struct PatchBox {
  int x0 = 0, y0 = 0, size = 0;
  Vec2 centre = Vec2::Zero();  // px, the target sample
  double s = 0.0;              // px, radius of the disc
};
PatchBox patch_box(const Strand& target, int sample, const LightRules& rules);

// The part of a warp that all sources for one place share: displacements at grid nodes as a linear function of the
// displacements of the control points.
class LightWarp {
 public:
  LightWarp(const Strand& target, int sample, const PatchBox& box);

  // Photo position (px) of every pixel of the box, row by row.
  std::vector<Eigen::Vector2f> photo_from_canvas(const LightSource& source, const LightMatch& match) const;

 private:
  // Does the bend stretch or fold the disc beyond what a photo can stand?
  bool folds(const Eigen::MatrixXd& nodes, const Eigen::Matrix2d& photo_from_target) const;

  PatchBox box_;
  std::vector<int> steps_;         // samples of the target's rows, relative to its centre
  std::vector<Vec2> controls_;     // px, relative to the centre: centre line, one bank, other bank, ring
  int grid_ = 0;                   // nodes per side of the displacement grid
  Eigen::MatrixXd nodes_from_controls_;
};

}  // namespace ramify
