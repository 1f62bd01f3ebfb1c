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
std::vector<Region> parse_regions(const std::string& option, const std::string& text);

}  // namespace ramify
