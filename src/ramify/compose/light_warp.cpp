// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/compose/light_warp.h"

#include <algorithm>
#include <cmath>

namespace ramify {
namespace {

constexpr double kMostScale = 2.0;  // widths that differ by more are not met fully

// A strand at a fraction of a sample.
struct Station {
  Vec2 point = Vec2::Zero(), normal = Vec2::UnitY();
  double radius = 1.0;
};

// Beyond the ends it goes on straight.
Station station(const Strand& strand, double along) {
  const double inside = std::clamp(along, 0.0, strand.count() - 1.0);
  const int a = static_cast<int>(inside), b = std::min(a + 1, strand.count() - 1);
  const double u = inside - a;
  Station out;
  out.normal = ((1.0 - u) * strand.normals[a] + u * strand.normals[b]).normalized();
  out.point = (1.0 - u) * strand.points[a] + u * strand.points[b] - (along - inside) * perpendicular(out.normal);
  out.radius = (1.0 - u) * strand.radii[a] + u * strand.radii[b];
  return out;
}

// Every fourth sample, then round the best.
int nearest(const Strand& strand, const Vec2& p, int from, int to) {
  int best = from;
  double best_distance = 1e18;
  const auto look = [&](int t) {
    const double d = (strand.points[t] - p).squaredNorm();
    if (d < best_distance) best_distance = d, best = t;
  };
  for (int t = from; t < to; t += 4) look(t);
  const int middle = best;
  for (int t = std::max(from, middle - 3); t < std::min(to, middle + 4); ++t) look(t);
  return best;
}

}  // namespace

PatchBox patch_box(const Strand& target, int sample, const LightRules& rules) {
  PatchBox box;
  box.centre = target.points[sample];
  box.s = surround_radius(target.radii[sample], rules.surround_factor, rules.surround_cap);
  const int half = static_cast<int>(std::ceil(box.s)) + 1;
  box.x0 = static_cast<int>(std::floor(box.centre.x())) - half;
  box.y0 = static_cast<int>(std::floor(box.centre.y())) - half;
  box.size = 2 * half + 1;
  return box;
}

StrandPoint locate(const Strand& strand, const Vec2& p, int from, int to) {
  const int t = nearest(strand, p, from, to);
  const Vec2& n = strand.normals[t];
  const double ahead = -(p - strand.points[t]).dot(perpendicular(n));
  const double least = t == from ? -1e9 : -0.5, most = t == to - 1 ? 1e9 : 0.5;
  const double along = t + std::clamp(ahead, least, most);
  const Station at = station(strand, along);
  const double distance = (p - at.point).norm();
  return {static_cast<float>(along), static_cast<float>((p - at.point).dot(at.normal) < 0.0 ? -distance : distance)};
}

std::vector<Eigen::Vector2f> photo_from_strand(const LightSource& source, const SourceSpot& place, const Strand& target,
                                               int sample, const std::vector<StrandPoint>& points) {
  const Strand& strand = source.strands[place.strand];
  const double side = place.mirrored ? -1.0 : 1.0;
  std::vector<Eigen::Vector2f> out;
  out.reserve(points.size());
  for (const StrandPoint& p : points) {
    const Station from = station(strand, place.sample + (p.along - sample));
    const double wanted = std::max(0.3, target.radii[std::clamp(static_cast<int>(std::lround(p.along)), 0, target.count() - 1)]);
    const double scale = std::clamp(from.radius / wanted, 1.0 / kMostScale, kMostScale);
    const double u = std::abs(p.across), within = std::min(u, wanted);
    const double across = scale * within + (u - within);
    out.push_back((from.point + std::copysign(across, p.across) * side * from.normal).cast<float>());
  }
  return out;
}

}  // namespace ramify
