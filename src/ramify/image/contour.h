// SPDX-License-Identifier: GPL-3.0-or-later
// Lines of equal value in a picture, by marching squares.
#pragma once

#include <vector>

#include "ramify/image/image.h"

namespace ramify {

struct Contour {
  std::vector<Vec2> points;  // px, about one per pixel crossed; values below the level lie to the right (on the screen)
  bool closed = false;       // then the last point joins the first; else both ends lie on the picture's border
};

// Linear between pixel centres; where four pixels alternate, the lower ones are kept apart. Contours come in reading
// order of their first point.
std::vector<Contour> trace_contours(const ScalarImage& image, float level);

}  // namespace ramify
