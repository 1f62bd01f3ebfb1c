// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/exemplar/annotation.h"

#include <stdexcept>
#include <string>

#include "ramify/core/error.h"
#include "ramify/skeleton/branches.h"

namespace ramify {
namespace {

// Branch indices so that every parent comes before its children; a cycle is an error.
std::vector<int> parents_first(const Annotation& annotation) {
  const int count = static_cast<int>(annotation.branches.size());
  std::vector<std::vector<int>> children(static_cast<std::size_t>(count));
  std::vector<int> order;
  for (int i = 0; i < count; ++i) {
    const auto& parent = annotation.branches[i].parent;
    if (!parent) order.push_back(i);
    else if (parent->branch < 0 || parent->branch >= count)
      throw InputError("", "branches[" + std::to_string(i) + "].parent: there is no such branch");
    else children[parent->branch].push_back(i);
  }
  for (std::size_t k = 0; k < order.size(); ++k) {
    order.insert(order.end(), children[order[k]].begin(), children[order[k]].end());
  }
  if (static_cast<int>(order.size()) < count) {
    throw InputError("", "branches: some are each other's parents, so they have no root");
  }
  return order;
}

// Node index of every point of every branch. A repeated point shares the node of the one before it.
using PointNodes = std::vector<std::vector<int>>;

int node_of(const PointNodes& nodes, const BranchPoint& at, const std::string& where) {
  if (at.branch < 0 || at.branch >= static_cast<int>(nodes.size()) || at.point < 0 ||
      at.point >= static_cast<int>(nodes[at.branch].size())) {
    throw InputError(where, "there is no such branch point");
  }
  return nodes[at.branch][at.point];
}

}  // namespace

Skeleton skeleton_from_annotation(const Annotation& annotation) {
  Skeleton skeleton(annotation.rectified_size.value_or(annotation.photo_size));
  PointNodes nodes(annotation.branches.size());
  std::vector<int> orders(annotation.branches.size(), 0);
  for (const int b : parents_first(annotation)) {
    const AnnotatedBranch& branch = annotation.branches[b];
    const std::string where = "branches[" + std::to_string(b) + "]";
    int parent = kNone;
    if (branch.parent) {
      parent = node_of(nodes, *branch.parent, where + ".parent");
      orders[b] = orders[branch.parent->branch] + 1;
    }
    for (std::size_t i = 0; i < branch.points.size(); ++i) {
      const Vec2& p = branch.points[i];
      if (parent == kNone || (skeleton[parent].xy() - p).norm() > 1e-9) {
        Node node;
        node.position = Vec3(p.x(), p.y(), 0.0);
        node.radius = branch.radii[i];
        node.parent = parent;
        node.order = orders[b];
        parent = skeleton.append(node);
      }
      nodes[b].push_back(parent);
    }
  }
  for (std::size_t k = 0; k < annotation.links.size(); ++k) {
    const std::string where = "links[" + std::to_string(k) + "]";
    const int a = node_of(nodes, annotation.links[k].first, where);
    const int c = node_of(nodes, annotation.links[k].second, where);
    if (a != c) skeleton.loop_links.emplace_back(a, c);
  }
  return skeleton;
}

Annotation annotation_from_skeleton(const Skeleton& skeleton) {
  Annotation annotation;
  annotation.photo_size = skeleton.size;
  const BranchTree tree = branch_tree(skeleton);
  std::vector<BranchPoint> place(static_cast<std::size_t>(skeleton.count()));
  for (std::size_t b = 0; b < tree.branches.size(); ++b) {
    const Branch& branch = tree.branches[b];
    AnnotatedBranch out;
    for (const int i : branch.nodes) {
      place[i] = {static_cast<int>(b), static_cast<int>(out.points.size())};
      out.points.push_back(skeleton[i].xy());
      out.radii.push_back(skeleton[i].radius);
    }
    if (branch.parent_node != kNone) out.parent = place[branch.parent_node];
    annotation.branches.push_back(std::move(out));
  }
  for (const auto& [a, c] : skeleton.loop_links) annotation.links.emplace_back(place[a], place[c]);
  return annotation;
}

}  // namespace ramify
