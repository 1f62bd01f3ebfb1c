// SPDX-License-Identifier: GPL-3.0-or-later
// Trees that fill a shape (paper 003; ALGORITHMS 10): the shape is cut into cells around points spread evenly in it, a
// spanning tree joins neighbouring cells, and curves run from cell to cell through the middle of the borders they share.
#pragma once

#include <string>
#include <vector>

#include "ramify/core/monitor.h"
#include "ramify/core/options.h"
#include "ramify/core/random.h"
#include "ramify/image/image.h"
#include "ramify/skeleton/skeleton.h"

namespace ramify {

enum class FigureCellKind {
  Geodesic,  // distances along ways inside the shape: cells never leave it nor reach over a thin wall; always connected
  Euclidean  // as in the paper, with points on the shape's border; may leave the shape or fall apart in thin places
};
enum class FigureTree { Steps, Shortest, Random, Minimal };
enum class FigureLines { Curved, Straight };
enum class FigureThickness { Descendants, Distance };
enum class FigureJoin { Apart, Bridges };

struct FigureOptions {
  int points = 0;          // cells; 0 = one for about 90 px of the shape
  int evenness = 5;        // Lloyd iterations: 0 = ragged, as the points fell
  FigureCellKind cells = FigureCellKind::Geodesic;
  int border_points = 0;   // Euclidean only: points on the border; 0 = about as dense as the others
  FigureJoin join = FigureJoin::Apart;
  double bridge = 0.0;     // px, width of bridges; 0 = the space between points / 4
  FigureTree tree = FigureTree::Steps;
  std::string start = "bottom";  // bottom, top, left, right, centre, or "x,y" in px
  FigureLines lines = FigureLines::Curved;
  double curl = 0.35;      // length of the curves' handles, in distances between borders, 0..0.8
  double fullness = 1.0;   // share of the inner cells with a curve of their own
  FigureThickness thickness = FigureThickness::Descendants;
  double exponent = 2.5;   // width^exponent adds up where branches meet
  double thinnest = 0.0;   // px, width of the last twigs; 0 = from the space between points
};
std::vector<OptionField> describe(FigureOptions& options);

struct FilledFigure {
  Skeleton skeleton;      // canvas = the picture's size
  Mask region;            // the shape, with bridges
  LabelImage cell;        // cell of every pixel, kNone outside
  std::vector<Vec2> sites;       // px, one a cell
  std::vector<int> parents;      // cell each cell hangs on, kNone for roots
  int islands = 0;        // 4-connected parts of the shape that were filled
  int reached = 0;        // cells that are part of a tree; all of them in geodesic mode
  int straightened = 0;   // curves that would have left the shape and follow a way inside it instead
};

// `shape`: what is not 0 is filled. Throws InputError for an empty shape or one whose parts are all smaller than 3 px.
// Parts too small are left out with a note.
FilledFigure grow_figure(const Mask& shape, const FigureOptions& options, const Rng& rng, const Monitor& monitor);

}  // namespace ramify
