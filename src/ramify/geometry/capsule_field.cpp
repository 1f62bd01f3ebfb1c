// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/geometry/capsule_field.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace ramify {
namespace {

class Propagation {
 public:
  Propagation(CapsuleField& field, std::span<const Capsule> capsules) : field_(field), capsules_(capsules) {}

  void offer(int x, int y, int capsule) {
    if (capsule == kNone) return;
    const std::size_t i = static_cast<std::size_t>(y) * field_.columns + x;
    if (field_.nearest[i] == capsule) return;
    const double distance = rim_distance(capsules_[capsule], Vec2(x * field_.cell, y * field_.cell));
    if (distance < field_.distance[i]) {
      field_.distance[i] = distance;
      field_.nearest[i] = capsule;
    }
  }

  void take(int x, int y, int from_x, int from_y) {
    if (from_x < 0 || from_y < 0 || from_x >= field_.columns || from_y >= field_.rows) return;
    offer(x, y, field_.nearest[static_cast<std::size_t>(from_y) * field_.columns + from_x]);
  }

  void seed() {
    for (std::size_t i = 0; i < capsules_.size(); ++i) {
      const Vec2 edge = capsules_[i].b - capsules_[i].a;
      const int steps = 1 + static_cast<int>(edge.norm() / field_.cell);
      for (int s = 0; s <= steps; ++s) {
        const Vec2 p = (capsules_[i].a + edge * (static_cast<double>(s) / steps)) / field_.cell;
        offer(std::clamp(static_cast<int>(std::lround(p.x())), 0, field_.columns - 1),
              std::clamp(static_cast<int>(std::lround(p.y())), 0, field_.rows - 1), static_cast<int>(i));
      }
    }
  }

  void sweep(int step) {
    const int w = field_.columns, h = field_.rows;
    for (int row = 0; row < h; ++row) {
      const int y = step > 0 ? row : h - 1 - row;
      for (int x = 0; x < w; ++x) {
        for (int dx = -1; dx <= 1; ++dx) take(x, y, x + dx, y - step);
        take(x, y, x - 1, y);
      }
      for (int x = w - 1; x >= 0; --x) take(x, y, x + 1, y);
    }
  }

 private:
  CapsuleField& field_;
  std::span<const Capsule> capsules_;
};

}  // namespace

CapsuleField capsule_field(std::span<const Capsule> capsules, Size size, double cell) {
  CapsuleField field;
  field.cell = cell;
  field.columns = 1 + static_cast<int>(std::max(0, size.width - 1) / cell);
  field.rows = 1 + static_cast<int>(std::max(0, size.height - 1) / cell);
  const std::size_t samples = static_cast<std::size_t>(field.columns) * field.rows;
  field.nearest.assign(samples, kNone);
  field.distance.assign(samples, std::numeric_limits<double>::infinity());
  Propagation propagation(field, capsules);
  propagation.seed();
  for (int round = 0; round < 2; ++round) {
    propagation.sweep(1);
    propagation.sweep(-1);
  }
  return field;
}

double median_ridge(const CapsuleField& field, double least) {
  std::vector<double> ridges;
  for (int y = 1; y + 1 < field.rows; ++y) {
    for (int x = 1; x + 1 < field.columns; ++x) {
      const double d = field.at(x, y);
      if (!(d > least) || !std::isfinite(d)) continue;
      // The gradient of a distance is 1 except where two rims are equally near: there the central difference breaks down.
      const double gx = (field.at(x + 1, y) - field.at(x - 1, y)) / (2.0 * field.cell);
      const double gy = (field.at(x, y + 1) - field.at(x, y - 1)) / (2.0 * field.cell);
      if (gx * gx + gy * gy < 0.6) ridges.push_back(d);
    }
  }
  if (ridges.empty()) return 0.0;
  std::nth_element(ridges.begin(), ridges.begin() + ridges.size() / 2, ridges.end());
  return ridges[ridges.size() / 2];
}

}  // namespace ramify
