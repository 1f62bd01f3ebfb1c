// SPDX-License-Identifier: GPL-3.0-or-later
// How much branch length a painted map asks for around every place, and how much there is (PICTURES 9): what is white gets
// a branch every `spacing`, what is half as bright half as much length.
#pragma once

#include <vector>

#include "ramify/growth/ground.h"
#include "ramify/style/style.h"

namespace ramify {

// Px from a branch to halfway to its neighbour where white is filled: the exemplar's own (rho of ALGORITHMS 4.5), or
// smaller where the painted strokes, or the picture, are too small to be read at that spacing.
double painted_spacing(const Style& style, const Ground& ground);

class Demand {
 public:
  // Asks for nothing.
  Demand() = default;
  // length: factor on what white asks for. Keeps no reference.
  Demand(const Ground& ground, double spacing, double length);

  int columns() const { return columns_; }
  int cells() const { return static_cast<int>(wanted_.size()); }
  double cell_side() const { return cell_; }
  Vec2 center_of(int cell) const { return {(cell % columns_ + 0.5) * cell_ - 0.5, (cell / columns_ + 0.5) * cell_ - 0.5}; }
  int cell_at(const Vec2& point) const;      // kNone off the canvas

  // Books the edge from a to b; change is +1 to add and -1 to take back.
  void add(const Vec2& a, const Vec2& b, int change);

  // Painted value at a cell, 0..1.
  double wanted(int cell) const { return wanted_[static_cast<std::size_t>(cell)]; }
  // What is wanted around a cell less what is there, as painted values: 1 = white with no branch, 0 = as asked for,
  // negative = more than that.
  double lack(int cell) const { return around_[static_cast<std::size_t>(cell)] - grown_[static_cast<std::size_t>(cell)]; }
  double lack(const Vec2& point) const;      // 0 off the canvas
  // The same, at most what is painted in the cell itself and at least 0: room beside a stroke is no room in black.
  double unfilled(const Vec2& point) const;

 private:
  double cell_ = 1.0;
  double window_ = 1.0;  // px, radius of the cone-shaped window
  double full_ = 1.0;    // px of branch per px^2 of white
  int columns_ = 0;
  int rows_ = 0;
  std::vector<double> wanted_;  // painted value of the cell
  std::vector<double> around_;  // the same, seen through the window
  std::vector<double> grown_;   // length through the window, as a painted value
};

}  // namespace ramify
