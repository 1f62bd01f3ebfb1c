// SPDX-License-Identifier: GPL-3.0-or-later
// Colours by name and by number.
#pragma once

#include <string>
#include <vector>

#include "ramify/image/image.h"

namespace ramify {

struct Palette {
  std::string name;
  std::vector<Rgb> colors;  // sRGB-encoded, at least one
};

const std::vector<Palette>& named_palettes();

// A palette's name, or colours "#rgb" or "#rrggbb" separated by commas. Throws OptionError for `option`.
std::vector<Rgb> parse_palette(const std::string& option, const std::string& text);
Rgb parse_color(const std::string& option, const std::string& text);

// The colour at t in 0..1 along the list, mixed in Lab so that steps look even.
Rgb color_along(const std::vector<Rgb>& colors, double t);
Rgb mix(const Rgb& a, const Rgb& b, double t);

}  // namespace ramify
