// SPDX-License-Identifier: GPL-3.0-or-later
// Which parts of the canvas want a branch and have none yet, on a coarse grid.
#pragma once

#include <vector>

#include "ramify/growth/ground.h"

namespace ramify {

class Coverage {
 public:
  // wanted(point) -> 0..1 weighs every cell; reach: px a branch covers to each side where the weight is 1.
  template <class Wanted>
  Coverage(Size size, double reach, Wanted&& wanted) : Coverage(size, reach) {
    for (int y = 0; y < rows_; ++y) {
      for (int x = 0; x < columns_; ++x) weight_[static_cast<std::size_t>(y) * columns_ + x] = wanted(center(x, y));
    }
  }

  int cells() const { return columns_ * rows_; }
  double cell_side() const { return cell_; }
  Vec2 center_of(int cell) const { return center(cell % columns_, cell / columns_); }
  double weight(int cell) const { return weight_[static_cast<std::size_t>(cell)]; }
  bool covered(int cell) const { return count_[static_cast<std::size_t>(cell)] > 0; }
  int cell_at(const Vec2& point) const;  // kNone off the canvas

  // A branch of half width `radius` at `point` covers radius + reach around it (reach / weight where less is wanted);
  // change is +1 to add and -1 to take back.
  void cover(const Vec2& point, double radius, int change);

  // The weight at the point if it is not covered, else 0; 0 off the canvas.
  double unfilled(const Vec2& point) const;
  double reach_at(const Vec2& point) const;  // px

  // Share of the wanted weight that is covered, 0..1.
  double filled_share() const;

 private:
  Coverage(Size size, double reach);
  Vec2 center(int x, int y) const { return {(x + 0.5) * cell_ - 0.5, (y + 0.5) * cell_ - 0.5}; }

  double reach_;
  double cell_;
  int columns_;
  int rows_;
  std::vector<double> weight_;
  std::vector<int> count_;
};

}  // namespace ramify
