// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/skeleton/branch_field.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "ramify/core/parallel.h"
#include "ramify/image/filter.h"

namespace ramify {
namespace {

constexpr double kBand = 4.0;  // px beyond the edge that is measured exactly
constexpr float kFar = std::numeric_limits<float>::infinity();

// Signed distance by stamping discs on the rows from `top` to before `bottom`; infinity beyond the band.
void stamp_discs(const std::vector<BranchCurve>& curves, int top, int bottom, BranchField& field) {
  ScalarImage& distance = field.signed_distance;
  const Size size = distance.size();
  for (const BranchCurve& curve : curves) {
    int next = 0;
    for (int i = 0; i < curve.count(); ++i) {
      if (i < next && i + 1 < curve.count()) continue;
      const Vec2& p = curve.points[i];
      const double r = curve.radii[i], reach = r + kBand;
      next = i + std::max(1, static_cast<int>(r / 4.0));
      const int y0 = std::max(top, static_cast<int>(std::ceil(p.y() - reach)));
      const int y1 = std::min(bottom - 1, static_cast<int>(std::floor(p.y() + reach)));
      const int x0 = std::max(0, static_cast<int>(std::ceil(p.x() - reach)));
      const int x1 = std::min(size.width - 1, static_cast<int>(std::floor(p.x() + reach)));
      for (int y = y0; y <= y1; ++y) {
        for (int x = x0; x <= x1; ++x) {
          const double d = std::hypot(x - p.x(), y - p.y()) - r;
          if (d > kBand || d >= distance(x, y)) continue;
          distance(x, y) = static_cast<float>(d);
          field.surface_radius(x, y) = static_cast<float>(r);
        }
      }
    }
  }
}

// The nearest curve vertex of every pixel, by two sweeps that pass candidates on to the neighbours (Danielsson 1980).
class NearestVertex {
 public:
  NearestVertex(const std::vector<BranchCurve>& curves, BranchField& field) : curves_(curves), field_(field) {}

  void run() {
    for (std::size_t c = 0; c < curves_.size(); ++c) {
      for (int i = 0; i < curves_[c].count(); ++i) {
        const Vec2& p = curves_[c].points[i];
        offer(static_cast<int>(std::lround(p.x())), static_cast<int>(std::lround(p.y())), static_cast<int>(c), i);
      }
    }
    const int width = field_.curve.width(), height = field_.curve.height();
    constexpr int kRows = 64;  // between two looks for a cancel
    for (int y = 0; y < height; ++y) {
      if (y % kRows == 0) check_cancel();
      sweep_row(y, -1, width, height);
    }
    for (int y = height - 1; y >= 0; --y) {
      if (y % kRows == 0) check_cancel();
      sweep_row(y, 1, width, height);
    }
  }

 private:
  void sweep_row(int y, int side, int width, int height) {
    if (y + side >= 0 && y + side < height) {
      for (int x = 0; x < width; ++x) {
        for (int dx = -1; dx <= 1; ++dx) take(x, y, x + dx, y + side);
      }
    }
    for (int x = 1; x < width; ++x) take(x, y, x - 1, y);
    for (int x = width - 2; x >= 0; --x) take(x, y, x + 1, y);
  }

  void take(int x, int y, int from_x, int from_y) {
    if (from_x < 0 || from_x >= field_.curve.width()) return;
    const int c = field_.curve(from_x, from_y);
    if (c != kNone && (c != field_.curve(x, y) || field_.vertex(from_x, from_y) != field_.vertex(x, y))) {
      offer(x, y, c, field_.vertex(from_x, from_y));
    }
  }

  void offer(int x, int y, int c, int i) {
    if (!field_.curve.contains(x, y)) return;
    const Vec2& p = curves_[c].points[i];
    const double dx = x - p.x(), dy = y - p.y(), known = field_.centre_distance(x, y);
    constexpr double kSure = 1.0 + 1e-6;  // most offers are worse by more than rounding
    if (dx * dx + dy * dy > kSure * known * known) return;
    const float d = static_cast<float>(std::hypot(dx, dy));
    if (d >= field_.centre_distance(x, y)) return;
    field_.centre_distance(x, y) = d;
    field_.curve(x, y) = c;
    field_.vertex(x, y) = i;
    field_.radius(x, y) = static_cast<float>(curves_[c].radii[i]);
  }

  const std::vector<BranchCurve>& curves_;
  BranchField& field_;
};

}  // namespace

BranchField measure_branch_field(const std::vector<BranchCurve>& curves, Size size) {
  BranchField field{ScalarImage(size, kFar), ScalarImage(size, 0.0f), ScalarImage(size, kFar),
                    ScalarImage(size, 0.0f), LabelImage(size, kNone), LabelImage(size, kNone)};
  constexpr int kRows = 32;  // a thread's work
  parallel_for((size.height + kRows - 1) / kRows,
               [&](int i) { stamp_discs(curves, i * kRows, std::min(size.height, (i + 1) * kRows), field); });
  Mask inside(size);
  for (std::size_t i = 0; i < inside.pixels().size(); ++i) {
    inside.pixels()[i] = field.signed_distance.pixels()[i] <= 0.5f ? 255 : 0;
  }
  const ScalarImage outside = distance_to(inside);
  for (std::size_t i = 0; i < inside.pixels().size(); ++i) {
    float& d = field.signed_distance.pixels()[i];
    if (d == kFar) d = outside.pixels()[i] + 0.5f;
  }
  NearestVertex(curves, field).run();
  return field;
}

}  // namespace ramify
