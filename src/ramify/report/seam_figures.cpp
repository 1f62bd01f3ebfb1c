// SPDX-License-Identifier: GPL-3.0-or-later
// Figures that need to know where the pixels come from (ALGORITHMS 7.2, 7.4b).
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "ramify/report/picture_figures.h"

namespace ramify {
namespace {

constexpr int kBeside = 6;            // px from the seam to the curves it is compared with
constexpr int kSeamPixels = 24;       // edges a tile needs to be judged

double step(const ColorImage& color, int x, int y, int dx, int dy) {
  const Rgb d = color(x + dx, y + dy) - color(x, y);
  return std::sqrt(static_cast<double>(d.r * d.r + d.g * d.g + d.b * d.b));
}

struct SeamSums {
  double on = 0.0, beside = 0.0;
  int edges = 0;
  double ratio() const { return edges > 0 && beside > 0.0 ? on / beside : std::numeric_limits<double>::quiet_NaN(); }
};

// Calls add(x, y, on, beside) for every pixel edge between two owners whose curves beside lie inside the picture.
template <class Add>
void visit_seams(const ColorImage& color, const LabelImage& owner, const Add& add) {
  const int w = color.width(), h = color.height();
  for (int y = 0; y < h; ++y) {
    for (int x = 0; x < w; ++x) {
      for (const auto& [dx, dy] : {std::pair{1, 0}, {0, 1}}) {
        if (x + dx >= w || y + dy >= h || owner(x, y) == owner(x + dx, y + dy)) continue;
        const int ax = x - kBeside * dx, ay = y - kBeside * dy, bx = x + kBeside * dx, by = y + kBeside * dy;
        if (ax < 0 || ay < 0 || bx + dx >= w || by + dy >= h) continue;
        add(x, y, step(color, x, y, dx, dy), 0.5 * (step(color, ax, ay, dx, dy) + step(color, bx, by, dx, dy)));
      }
    }
  }
}

}  // namespace

double measure_seam_ratio(const ColorImage& color, const LabelImage& owner) {
  SeamSums sums;
  visit_seams(color, owner, [&](int, int, double on, double beside) { sums.on += on, sums.beside += beside, ++sums.edges; });
  return sums.ratio();
}

std::vector<WorstSeam> find_worst_seams(const ColorImage& color, const LabelImage& owner, int count) {
  const int columns = (color.width() + kSeamTile - 1) / kSeamTile, rows = (color.height() + kSeamTile - 1) / kSeamTile;
  std::vector<SeamSums> tiles(static_cast<std::size_t>(columns) * rows);
  visit_seams(color, owner, [&](int x, int y, double on, double beside) {
    SeamSums& tile = tiles[static_cast<std::size_t>(y / kSeamTile) * columns + x / kSeamTile];
    tile.on += on, tile.beside += beside, ++tile.edges;
  });
  std::vector<WorstSeam> worst;
  for (int i = 0; i < columns * rows; ++i) {
    const double ratio = tiles[i].edges >= kSeamPixels ? tiles[i].ratio() : 0.0;
    if (ratio > 1.0) worst.push_back({i % columns * kSeamTile, i / columns * kSeamTile, ratio});
  }
  std::stable_sort(worst.begin(), worst.end(), [](const WorstSeam& a, const WorstSeam& b) { return a.ratio > b.ratio; });
  worst.resize(std::min<std::size_t>(worst.size(), static_cast<std::size_t>(count)));
  return worst;
}

double measure_offset_peak(const LabelImage& owner, const Image<Eigen::Vector2f>& source) {
  std::map<std::pair<int, int>, int> counts;
  int owned = 0, most = 0;
  for (int y = 0; y < owner.height(); ++y) {
    for (int x = 0; x < owner.width(); ++x) {
      const Eigen::Vector2f from = source(x, y);
      if (owner(x, y) == kNone || !from.allFinite()) continue;
      ++owned;
      const std::pair<int, int> offset(static_cast<int>(std::lround(from.x())) - x, static_cast<int>(std::lround(from.y())) - y);
      most = std::max(most, ++counts[offset]);
    }
  }
  return owned > 0 ? static_cast<double>(most) / owned : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace ramify
