// SPDX-License-Identifier: GPL-3.0-or-later
// Smooth displacements through given points: thin-plate splines in closed form (Bookstein 1989), and warps held on a
// grid. Paper 002 section 5.3 asks for the field of least squared Laplacian; inside a disc that energy has every
// harmonic field in its null space, the thin plate's bending energy does not (ALGORITHMS 5.5).
#pragma once

#include <span>
#include <vector>

#include "ramify/core/types.h"

namespace ramify {

// f(x) = offset + linear x + sum_l weight_l phi(|x - point_l| / scale), phi(r) = r^2 log r.
class ThinPlate {
 public:
  // Takes `values` (px) at `points` (px): exactly for smoothing 0, nearly for small values (1e-3 is gentle; it keeps the
  // system well conditioned when points nearly coincide). `scale` (px) is the size of the region. Throws
  // std::invalid_argument for fewer than three points; points on one line need anchors beside it.
  ThinPlate(std::span<const Vec2> points, std::span<const Vec2> values, double scale, double smoothing);

  Vec2 operator()(const Vec2& x) const;

 private:
  double scale_;
  std::vector<Vec2> points_;  // in units of scale
  std::vector<Vec2> weights_;
  Vec2 offset_, slope_x_, slope_y_;
};

// A map from the canvas to somewhere else, as values on a grid, bilinear in between and continued straight outside.
struct WarpGrid {
  Vec2 origin = Vec2::Zero();  // px, position of the first grid point
  double step = 1.0;           // px between grid points
  int columns = 0, rows = 0;   // at least 2 each
  std::vector<Vec2> values;    // where each grid point goes, row by row

  Vec2 operator()(const Vec2& p) const;
};

struct JacobianRange {
  double low = 1.0, high = 1.0;  // smallest and largest area factor of the grid's cells; negative = folded over
};

// Over the cells whose first corner lies within `radius` px of `centre`.
JacobianRange measure_jacobian(const WarpGrid& warp, const Vec2& centre, double radius);

}  // namespace ramify
