// SPDX-License-Identifier: GPL-3.0-or-later
// The paths of an SVG drawing, as polylines in pixels. Only path elements are read; entities, scripts, styles sheets and
// references are not. Text inside <defs>, <symbol>, <clipPath>, <mask>, <marker> and <pattern> is skipped.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "ramify/core/types.h"

namespace ramify {

struct SvgPath {
  std::vector<Vec2> points;    // px, pixel centres at whole numbers (0.5 is taken off); one subpath
  bool stroked = false;        // has a stroke of its own or from a group around it
  double stroke_width = 0.0;   // px; 0 when the drawing names none
  std::vector<std::pair<std::string, std::string>> attributes;  // data-NAME attributes, by NAME

  std::string data(std::string_view name) const;  // "" when absent
};

struct SvgDrawing {
  Size size;  // px: the viewBox, or width and height, or {0, 0}
  std::vector<SvgPath> paths;
};

// Transforms are applied, the viewBox's corner is the canvas's corner, curves are flattened to within 0.05 px. Throws
// InputError for malformed XML or path data and for points beyond 1e7 px, LimitError for more than 64 MB, 1e7 points or 256 nested elements.
SvgDrawing parse_svg(std::string_view text, const std::string& name);

// The data of one `d` attribute as subpaths, without transform. Throws InputError.
std::vector<std::vector<Vec2>> parse_path_data(std::string_view data, const std::string& name);

}  // namespace ramify
