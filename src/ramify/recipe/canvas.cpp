// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/recipe/canvas.h"

#include <cmath>

#include "ramify/core/options.h"

namespace ramify {

Size parse_canvas(const std::string& text) {
  const std::size_t cross = text.find('x');
  double width = 0, height = 0;
  const bool numbers = cross != std::string::npos && parse_number(text.substr(0, cross), width) && parse_number(text.substr(cross + 1), height);
  if (!numbers || width < 1 || height < 1 || width != std::floor(width) || height != std::floor(height) || width > 1e9 || height > 1e9) {
    throw OptionError("size", "'" + printable(text, 60) + "'", "expected WIDTHxHEIGHT in px, such as 1600x1076");
  }
  return {static_cast<int>(width), static_cast<int>(height)};
}

void check_canvas(Size size, const LoadLimits& limits, int bytes_per_pixel) {
  const double pixels = static_cast<double>(size.width) * size.height;
  if (pixels <= limits.pixels) return;
  throw LimitError("a canvas of " + std::to_string(size.width) + "x" + std::to_string(size.height) + " px needs about " +
                   number_text(std::round(pixels * bytes_per_pixel / 1048576)) + " MiB; the limit is " + number_text(limits.pixels) +
                   " px (--limit-pixels)");
}

}  // namespace ramify
