// SPDX-License-Identifier: GPL-3.0-or-later
// Points, strokes and polygons as people type them: "x,y x,y; x,y x,y".
#pragma once

#include <string>
#include <vector>

#include "ramify/exemplar/annotation.h"

namespace ramify {

// Throw OptionError naming `option` and the piece that cannot be read.
std::vector<Vec2> parse_points(const std::string& option, const std::string& text);
std::vector<std::vector<Vec2>> parse_strokes(const std::string& option, const std::string& text);
// Strokes of points "x,y" or, all of them, "x,y,radius".
struct WideStroke {
  std::vector<Vec2> points;   // px
  std::vector<double> radii;  // px, one per point; empty where none were given
};
std::vector<WideStroke> parse_wide_strokes(const std::string& option, const std::string& text);
std::vector<Region> parse_regions(const std::string& option, const std::string& text);

}  // namespace ramify
