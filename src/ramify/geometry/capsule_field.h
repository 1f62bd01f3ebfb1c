// SPDX-License-Identifier: GPL-3.0-or-later
// Distance to the nearest capsule on a regular grid, by propagating the nearest capsule between neighbouring cells
// (Danielsson 1980): exact distances to the capsule found, which is the true nearest but for rare ties of a fraction of
// a cell.
#pragma once

#include <span>
#include <vector>

#include "ramify/geometry/capsule_index.h"

namespace ramify {

struct CapsuleField {
  int columns = 0;
  int rows = 0;
  double cell = 1.0;             // px between samples; sample (0,0) lies at (0,0)
  std::vector<int> nearest;      // capsule per sample, row by row; kNone without capsules
  std::vector<double> distance;  // px to its rim, 0 inside; infinity without capsules

  double at(int column, int row) const { return distance[static_cast<std::size_t>(row) * columns + column]; }
};

CapsuleField capsule_field(std::span<const Capsule> capsules, Size size, double cell);

// Median distance on the field's ridges (half the gap between neighbouring branches), counting ridges farther than
// `least` px from a branch. 0 when there is none.
double median_ridge(const CapsuleField& field, double least);

}  // namespace ramify
