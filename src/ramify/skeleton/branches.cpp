// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/skeleton/branches.h"

namespace ramify {

BranchTree branch_tree(const Skeleton& skeleton) {
  BranchTree tree;
  tree.branch_of_node.assign(static_cast<std::size_t>(skeleton.count()), kNone);
  std::vector<bool> continued(static_cast<std::size_t>(skeleton.count()), false);
  for (int i = 0; i < skeleton.count(); ++i) {
    const Node& node = skeleton[i];
    int branch = kNone;
    if (node.parent != kNone && !continued[node.parent]) {
      continued[node.parent] = true;
      branch = tree.branch_of_node[node.parent];
    } else {
      branch = static_cast<int>(tree.branches.size());
      Branch fresh;
      if (node.parent != kNone) {
        fresh.parent = tree.branch_of_node[node.parent];
        fresh.parent_node = node.parent;
        fresh.order = tree.branches[fresh.parent].order + 1;
      }
      tree.branches.push_back(fresh);
    }
    tree.branch_of_node[i] = branch;
    tree.branches[branch].nodes.push_back(i);
    if (node.parent != kNone) {
      tree.branches[branch].length += (node.position - skeleton[node.parent].position).norm();
    }
  }
  return tree;
}

Polyline branch_polyline(const Skeleton& skeleton, const Branch& branch) {
  Polyline line;
  if (branch.parent_node != kNone) {
    line.points.push_back(skeleton[branch.parent_node].xy());
    line.radii.push_back(skeleton[branch.nodes.front()].radius);
  }
  for (const int i : branch.nodes) {
    line.points.push_back(skeleton[i].xy());
    line.radii.push_back(skeleton[i].radius);
  }
  return line;
}

}  // namespace ramify
