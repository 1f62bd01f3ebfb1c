// SPDX-License-Identifier: GPL-3.0-or-later
// The lines of a figure: through the cells, from border to border. Private to the layer.
#pragma once

#include <vector>

#include "ramify/growth/figure_cells.h"

namespace ramify {

// Where a tree passes from a cell's parent into the cell.
struct Portal {
  Vec2 middle = Vec2::Zero();  // px, of the longest run of the shared border
  Vec2 inward = Vec2::Zero();  // unit, across the border into the cell; zero for roots
};

// One for every cell. Throws std::logic_error when a cell and its parent share no border.
std::vector<Portal> find_portals(const LabelImage& label, const std::vector<Vec2>& sites, const std::vector<int>& parents);

// Draws lines inside the cells' shape.
class FigurePen {
 public:
  // `inside` is empty where lines may leave the shape (Euclidean mode).
  FigurePen(const FigureCells& cells, const Mask& inside, const FigureOptions& options) : cells_(cells), inside_(inside), options_(options) {}

  // Points about 1.5 px apart across a cell from `from` to `to`, both included. The tangents are those of the line at its
  // ends, unit or zero (free). If the curve leaves the shape its handles are halved twice, then it goes the way by the
  // cell's site.
  std::vector<Vec2> line(int cell, const Vec2& from, const Vec2& out, const Vec2& to, const Vec2& in);

  int straightened() const { return straightened_; }

 private:
  bool is_inside(const Vec2& p) const;
  bool is_inside(const std::vector<Vec2>& points) const;
  std::vector<int> way_to_site(int cell, const Vec2& p) const;
  std::vector<Vec2> way_inside(int cell, const Vec2& from, const Vec2& to) const;

  const FigureCells& cells_;
  const Mask& inside_;
  const FigureOptions& options_;
  int straightened_ = 0;
};

}  // namespace ramify
