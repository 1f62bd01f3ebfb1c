// SPDX-License-Identifier: GPL-3.0-or-later
// Text as filled curves, set with HarfBuzz from a font that FreeType reads and fontconfig finds.
#pragma once

#include <string>
#include <vector>

#include "ramify/geometry/bezier.h"
#include "ramify/image/image.h"

namespace ramify {

struct Lettering {
  Size size;                                    // px, text and a margin of a sixth of the height
  std::vector<std::vector<CubicBezier>> loops;  // px, closed, filled by the non-zero rule
  std::vector<double> baselines;                // px, y of every line
  std::vector<std::pair<double, double>> extents;  // px, x from and to of every line's ink
};

// The file of a font: `font` is a path, or a name such as "DejaVu Serif:bold". Throws InputError when there is no such
// font, naming the nearest.
std::string find_font(const std::string& font);

// `text` is UTF-8, lines end with a line feed; `height` is the size of an em in px (1..10000). Throws OptionError for
// text that is empty or no UTF-8, InputError for a character that the font lacks or a font that cannot be read.
Lettering set_text(const std::string& text, const std::string& font_file, double height);

// Where ink covers at least half of a pixel: 255.
Mask text_mask(const Lettering& lettering);

}  // namespace ramify
