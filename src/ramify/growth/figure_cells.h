// SPDX-License-Identifier: GPL-3.0-or-later
// The cells of a figure: points spread in a shape and what lies nearest to each. Private to the layer.
#pragma once

#include <vector>

#include "ramify/graph/plan.h"
#include "ramify/growth/figure.h"

namespace ramify {

struct FigureCells {
  std::vector<Vec2> sites;  // px
  LabelImage label;         // cell of every pixel
  Lattice lattice;          // Geodesic: the shape's pixels
  Plan plan;                // Geodesic: the ways inside the shape from every pixel to its site
};

// One part of the shape.
struct FigureIsland {
  std::vector<int> pixels;  // indices y * width + x, ascending
  int points = 0;           // how many are wanted in it, >= 1
};

// 4-connected parts of at least 3 px with their shares of the points; the smaller ones are removed from the shape.
std::vector<FigureIsland> find_islands(Mask& shape, int points, const Monitor& monitor);

// The shape with straight bridges between its parts along the shortest gaps (Kruskal 1956), `width` px wide.
Mask bridged(const Mask& shape, double width);

FigureCells geodesic_cells(const Mask& shape, const std::vector<FigureIsland>& islands, int evenness, const Rng& rng, const Monitor& monitor);

// The paper's: points on the border stay where they are and lose their cells at the end. `border_points` is halved as
// long as the cells do not hang together (003: "trial and error"), with a note.
FigureCells euclidean_cells(const Mask& shape, const std::vector<FigureIsland>& islands, int evenness, int border_points, const Rng& rng,
                            const Monitor& monitor);

// One step of Lloyd's with straight distances: every site moves to the middle of its cell, as far as that lies in the
// shape (empty = all of it; what leaks through the border would pull sites far out). `fixed` seeds follow the sites.
LabelImage euclidean_labels(const std::vector<Vec2>& sites, const std::vector<Vec2>& fixed, Size size);
void move_to_centroids(const LabelImage& label, std::vector<Vec2>& sites, const Mask& shape = {});

}  // namespace ramify
