// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/compose/bend.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "ramify/compose/paper_warp.h"

namespace ramify {
namespace {

constexpr double kMargin = 3.0;           // px around the disc, for gradients and resampling
constexpr double kReach = 1.4;            // rows end this many disc radii from the centre
constexpr double kAnchors = 1.3;          // circle of the anchors, in disc radii
constexpr double kSmoothing = 3e-3;
constexpr JacobianRange kAllowed{0.4, 2.5};

// Where canvas offsets should come from, as differences from the rigid map.
struct Rows {
  std::vector<Vec2> canvas, difference;

  void add(const SourceCandidate& candidate, double radius, const Vec2& canvas_offset, const Vec2& photo) {
    if (canvas_offset.norm() > kReach * radius) return;
    for (const Vec2& other : canvas) {
      if ((other - canvas_offset).norm() < 0.02 * radius) return;
    }
    canvas.push_back(canvas_offset);
    difference.push_back(photo - photo_offset(candidate, canvas_offset));
  }
};

Rows constraint_rows(const Fragment& source, const Fragment& target, const SourceCandidate& candidate) {
  Rows rows;
  for (std::size_t l = 0; l < target.shape.size(); ++l) {
    const ShapeSample &s = source.shape[paired_sample(source, candidate.backwards, l)], &t = target.shape[l];
    rows.add(candidate, target.radius, t.offset, s.offset);
    if (t.radius <= 0.8) continue;
    // The source's normal may point to the other bank, above all when it is mirrored.
    const bool flipped = photo_offset(candidate, t.normal).dot(s.normal) < 0.0;
    const Vec2 source_normal = flipped ? Vec2(-s.normal) : s.normal;
    for (const double side : {1.0, -1.0}) {
      rows.add(candidate, target.radius, t.offset + side * t.radius * t.normal,
               s.offset + side * s.radius * source_normal);
    }
  }
  for (int a = 0; a < 8; ++a) {
    rows.canvas.push_back(kAnchors * target.radius * direction_of(a * kPi / 4));
    rows.difference.push_back(Vec2::Zero());
  }
  return rows;
}

// The centre line alone, as paper 002 has it.
std::vector<Vec2> paper_displacements(const WarpGrid& warp, const Fragment& source, const Fragment& target,
                                      const SourceCandidate& candidate) {
  std::vector<Vec2> places, differences;
  for (std::size_t l = 0; l < target.shape.size(); ++l) {
    const Vec2& offset = target.shape[l].offset;
    if (offset.norm() > target.radius) continue;
    places.push_back(target.centre + offset);
    differences.push_back(source.shape[paired_sample(source, candidate.backwards, l)].offset -
                          photo_offset(candidate, offset));
  }
  return laplacian_displacements(warp, places, differences);
}

}  // namespace

WarpGrid bend_fragment(const Fragment& source, const Fragment& target, const SourceCandidate& candidate,
                       const PlacementOptions& options) {
  const double reach = target.radius + kMargin;
  WarpGrid warp;
  warp.step = std::clamp(target.radius / 8.0, 2.0, 6.0);
  warp.origin = target.centre - Vec2(reach, reach);
  warp.columns = warp.rows = static_cast<int>(std::ceil(2.0 * reach / warp.step)) + 1;
  std::vector<Vec2> rigid, extra;
  std::optional<ThinPlate> plate;
  if (options.bend && !options.paper_warp) {
    const Rows rows = constraint_rows(source, target, candidate);
    plate.emplace(rows.canvas, rows.difference, target.radius, kSmoothing);
  }
  for (int y = 0; y < warp.rows; ++y) {
    for (int x = 0; x < warp.columns; ++x) {
      const Vec2 offset = warp.origin + warp.step * Vec2(x, y) - target.centre;
      rigid.push_back(source.centre + photo_offset(candidate, offset));
      extra.push_back(plate ? (*plate)(offset) : Vec2(Vec2::Zero()));
    }
  }
  if (options.paper_warp) extra = paper_displacements(warp, source, target, candidate);
  const double area = (candidate.mirrored ? -1.0 : 1.0) / (candidate.scale * candidate.scale);
  double share = 1.0;
  for (int attempt = 0; attempt < 5; ++attempt, share *= 0.5) {
    warp.values = rigid;
    for (std::size_t i = 0; i < rigid.size(); ++i) warp.values[i] += share * extra[i];
    const JacobianRange found = measure_jacobian(warp, target.centre, target.radius);
    const double low = std::min(found.low / area, found.high / area), high = std::max(found.low / area, found.high / area);
    if (low > kAllowed.low && high < kAllowed.high) break;
  }
  return warp;
}

}  // namespace ramify
