// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/image/morphology.h"

#include <algorithm>

#include "ramify/core/parallel.h"

namespace ramify {
namespace {

// Extremes over windows of a line by running extremes of blocks from both sides; beyond the ends counts nothing.
template <class Better>
void line_extreme(std::vector<float>& line, int radius, Better better) {
  const int n = static_cast<int>(line.size()), window = 2 * radius + 1;
  std::vector<float> ahead(line), behind(line);
  for (int i = 1; i < n; ++i) {
    if (i % window != 0) ahead[i] = better(ahead[i - 1], line[i]);
  }
  for (int i = n - 2; i >= 0; --i) {
    if ((i + 1) % window != 0) behind[i] = better(behind[i + 1], line[i]);
  }
  for (int i = 0; i < n; ++i) {
    const int from = i - radius, to = std::min(i + radius, n - 1);
    if (from <= 0) {
      // The window begins at the line's start: blocks before `to` are whole.
      float value = ahead[to];
      for (int block = to / window * window - 1; block >= 0; block -= window) value = better(value, ahead[block]);
      line[i] = value;
    } else {
      // At the line's end both may lie in one block, which then ends where the window ends.
      line[i] = from / window == to / window ? behind[from] : better(behind[from], ahead[to]);
    }
  }
}

template <class Better>
ScalarImage extreme(const ScalarImage& image, int radius, Better better) {
  ScalarImage out = image;
  if (radius <= 0 || image.empty()) return out;
  parallel_for(image.height(), [&](int y) {
    std::vector<float> line(out.row(y), out.row(y) + out.width());
    line_extreme(line, radius, better);
    std::copy(line.begin(), line.end(), out.row(y));
  }, 16);
  parallel_for(image.width(), [&](int x) {
    std::vector<float> line(static_cast<std::size_t>(out.height()));
    for (int y = 0; y < out.height(); ++y) line[y] = out(x, y);
    line_extreme(line, radius, better);
    for (int y = 0; y < out.height(); ++y) out(x, y) = line[y];
  }, 16);
  return out;
}

}  // namespace

ScalarImage lowest_around(const ScalarImage& image, int radius) {
  return extreme(image, radius, [](float a, float b) { return std::min(a, b); });
}

ScalarImage highest_around(const ScalarImage& image, int radius) {
  return extreme(image, radius, [](float a, float b) { return std::max(a, b); });
}

ScalarImage top_hat(const ScalarImage& image, int radius, bool bright) {
  ScalarImage out = bright ? highest_around(lowest_around(image, radius), radius)
                           : lowest_around(highest_around(image, radius), radius);
  for (std::size_t i = 0; i < out.pixels().size(); ++i) {
    out.pixels()[i] = std::max(0.0f, bright ? image.pixels()[i] - out.pixels()[i] : out.pixels()[i] - image.pixels()[i]);
  }
  return out;
}

}  // namespace ramify
