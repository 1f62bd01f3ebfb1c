// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/synthetic/branch_field.h"

#include <algorithm>
#include <cmath>

#include "ramify/core/parallel.h"

namespace ramify {
namespace {

constexpr int kBand = 16;  // rows handled together

struct Piece {
  Vec2 from, step;
  double r0, r1, length, along;
  int branch;
  double low_y, high_y;  // rows it can reach
};

std::vector<Piece> pieces_of(const std::vector<AnnotatedBranch>& branches, double reach) {
  std::vector<Piece> pieces;
  for (std::size_t b = 0; b < branches.size(); ++b) {
    const AnnotatedBranch& branch = branches[b];
    std::vector<Vec2> points = branch.points;
    std::vector<double> radii = branch.radii;
    if (branch.parent) {
      points.insert(points.begin(), branches[branch.parent->branch].points[branch.parent->point]);
      radii.insert(radii.begin(), radii.front());
    }
    double along = 0.0;
    for (std::size_t i = 0; i + 1 < points.size(); ++i) {
      const Vec2 step = points[i + 1] - points[i];
      const double length = step.norm(), most = reach + std::max(radii[i], radii[i + 1]);
      pieces.push_back({points[i], step, radii[i], radii[i + 1], length, along, static_cast<int>(b),
                        std::min(points[i].y(), points[i + 1].y()) - most,
                        std::max(points[i].y(), points[i + 1].y()) + most});
      along += length;
    }
  }
  return pieces;
}

void paint_piece(Image<BranchSample>& field, const Piece& piece, double reach, int y0, int y1) {
  const double most = reach + std::max(piece.r0, piece.r1);
  const double left = std::min(piece.from.x(), piece.from.x() + piece.step.x()) - most;
  const double right = std::max(piece.from.x(), piece.from.x() + piece.step.x()) + most;
  const int x0 = std::max(0, static_cast<int>(std::ceil(left)));
  const int x1 = std::min(field.width() - 1, static_cast<int>(std::floor(right)));
  y0 = std::max(y0, static_cast<int>(std::ceil(piece.low_y)));
  y1 = std::min(y1, static_cast<int>(std::floor(piece.high_y)));
  const double square = piece.length * piece.length;
  // The rim of discs that grow along the piece is a cone: the nearest disc lies ahead of the foot of the perpendicular.
  const double growth = square > 0.0 ? std::clamp((piece.r1 - piece.r0) / piece.length, -0.99, 0.99) : 0.0;
  const double ahead = growth / std::sqrt(1.0 - growth * growth);
  for (int y = y0; y <= y1; ++y)
    for (int x = x0; x <= x1; ++x) {
      const Vec2 p(x, y), offset = p - piece.from;
      const double foot = square > 0.0 ? offset.dot(piece.step) / square : 0.0;
      const double lead = square > 0.0 ? ahead * (offset - foot * piece.step).norm() / piece.length : 0.0;
      const double t = std::clamp(foot + lead, 0.0, 1.0);
      const double radius = piece.r0 + t * (piece.r1 - piece.r0);
      const double centre = (offset - t * piece.step).norm(), distance = centre - radius;
      BranchSample& sample = field(x, y);
      if (distance > reach || distance >= sample.distance) continue;
      const Vec2 heading = square > 0.0 ? Vec2(piece.step / piece.length) : Vec2(1.0, 0.0);
      sample = {static_cast<float>(distance), static_cast<float>(radius),
                static_cast<float>(piece.along + t * piece.length),
                static_cast<float>(cross(heading, offset) >= 0.0 ? centre : -centre),
                static_cast<float>(heading.x()), static_cast<float>(heading.y()), piece.branch};
    }
}

}  // namespace

Image<BranchSample> branch_field(Size size, const std::vector<AnnotatedBranch>& branches, double reach) {
  const std::vector<Piece> pieces = pieces_of(branches, reach);
  Image<BranchSample> field(size);
  parallel_for((size.height + kBand - 1) / kBand, [&](int band) {
    const int y0 = band * kBand, y1 = std::min(size.height, y0 + kBand) - 1;
    for (const Piece& piece : pieces)
      if (piece.high_y >= y0 && piece.low_y <= y1) paint_piece(field, piece, reach, y0, y1);
  });
  return field;
}

Mask inside_mask(const Image<BranchSample>& field) {
  Mask mask(field.size());
  for (int y = 0; y < field.height(); ++y)
    for (int x = 0; x < field.width(); ++x) mask(x, y) = field(x, y).distance <= 0.0f ? 255 : 0;
  return mask;
}

}  // namespace ramify
