// SPDX-License-Identifier: GPL-3.0-or-later
// Edits that return a new skeleton and leave the old one alone. Branches keep their continuations, loop links whose ends
// survive are kept, and orders are counted anew where branches may have changed.
#pragma once

#include <vector>

#include "ramify/skeleton/branches.h"
#include "ramify/skeleton/skeleton.h"

namespace ramify {

// p -> scale * R(angle) * (mirrored p) + shift. Mirroring flips x first. Radii are scaled.
struct Similarity {
  double scale = 1.0;          // > 0
  double angle = 0.0;          // rad
  bool mirror = false;
  Vec2 shift = Vec2::Zero();   // px
  Vec2 apply(const Vec2& p) const;
};
Skeleton transform_skeleton(const Skeleton& skeleton, const Similarity& canvas_from_old, Size canvas);

// Equal arc steps of about `step` px (> 0) between the points that must stay: roots, furcations, tips and ends of loop
// links. Radii are linear in between, tags those of the nearest old node.
Skeleton resample_skeleton(const Skeleton& skeleton, double step);

// Gaussian along every branch, sigma in px; roots, tips and the places where children leave move with their branch only.
Skeleton smooth_skeleton(const Skeleton& skeleton, double sigma);

// Without the nodes for which drop[i] is true and everything below them.
Skeleton remove_subtrees(const Skeleton& skeleton, const std::vector<bool>& drop);

// Without the side branches from whose base no path down this skeleton is as long as `length` px; root branches stay.
Skeleton prune_skeleton(const Skeleton& skeleton, double length);

// The part below a node, the node itself being the root.
Skeleton subtree(const Skeleton& skeleton, int node);

// Both on one canvas (the first one's); the second one's nodes come after the first one's.
Skeleton join_skeletons(const Skeleton& first, const Skeleton& second);

// How a child leaves its parent as seen from outside the parent's body (PICTURES 3: its first stretch lies inside a thick
// parent and would teach a false taper).
struct ChildStart {
  int branch = kNone;      // the child, index into branch_tree(skeleton).branches
  double rim_arc = 0.0;    // px along branch_polyline where it first comes out of the parent's body
  int side = 1;            // +1 when it leaves clockwise (on the screen) of the parent's direction, else -1
  double angle = 0.0;      // rad, 0..pi, between the parent's direction there and the child's over its first stretch outside
  double radius = 0.0;     // px, median of the child's radii beyond 1.5 parent radii from the rim (all when it is shorter)
  double ratio = 1.0;      // radius / parent's radius at the node where it leaves
  bool emerges = false;    // false when the whole child lies inside the parent
};
std::vector<ChildStart> measure_child_starts(const Skeleton& skeleton, const BranchTree& tree);

// Every child cut at its parent's rim: of its nodes inside only the last is kept and moves onto the rim, and radii up to
// 1.5 parent radii beyond it become the child's radius outside. Children that never emerge are dropped; what hung on
// dropped nodes hangs on the parent's node then.
Skeleton cut_at_rim(const Skeleton& skeleton);

// Strahler order of every node: 1 at tips, one more where two of the highest order meet.
std::vector<int> strahler_orders(const Skeleton& skeleton);

}  // namespace ramify
