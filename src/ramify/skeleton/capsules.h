// SPDX-License-Identifier: GPL-3.0-or-later
// A skeleton's body: the union of round cones (capsules of linearly changing radius), one per edge. One definition serves
// masks, labels, distances and the compositor, so they always agree.
#pragma once

#include <vector>

#include "ramify/skeleton/branches.h"
#include "ramify/skeleton/skeleton.h"

namespace ramify {

struct BodyCapsule {
  Vec2 a = Vec2::Zero(), b = Vec2::Zero();  // px
  double radius_a = 0.0, radius_b = 0.0;    // px
  int branch = kNone;                       // index into BranchTree::branches
  double arc_a = 0.0, arc_b = 0.0;          // px along the branch (the edge from the parent's node included)
};

// One per edge, branch by branch; a branch of a single node gives one disc. The edge from a parent to its child has the
// child's first radius at both ends (branch_polyline). Loop links come last, with the branch and arc of their first node.
std::vector<BodyCapsule> branch_capsules(const Skeleton& skeleton, const BranchTree& tree);

struct CapsuleHit {
  double signed_distance = 0.0;  // px to the surface, negative inside; its slope is 1 everywhere
  double fraction = 0.0;         // 0 at a … 1 at b: the disc that comes nearest
};

// Exact for round cones: minimises |p - c(t)| - r(t) over the axis.
CapsuleHit capsule_hit(const BodyCapsule& capsule, const Vec2& point);

}  // namespace ramify
