// SPDX-License-Identifier: GPL-3.0-or-later
// Leaves and flowers as filled curves.
#pragma once

#include <vector>

#include "ramify/paint/drawing.h"

namespace ramify {

enum class LeafShape { Ovate, Lance, Heart, Ivy, Oak, Round };

struct LeafPose {
  Vec2 base = Vec2::Zero();  // px, where the blade starts
  double angle = 0.0;        // rad, from the base to the tip
  double size = 20.0;        // px, length of the blade, > 0
  double bend = 0.0;         // rad, turn of the midrib from base to tip
  double breadth = 1.0;      // factor on its width: less than 1 for a leaf seen from the side
};

struct LeafColors {
  Rgb blade, shade, vein, edge;  // lit half, other half, veins, rim
};

// Rim, blade, shaded half and veins, in this order; veins only on leaves large enough to show them.
std::vector<Shape> leaf_shapes(LeafShape shape, const LeafPose& pose, const LeafColors& colors);

// Five petals around a centre.
std::vector<Shape> flower_shapes(const Vec2& centre, double radius, double angle, const Rgb& petal, const Rgb& heart);

// A blob: a circle of four curves.
Shape disc_shape(const Vec2& centre, double radius, const Rgb& color);

}  // namespace ramify
