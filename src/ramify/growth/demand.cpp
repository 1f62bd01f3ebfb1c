// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/growth/demand.h"

#include <algorithm>
#include <cmath>

#include "ramify/image/filter.h"

namespace ramify {
namespace {

constexpr double kOfStroke = 0.35;   // of a stroke's half width: three strands side by side make it readable
constexpr double kOfSide = 1.0 / 32; // of the canvas's smaller side: shades are told apart over two spacings
constexpr double kWindow = 32.0;     // px, at least: shades are judged over cells of 64 px (PICTURES 9)

// Visits the cells whose centres lie within `reach` px of a point, with the cone's weight (it sums to 1 over the plane).
template <class Visit>
void through_window(const Vec2& point, double reach, double cell, int columns, int rows, Visit&& visit) {
  const double scale = 3.0 * cell * cell / (kPi * reach * reach);
  const int x0 = std::max(0, static_cast<int>((point.x() - reach) / cell)), x1 = std::min(columns - 1, static_cast<int>((point.x() + reach) / cell));
  const int y0 = std::max(0, static_cast<int>((point.y() - reach) / cell)), y1 = std::min(rows - 1, static_cast<int>((point.y() + reach) / cell));
  for (int y = y0; y <= y1; ++y) {
    for (int x = x0; x <= x1; ++x) {
      const double far = std::hypot((x + 0.5) * cell - 0.5 - point.x(), (y + 0.5) * cell - 0.5 - point.y()) / reach;
      if (far < 1.0) visit(static_cast<std::size_t>(y) * columns + x, scale * (1.0 - far));
    }
  }
}

}  // namespace

double painted_spacing(const Style& style, const Ground& ground) {
  const double own = style.hierarchy.spacing;
  if (!ground.painted()) return own;
  const Size size = ground.size();
  Mask dark(size);
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) dark(x, y) = ground.wanted(Vec2(x, y)) <= kBlack ? 255 : 0;
  }
  double side = std::min(size.width, size.height);
  const ScalarImage depth = distance_to(dark);
  double sum = 0.0, weights = 0.0;
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      const double weight = ground.wanted(Vec2(x, y));
      sum += weight * std::min<double>(depth(x, y), side);
      weights += weight;
    }
  }
  // In a strip the mean depth is half the half width.
  const double half_width = weights > 0.0 ? 2.0 * sum / weights : side;
  const double readable = std::min(kOfStroke * half_width, kOfSide * side);
  return std::min(own, std::max(readable, 3.0 * style.hierarchy.least_radius + 2.0));
}

Demand::Demand(const Ground& ground, double spacing, double length)
    : cell_(std::clamp(spacing / 3.0, 4.0, 12.0)),
      window_(std::max(kWindow, 2.0 * spacing)),
      full_(length / spacing),
      columns_(static_cast<int>(std::ceil(ground.size().width / cell_))),
      rows_(static_cast<int>(std::ceil(ground.size().height / cell_))),
      wanted_(static_cast<std::size_t>(columns_) * rows_, 0.0),
      around_(wanted_.size(), 0.0),
      grown_(wanted_.size(), 0.0) {
  constexpr int kSamples = 4;
  for (int c = 0; c < cells(); ++c) {
    double sum = 0.0;
    for (int i = 0; i < kSamples * kSamples; ++i) {
      const Vec2 offset((i % kSamples + 0.5) / kSamples - 0.5, (i / kSamples + 0.5) / kSamples - 0.5);
      sum += ground.wanted(center_of(c) + cell_ * offset);
    }
    wanted_[static_cast<std::size_t>(c)] = sum / (kSamples * kSamples);
  }
  for (int c = 0; c < cells(); ++c) {
    if (wanted(c) <= 0.0) continue;
    through_window(center_of(c), window_, cell_, columns_, rows_,
                   [&](std::size_t to, double weight) { around_[to] += weight * wanted(c); });
  }
}

int Demand::cell_at(const Vec2& point) const {
  const int x = static_cast<int>(std::floor((point.x() + 0.5) / cell_));
  const int y = static_cast<int>(std::floor((point.y() + 0.5) / cell_));
  return x < 0 || y < 0 || x >= columns_ || y >= rows_ ? kNone : y * columns_ + x;
}

void Demand::add(const Vec2& a, const Vec2& b, int change) {
  if (wanted_.empty()) return;
  const double value = change * (b - a).norm() / (full_ * cell_ * cell_);
  through_window(0.5 * (a + b), window_, cell_, columns_, rows_,
                 [&](std::size_t to, double weight) { grown_[to] += weight * value; });
}

double Demand::lack(const Vec2& point) const {
  const int cell = cell_at(point);
  return cell == kNone ? 0.0 : lack(cell);
}

double Demand::unfilled(const Vec2& point) const {
  const int cell = cell_at(point);
  return cell == kNone ? 0.0 : std::clamp(lack(cell), 0.0, wanted(cell));
}

}  // namespace ramify
