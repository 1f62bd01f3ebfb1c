// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/growth/mask_strokes.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "ramify/geometry/polyline.h"
#include "ramify/growth/ways.h"
#include "ramify/image/filter.h"

namespace ramify {
namespace {

using Path = std::vector<Vec2>;

constexpr double kSmooth = 8.0;  // px, sigma along a path out of a mask

struct Bridge {
  Vec2 from, to;  // px
};

// The narrowest place of the stroke round a hole: from the hole to the black beyond. Nothing for a speck inside a stroke.
std::optional<Bridge> narrowest_place(const LabelImage& black, int hole) {
  Mask beyond(black.size());
  double area = 0.0;
  for (std::size_t i = 0; i < black.pixels().size(); ++i) {
    beyond.pixels()[i] = black.pixels()[i] != kNone && black.pixels()[i] != hole ? 255 : 0;
    area += black.pixels()[i] == hole ? 1.0 : 0.0;
  }
  const ScalarImage distance = distance_to(beyond);
  Vec2 from = Vec2::Zero();
  double width = std::numeric_limits<double>::infinity();
  for (int y = 0; y < black.height(); ++y) {
    for (int x = 0; x < black.width(); ++x) {
      if (black(x, y) == hole && distance(x, y) < width) width = distance(x, y), from = Vec2(x, y);
    }
  }
  if (!(area > width * width)) return std::nullopt;
  const int reach = static_cast<int>(std::ceil(width));
  Vec2 to = from;
  double nearest = std::numeric_limits<double>::infinity();
  for (int dy = -reach; dy <= reach; ++dy) {
    for (int dx = -reach; dx <= reach; ++dx) {
      const Vec2 p = from + Vec2(dx, dy);
      const int x = static_cast<int>(p.x()), y = static_cast<int>(p.y());
      const double far = Vec2(dx, dy).norm();
      if (beyond.contains(x, y) && beyond(x, y) != 0 && far < nearest) nearest = far, to = p;
    }
  }
  return Bridge{from, to};
}

// Three pixels wide: white hangs together across corners.
void cut_across(Mask& white, const Bridge& bridge) {
  const int samples = 1 + static_cast<int>(2.0 * (bridge.to - bridge.from).norm());
  for (int i = 0; i <= samples; ++i) {
    const Vec2 p = bridge.from + (bridge.to - bridge.from) * (static_cast<double>(i) / samples);
    for (int dy = -1; dy <= 1; ++dy) {
      for (int dx = -1; dx <= 1; ++dx) {
        const int x = static_cast<int>(std::lround(p.x())) + dx, y = static_cast<int>(std::lround(p.y())) + dy;
        if (white.contains(x, y)) white(x, y) = 0;
      }
    }
  }
}

// A tree holds no ring: every ring is cut through where it is narrowest.
void open_rings(Mask& white) {
  for (bool cut = true; cut;) {
    cut = false;
    int count = 0;
    const LabelImage black = label_components(invert(white), false, count);
    const int frame = black(0, 0);  // the rim of the map is black, hence one
    for (int hole = 0; hole < count && !cut; ++hole) {
      if (hole == frame) continue;
      const std::optional<Bridge> bridge = narrowest_place(black, hole);
      if (!bridge) continue;
      cut_across(white, *bridge);
      cut = true;
    }
  }
}

// White at least half bright. The outermost pixels count as black: what lies between a stroke and the frame is no hole.
Mask white_of(const ScalarImage& map) {
  Mask white(map.size());
  for (int y = 1; y + 1 < map.height(); ++y) {
    for (int x = 1; x + 1 < map.width(); ++x) white(x, y) = map(x, y) < 0.5f ? 0 : 255;
  }
  return white;
}

// The white as ways along its middle, one line after the other.
class Strokes {
 public:
  explicit Strokes(const Mask& white) : white_(white), depth_(distance_to(invert(white))), drawn_(costs(), white.width(), 1.0) {}

  // Farthest first: the two ends farthest apart, then whatever is farther from all lines than the brush is wide.
  std::vector<Path> lines() {
    std::vector<Path> lines;
    for (int first = unseen(); first != kNone; first = unseen()) {
      const int one = farthest_from(first);
      drawn_.start_at(one, one);
      for (int end = farthest(); end != kNone; end = farthest()) {
        const std::vector<int> way = drawn_.way(end);
        Path line;
        for (const int cell : way) line.push_back(point(cell));
        for (const int cell : way) drawn_.start_at(cell, cell);
        lines.push_back(smooth_polyline(line, kSmooth));
      }
    }
    return lines;
  }

 private:
  std::vector<double> costs() const {
    std::vector<double> cost;
    for (int cell = 0; cell < cells(); ++cell) {
      const double d = depth_.pixels()[static_cast<std::size_t>(cell)];
      cost.push_back(white(cell) ? 1.0 + 16.0 / (d * d) : std::numeric_limits<double>::infinity());
    }
    return cost;
  }
  Vec2 point(int cell) const { return {cell % white_.width(), cell / white_.width()}; }
  int cells() const { return static_cast<int>(white_.pixels().size()); }
  bool white(int cell) const { return white_.pixels()[static_cast<std::size_t>(cell)] != 0; }

  int unseen() const {
    for (int cell = 0; cell < cells(); ++cell) {
      if (white(cell) && !drawn_.reached(cell)) return cell;
    }
    return kNone;
  }
  // A stroke is a line's end only where the way to it is longer than the brush is wide.
  int farthest() const {
    int best = kNone;
    double length = 0.0;
    for (int cell = 0; cell < cells(); ++cell) {
      if (!drawn_.reached(cell) || drawn_.length(cell) <= length) continue;
      const double brush = depth_.pixels()[static_cast<std::size_t>(drawn_.source(cell))];
      if (drawn_.length(cell) < 3.0 * brush + 12.0) continue;
      best = cell;
      length = drawn_.length(cell);
    }
    return best;
  }
  int farthest_from(int start) const {
    Ways ways(costs(), white_.width(), 1.0);
    ways.start_at(start, 0);
    int best = start;
    for (int cell = 0; cell < cells(); ++cell) {
      if (ways.reached(cell) && ways.length(cell) > ways.length(best)) best = cell;
    }
    return best;
  }

  const Mask& white_;
  ScalarImage depth_;
  Ways drawn_;
};

}  // namespace

std::vector<std::vector<Vec2>> mask_strokes(const ScalarImage& map) {
  Mask white = white_of(map);
  open_rings(white);
  return Strokes(white).lines();
}

}  // namespace ramify
