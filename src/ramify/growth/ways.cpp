// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/growth/ways.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>

namespace ramify {

Ways::Ways(std::vector<double> cost, int columns, double cell)
    : cell_(cell),
      columns_(columns),
      rows_(static_cast<int>(cost.size()) / columns),
      cost_(std::move(cost)),
      total_(cost_.size(), std::numeric_limits<double>::infinity()),
      length_(cost_.size(), std::numeric_limits<double>::infinity()),
      from_(cost_.size(), kNone),
      mark_(cost_.size(), kNone) {}

bool Ways::reached(int cell) const { return std::isfinite(cost(cell)); }

void Ways::start_at(int start, int mark) {
  const auto at = [](int cell) { return static_cast<std::size_t>(cell); };
  if (total_[at(start)] <= 0.0) return;
  if (!std::isfinite(cost_[at(start)])) cost_[at(start)] = 1.0;
  total_[at(start)] = length_[at(start)] = 0.0;
  from_[at(start)] = kNone;
  mark_[at(start)] = mark;
  using Open = std::pair<double, int>;
  std::priority_queue<Open, std::vector<Open>, std::greater<Open>> open;
  open.emplace(0.0, start);
  while (!open.empty()) {
    const auto [total, cell] = open.top();
    open.pop();
    if (total > total_[at(cell)]) continue;
    const int x = cell % columns_, y = cell / columns_;
    for (int dy = -1; dy <= 1; ++dy) {
      for (int dx = -1; dx <= 1; ++dx) {
        if ((dx == 0 && dy == 0) || x + dx < 0 || y + dy < 0 || x + dx >= columns_ || y + dy >= rows_) continue;
        const int other = cell + dy * columns_ + dx;
        const double step = cell_ * (dx != 0 && dy != 0 ? std::sqrt(2.0) : 1.0);
        const double reached = total + step * 0.5 * (cost_[at(cell)] + cost_[at(other)]);
        if (!(reached < total_[at(other)])) continue;
        total_[at(other)] = reached;
        length_[at(other)] = length_[at(cell)] + step;
        from_[at(other)] = cell;
        mark_[at(other)] = mark;
        open.emplace(reached, other);
      }
    }
  }
}

std::vector<int> Ways::way(int cell) const {
  std::vector<int> cells;
  for (int at = cell; at != kNone; at = from_[static_cast<std::size_t>(at)]) cells.push_back(at);
  std::reverse(cells.begin(), cells.end());
  return cells;
}

}  // namespace ramify
