// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/growth/joining.h"

#include <algorithm>
#include <cmath>

#include "ramify/geometry/segment.h"

namespace ramify {
namespace {

constexpr double kLeastAngle = 35.0 * kPi / 180.0;  // to the target
constexpr double kDepth = 0.6;                      // of the target's radius: where the end lies, off its axis
constexpr double kApart = 0.25;                     // px between axes of edges that do not hang together

}  // namespace

bool end_on(const Capsule& target, int at, const Occupancy& occupancy, const Ground& ground,
            const std::vector<GrowingBranch>& branches, int number, Extension& extension) {
  const GrowingBranch& branch = branches[number];
  // Points of the branch with the extension, counted from its tip: 0.
  const auto point = [&](int i) { return i > 0 ? extension.points[i - 1] : branch.points[branch.count() - 1 + i]; };
  const Vec2 before = point(at), edge = target.b - target.a;
  double angle = std::abs(wrap_angle(angle_of(extension.points[at] - before) - angle_of(edge)));
  angle = std::min(angle, kPi - angle);
  if (angle < kLeastAngle) return false;
  const PointOnSegment foot = nearest_on_segment(extension.points[at], target.a, target.b);
  const Vec2 way = target.a + edge * foot.fraction - before;
  const double back = kDepth * std::min(target.radius_a, target.radius_b);
  if (way.norm() <= back + 0.5) return false;
  const Vec2 along = branch.count() + at > 1 ? Vec2(before - point(at - 1)) : direction_of(branch.start_direction);
  if (way.dot(along) < 0.0) return false;
  const Vec2 end = before + way * ((way.norm() - back) / way.norm());
  for (int i = 1; i < at; ++i) {
    if (segment_distance(before, end, point(i - 1), point(i)) <= kApart) return false;
  }
  bool clear = !ground.blocked(end);
  const Vec2 margin = Vec2::Constant(2.0);
  occupancy.index().visit_box(before.cwiseMin(end) - margin, before.cwiseMax(end) + margin, [&](int other_number) {
    const Capsule& other = occupancy.index()[other_number];
    const bool hangs_on = at == 0 && other.owner == number && other.place == branch.count() - 2;
    clear = clear && (hangs_on || segment_distance(before, end, other.a, other.b) > kApart);
    return clear;
  });
  if (!clear) return false;
  const auto keep = [&](auto& values) { values.resize(static_cast<std::size_t>(at) + 1); };
  keep(extension.points);
  keep(extension.radii);
  keep(extension.turns);
  keep(extension.copied);
  extension.points.back() = end;
  extension.stop = GrowthStop::Join;
  return true;
}

}  // namespace ramify
