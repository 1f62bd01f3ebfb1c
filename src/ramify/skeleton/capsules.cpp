// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/skeleton/capsules.h"

#include <algorithm>
#include <cmath>

namespace ramify {

std::vector<BodyCapsule> branch_capsules(const Skeleton& skeleton, const BranchTree& tree) {
  std::vector<BodyCapsule> capsules;
  std::vector<double> arc_of_node(static_cast<std::size_t>(skeleton.count()), 0.0);
  for (std::size_t b = 0; b < tree.branches.size(); ++b) {
    const Branch& branch = tree.branches[b];
    const Polyline line = branch_polyline(skeleton, branch);
    const std::size_t lead = line.points.size() - branch.nodes.size();
    double arc = 0.0;
    for (std::size_t i = 0; i < line.points.size(); ++i) {
      if (i > 0) {
        const double next = arc + (line.points[i] - line.points[i - 1]).norm();
        capsules.push_back({line.points[i - 1], line.points[i], line.radii[i - 1], line.radii[i], static_cast<int>(b), arc, next});
        arc = next;
      } else if (line.points.size() == 1) {
        capsules.push_back({line.points[0], line.points[0], line.radii[0], line.radii[0], static_cast<int>(b), 0.0, 0.0});
      }
      if (i >= lead) arc_of_node[branch.nodes[i - lead]] = arc;
    }
  }
  for (const auto& [i, k] : skeleton.loop_links) {
    const Node &a = skeleton[i], &b = skeleton[k];
    capsules.push_back({a.xy(), b.xy(), a.radius, b.radius, tree.branch_of_node[i], arc_of_node[i], arc_of_node[i]});
  }
  return capsules;
}

CapsuleHit capsule_hit(const BodyCapsule& capsule, const Vec2& point) {
  const Vec2 axis = capsule.b - capsule.a, from = point - capsule.a;
  const double length = axis.norm(), growth = capsule.radius_b - capsule.radius_a;
  double fraction = 0.0;
  if (length > std::abs(growth)) {
    const double along = from.dot(axis) / length, away = std::abs(cross(axis, from)) / length;
    const double slope = growth / length;  // |slope| < 1: the surface leans by asin(slope)
    fraction = std::clamp((along + away * slope / std::sqrt(1.0 - slope * slope)) / length, 0.0, 1.0);
  } else if (growth > 0.0) {
    fraction = 1.0;  // the larger disc holds the smaller one
  }
  return {(from - fraction * axis).norm() - (capsule.radius_a + fraction * growth), fraction};
}

}  // namespace ramify
