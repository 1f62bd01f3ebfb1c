// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/exemplar/shore.h"

#include <algorithm>
#include <cmath>

#include "ramify/geometry/polyline.h"
#include "ramify/image/contour.h"

namespace ramify {
namespace {

constexpr int kHalfSamples = 5;
constexpr double kSmoothing = 3.0;   // px, along the outline
constexpr int kShortest = 12;        // px of outline worth a curve
constexpr double kRowShare = 0.25;   // rows of constraints lie this share of the disc beside the bank

}  // namespace

std::vector<BranchCurve> wide_shores(const BranchField& field, double radius) {
  std::vector<BranchCurve> shores;
  auto is_wide = [&](const Vec2& p) {
    return field.surface_radius.clamped(static_cast<int>(std::lround(p.x())), static_cast<int>(std::lround(p.y()))) >= radius;
  };
  auto close_run = [&](std::vector<Vec2>& run) {
    if (static_cast<int>(run.size()) >= kShortest) {
      const SampledPolyline dense = resample_arc(run, 1.0);
      BranchCurve shore;
      shore.points = smooth_polyline(dense.points, kSmoothing);
      shore.radii.assign(shore.points.size(), 0.0);
      shores.push_back(std::move(shore));
    }
    run.clear();
  };
  for (const Contour& contour : trace_contours(field.signed_distance, 0.0f)) {
    std::vector<Vec2> run;
    for (const Vec2& p : contour.points) {
      if (is_wide(p)) {
        run.push_back(p);
      } else {
        close_run(run);
      }
    }
    close_run(run);
  }
  return shores;
}

Fragment bank_fragment(const std::vector<BranchCurve>& shores, int index, int vertex, double disc) {
  const BranchCurve& shore = shores[index];
  Fragment f;
  f.kind = FragmentKind::Bank;
  f.curve = index;
  f.vertex = vertex;
  f.centre = shore.points[vertex];
  f.radius = f.branch_radius = disc;
  for (int k = -kHalfSamples; k <= kHalfSamples; ++k) {
    const double v = vertex + 0.9 * disc * k / kHalfSamples;
    f.shape.push_back({point_along(shore, v) - f.centre, perpendicular(tangent_along(shore, v)), kRowShare * disc});
  }
  return f;
}

Fragment interior_fragment(const std::vector<BranchCurve>& curves, const BranchField& field, const Vec2& centre,
                           double disc) {
  Fragment f;
  f.kind = FragmentKind::Interior;
  f.centre = centre;
  f.radius = f.branch_radius = disc;
  const int x = static_cast<int>(std::lround(centre.x())), y = static_cast<int>(std::lround(centre.y()));
  f.curve = field.curve.clamped(x, y);
  f.vertex = field.vertex.clamped(x, y);
  const Vec2 along = tangent_along(curves[f.curve], f.vertex);
  for (int k = -kHalfSamples; k <= kHalfSamples; ++k) {
    f.shape.push_back({0.9 * disc * k / kHalfSamples * along, perpendicular(along), kRowShare * disc});
  }
  return f;
}

}  // namespace ramify
