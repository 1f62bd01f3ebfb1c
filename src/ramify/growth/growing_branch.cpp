// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/growth/growing_branch.h"

namespace ramify {

double direction_at(const GrowingBranch& branch, int at) {
  return at > 0 ? angle_of(branch.points[at] - branch.points[at - 1]) : branch.start_direction;
}

Skeleton skeleton_from(const std::vector<GrowingBranch>& branches, Size size) {
  Skeleton skeleton(size);
  std::vector<int> first(branches.size(), kNone);
  for (std::size_t b = 0; b < branches.size(); ++b) {
    const GrowingBranch& branch = branches[b];
    if (!branch.grown) continue;
    first[b] = skeleton.count();
    for (int i = 0; i < branch.count(); ++i) {
      Node node;
      node.position = Vec3(branch.points[i].x(), branch.points[i].y(), 0.0);
      node.radius = branch.radii[i];
      node.order = branch.order;
      node.tag = branch.copied[i];
      node.parent = i > 0 ? skeleton.count() - 1 : branch.parent == kNone ? kNone : first[branch.parent] + branch.parent_node;
      skeleton.append(node);
    }
  }
  return skeleton;
}

}  // namespace ramify
