// SPDX-License-Identifier: GPL-3.0-or-later
// Cheapest ways from what has grown to everywhere else, over a grid of cells; new sources only shorten ways, so they are
// added as they come.
#pragma once

#include <vector>

#include "ramify/core/types.h"

namespace ramify {

class Ways {
 public:
  // cost: per px of way through each cell, row by row, > 0; infinite = closed. cell: side of a cell, px.
  Ways(std::vector<double> cost, int columns, double cell);

  // Ways may start at the cell too; `mark` is what source() says of cells nearest to it. A closed cell is opened.
  void start_at(int cell, int mark);

  bool reached(int cell) const;
  double cost(int cell) const { return total_[static_cast<std::size_t>(cell)]; }  // infinite when not reached
  double length(int cell) const { return length_[static_cast<std::size_t>(cell)]; }  // px of the cheapest way
  int source(int cell) const { return mark_[static_cast<std::size_t>(cell)]; }
  std::vector<int> way(int cell) const;  // cells from the source to this one

 private:
  double cell_;
  int columns_;
  int rows_;
  std::vector<double> cost_, total_, length_;
  std::vector<int> from_, mark_;
};

}  // namespace ramify
