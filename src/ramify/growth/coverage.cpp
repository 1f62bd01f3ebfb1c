// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/growth/coverage.h"

#include <algorithm>
#include <cmath>

namespace ramify {

Coverage::Coverage(Size size, double reach)
    : reach_(reach),
      cell_(std::clamp(reach / 6.0, 2.0, 16.0)),
      columns_(static_cast<int>(std::ceil(size.width / cell_))),
      rows_(static_cast<int>(std::ceil(size.height / cell_))),
      weight_(static_cast<std::size_t>(columns_) * rows_, 0.0),
      count_(weight_.size(), 0) {}

int Coverage::cell_at(const Vec2& point) const {
  const int x = static_cast<int>(std::floor((point.x() + 0.5) / cell_));
  const int y = static_cast<int>(std::floor((point.y() + 0.5) / cell_));
  return x < 0 || y < 0 || x >= columns_ || y >= rows_ ? kNone : y * columns_ + x;
}

double Coverage::reach_at(const Vec2& point) const {
  const int cell = cell_at(point);
  // Where half as much is wanted, branches stand twice as far apart (PICTURES 12.2-11).
  return reach_ / std::max(0.12, cell == kNone ? 1.0 : weight(cell));
}

void Coverage::cover(const Vec2& point, double radius, int change) {
  const double reach = radius + reach_at(point);
  const int x0 = std::max(0, static_cast<int>((point.x() - reach) / cell_));
  const int y0 = std::max(0, static_cast<int>((point.y() - reach) / cell_));
  const int x1 = std::min(columns_ - 1, static_cast<int>((point.x() + reach) / cell_));
  const int y1 = std::min(rows_ - 1, static_cast<int>((point.y() + reach) / cell_));
  for (int y = y0; y <= y1; ++y) {
    for (int x = x0; x <= x1; ++x) {
      if ((center(x, y) - point).squaredNorm() <= reach * reach) count_[static_cast<std::size_t>(y) * columns_ + x] += change;
    }
  }
}

double Coverage::unfilled(const Vec2& point) const {
  const int cell = cell_at(point);
  return cell == kNone || covered(cell) ? 0.0 : weight(cell);
}

double Coverage::filled_share() const {
  double all = 0.0, filled = 0.0;
  for (int i = 0; i < cells(); ++i) {
    all += weight(i);
    filled += covered(i) ? weight(i) : 0.0;
  }
  return all > 0.0 ? filled / all : 1.0;
}

}  // namespace ramify
