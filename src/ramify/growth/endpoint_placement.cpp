// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/growth/endpoint_placement.h"

#include <algorithm>
#include <cmath>

namespace ramify {
namespace {

constexpr int kTries = 50;  // per endpoint (ALGORITHMS 8.6)

// Draws places around nodes of the structure until `count` are taken or the tries are used up. `offset` gives the
// displacement (px) from a node, or none where the draw is refused.
template <class Offset>
std::vector<int> scatter_around(const std::vector<int>& structure, const Mask& usable, int count, double spacing, Rng& rng,
                                const Offset& offset) {
  std::vector<int> out;
  if (structure.empty()) return out;
  SpacedPoints taken(usable.size(), spacing);
  const int nodes = static_cast<int>(structure.size());
  for (long long tries = static_cast<long long>(count) * kTries; tries > 0 && static_cast<int>(out.size()) < count; --tries) {
    const int cell = structure[static_cast<std::size_t>(rng.below(nodes))];
    Vec2 step;
    if (!offset(step)) continue;
    const int x = static_cast<int>(std::lround(cell % usable.width() + step.x()));
    const int y = static_cast<int>(std::lround(cell / usable.width() + step.y()));
    if (!usable.contains(x, y) || usable(x, y) == 0) continue;
    if (taken.add(x, y)) out.push_back(y * usable.width() + x);
  }
  return out;
}

}  // namespace

SpacedPoints::SpacedPoints(Size canvas, double spacing)
    : spacing_(spacing), pitch_(std::max(1.0, spacing)), columns_(static_cast<int>(canvas.width / pitch_) + 1),
      rows_(static_cast<int>(canvas.height / pitch_) + 1), first_(static_cast<std::size_t>(columns_) * rows_, kNone) {}

int SpacedPoints::cell(double x, double y) const {
  const int column = std::clamp(static_cast<int>(x / pitch_), 0, columns_ - 1);
  const int row = std::clamp(static_cast<int>(y / pitch_), 0, rows_ - 1);
  return row * columns_ + column;
}

bool SpacedPoints::add(double x, double y) {
  const int home = cell(x, y), column = home % columns_, row = home / columns_;
  for (int r = std::max(0, row - 1); r <= std::min(rows_ - 1, row + 1); ++r) {
    for (int c = std::max(0, column - 1); c <= std::min(columns_ - 1, column + 1); ++c) {
      for (int i = first_[static_cast<std::size_t>(r * columns_ + c)]; i != kNone; i = next_[static_cast<std::size_t>(i)]) {
        if ((points_[static_cast<std::size_t>(i)] - Vec2(x, y)).squaredNorm() < spacing_ * spacing_) return false;
      }
    }
  }
  next_.push_back(first_[static_cast<std::size_t>(home)]);
  first_[static_cast<std::size_t>(home)] = static_cast<int>(points_.size());
  points_.emplace_back(x, y);
  return true;
}

std::vector<int> choose_spaced(std::vector<int> candidates, Size canvas, int count, double spacing, Rng rng) {
  std::vector<int> out;
  SpacedPoints taken(canvas, spacing);
  for (std::size_t left = candidates.size(); left > 0 && static_cast<int>(out.size()) < count; --left) {
    const auto pick = static_cast<std::size_t>(rng.below(static_cast<int>(left)));
    const int node = candidates[pick];
    candidates[pick] = candidates[left - 1];
    if (taken.add(node % canvas.width, node / canvas.width)) out.push_back(node);
  }
  return out;
}

std::vector<int> choose_below(const std::vector<int>& structure, const Mask& usable, int count, double scatter, double spacing, Rng rng) {
  return scatter_around(structure, usable, count, spacing, rng, [&](Vec2& step) {
    step = {scatter * rng.normal(), scatter * rng.normal()};
    return step.y() > 0.0 && rng.uniform() < step.y() / (2.0 * scatter);
  });
}

std::vector<int> choose_above(const std::vector<int>& structure, const Mask& usable, int count, double height, double spacing, Rng rng) {
  return scatter_around(structure, usable, count, spacing, rng, [&](Vec2& step) {
    step = {0.25 * height * rng.normal(), -height * rng.uniform(0.6, 1.0)};
    return true;
  });
}

}  // namespace ramify
