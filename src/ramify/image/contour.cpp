// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/image/contour.h"

#include <algorithm>
#include <array>

namespace ramify {
namespace {

// Edges of the pixel grid: 2 (y width + x) is the edge from (x, y) to the right, + 1 the one downwards.
class Tracer {
 public:
  Tracer(const ScalarImage& image, float level)
      : image_(image), level_(level), next_(image.pixels().size() * 2, kNone), previous_(next_) {}

  std::vector<Contour> run() {
    for (int y = 0; y + 1 < image_.height(); ++y) {
      for (int x = 0; x + 1 < image_.width(); ++x) link_cell(x, y);
    }
    std::vector<Contour> contours;
    std::vector<bool> used(next_.size(), false);
    for (const bool closed : {false, true}) {
      for (std::size_t e = 0; e < next_.size(); ++e) {
        const bool starts = closed ? next_[e] != kNone : next_[e] != kNone && previous_[e] == kNone;
        if (!starts || used[e]) continue;
        Contour contour;
        contour.closed = closed;
        for (int k = static_cast<int>(e); k != kNone && !used[k]; k = next_[k]) {
          used[k] = true;
          contour.points.push_back(crossing(k));
        }
        contours.push_back(std::move(contour));
      }
    }
    return contours;
  }

 private:
  bool below(int x, int y) const { return image_(x, y) < level_; }
  int edge(int x, int y, bool down) const { return 2 * (y * image_.width() + x) + (down ? 1 : 0); }

  Vec2 crossing(int e) const {
    const int x = e / 2 % image_.width(), y = e / 2 / image_.width();
    const bool down = e % 2 == 1;
    const double a = image_(x, y), b = down ? image_(x, y + 1) : image_(x + 1, y);
    const double t = a == b ? 0.5 : std::clamp((level_ - a) / (b - a), 0.0, 1.0);
    return down ? Vec2(x, y + t) : Vec2(x + t, y);
  }

  void link(int from, int to) {
    next_[from] = to;
    previous_[to] = from;
  }

  // Walks around the cell: the contour enters where the corners change from low to high in clockwise order and leaves
  // at the next change back, with the low corner to its right.
  void link_cell(int x, int y) {
    const std::array<bool, 4> low = {below(x, y), below(x + 1, y), below(x + 1, y + 1), below(x, y + 1)};
    const std::array<int, 4> side = {edge(x, y, false), edge(x + 1, y, true), edge(x, y + 1, false), edge(x, y, true)};
    for (int i = 0; i < 4; ++i) {
      if (low[i] || !low[(i + 1) % 4]) continue;  // side i goes from high to low, clockwise
      int j = (i + 1) % 4;
      while (low[(j + 1) % 4]) j = (j + 1) % 4;   // side j goes back to high
      link(side[j], side[i]);
    }
  }

  const ScalarImage& image_;
  float level_;
  std::vector<int> next_, previous_;
};

}  // namespace

std::vector<Contour> trace_contours(const ScalarImage& image, float level) { return Tracer(image, level).run(); }

}  // namespace ramify
