// SPDX-License-Identifier: GPL-3.0-or-later
// A picture made of filled curves in layers: what every style of painting ends in, and what is written as SVG or as
// pixels. Nothing is stroked: lines of changing width are closed outlines.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "ramify/core/monitor.h"
#include "ramify/geometry/bezier.h"
#include "ramify/image/image.h"

namespace ramify {

struct Shape {
  std::vector<std::vector<CubicBezier>> loops;  // px of the canvas; closed; filled by the non-zero rule
  Rgb color;                                    // sRGB-encoded
  double opacity = 1.0;                         // 0..1
};

enum class Blend {
  Over,  // paint, in encoded values as drawing programs do
  Add,   // light: added in linear light where pixels are made, "screen" in SVG
  Wash   // watercolour: takes light away (wash.h) where pixels are made, "multiply" in SVG
};

struct Layer {
  std::string name;           // as a drawing program shows it
  std::vector<Shape> shapes;  // bottom first
  Blend blend = Blend::Over;
  double blur = 0.0;     // px, Gaussian; Add: of the light; Wash: how far water carries pigment, in pixels only
  double opacity = 1.0;  // 0..1, of the layer as one; not for Add
};

struct Drawing {
  Size size;                      // px of the canvas
  std::optional<Rgb> background;  // none = transparent
  std::vector<Layer> layers;      // bottom first
};

int node_count(const Drawing& drawing);  // end points of curves: what a node tool shows

// SVG 1.1 with Inkscape layers, viewBox = canvas (pixel centres at half integers), shown `scale` times as large.
// `recipe` is stored as metadata unless it is empty.
std::string drawing_svg(const Drawing& drawing, double scale = 1.0, const std::string& recipe = "");

// The recipe that drawing_svg stored, or "".
std::string recipe_of_svg(const std::string& svg);

// Pixels of a drawing: opacity is straight, not multiplied into the colours.
struct Raster {
  ColorImage color;
  Mask alpha;  // 255 everywhere when there is a background
};

struct RasterOptions {
  Size size;                       // px of the picture
  double scale = 1.0;              // picture px per canvas px
  Vec2 shift = Vec2::Zero();       // px of the picture: where the canvas's corner lies
  const ColorImage* over = nullptr;  // background of the picture's size instead of the drawing's
};

inline constexpr int kMostRasterSide = 32767;  // px, cairo's own limit

// The same pixels for any number of threads. Throws LimitError for a picture with a side above kMostRasterSide.
Raster rasterize(const Drawing& drawing, const RasterOptions& options, const Monitor& monitor);

}  // namespace ramify
