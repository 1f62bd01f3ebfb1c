// SPDX-License-Identifier: GPL-3.0-or-later
// Where leaves, flowers and tendrils sit on strokes.
#pragma once

#include <vector>

#include "ramify/core/random.h"
#include "ramify/paint/leaf.h"
#include "ramify/paint/stroke.h"

namespace ramify {

enum class Phyllotaxis { Alternate, Spiral, Opposite };

struct FoliageOptions {
  double size = 0.0;     // px, length of a blade; 0 = from the space between the branches
  double density = 1.0;  // how close together along a branch, >= 0
  Phyllotaxis phyllotaxis = Phyllotaxis::Alternate;
  double flowers = 0.0;   // share of the tips that end in a flower, 0..1
  double tendrils = 0.1;  // share of the tips that end in a tendril, 0..1
};

struct Leaf {
  LeafPose pose;              // full-grown
  Vec2 stem = Vec2::Zero();   // px, where the leaf's stalk leaves the branch
  double birth = 0.0;         // px along the way from the root
  bool behind = false;        // drawn under the branches
  double tone = 0.0;          // 0..1, picks its colour
};

struct Flower {
  Vec2 centre = Vec2::Zero();
  double radius = 0.0;  // px
  double angle = 0.0;
  double birth = 0.0;
};

struct Foliage {
  double leaf_size = 0.0;  // px, what was chosen
  std::vector<Leaf> leaves;
  std::vector<Flower> flowers;
  std::vector<Stroke> tendrils;
};

// Leaves stand along thin branches: on both sides in turn, or by the golden angle around the stem as seen from the side,
// or in pairs; one at every tip. Leaves that would cover another's middle are left out, and so are those that lie more
// than a fifth outside `shape` (of the canvas's size; empty = anywhere).
Foliage place_foliage(const std::vector<Stroke>& strokes, Size canvas, const FoliageOptions& options, const Rng& rng,
                      const Mask& shape = {});

}  // namespace ramify
