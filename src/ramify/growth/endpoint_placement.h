// SPDX-License-Identifier: GPL-3.0-or-later
// Where the paths of a dendrite shall end: at random, never too near to each other (Xu & Mould 2007, sections 3 and 3.2;
// ALGORITHMS 8.6).
#pragma once

#include <functional>
#include <vector>

#include "ramify/core/random.h"
#include "ramify/image/image.h"

namespace ramify {

// Points of the plane of which no two are nearer than `spacing` (px).
class SpacedPoints {
 public:
  SpacedPoints(Size canvas, double spacing);

  // Takes the point unless another one is too near; says whether it did.
  bool add(double x, double y);

 private:
  int cell(double x, double y) const;

  double spacing_, pitch_;
  int columns_, rows_;
  std::vector<Vec2> points_;
  std::vector<int> first_, next_;  // lists of points by cell
};

// At most `count` of `candidates` (lattice nodes of a canvas, distinct), in random order, none nearer than `spacing` (px)
// to another. Every candidate is tried at most once, so fewer come out only when no more fit.
std::vector<int> choose_spaced(std::vector<int> candidates, Size canvas, int count, double spacing, Rng rng);

// Ends of a lightning's side strokes: scattered (Gaussian, `scatter` px) around nodes of the structure, kept the more
// likely the farther below their node they lie (section 4: "in the vicinity of the main strokes, with a bias towards
// placing them lower"). structure: nodes; usable: 255 where an endpoint may lie.
std::vector<int> choose_below(const std::vector<int>& structure, const Mask& usable, int count, double scatter, double spacing, Rng rng);

// Tips of hairs that stand on the structure's nodes: `height` px above one, 0.6 to 1 of it, a little to the side.
std::vector<int> choose_above(const std::vector<int>& structure, const Mask& usable, int count, double height, double spacing, Rng rng);

}  // namespace ramify
