// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/skeleton/edit.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "ramify/geometry/polyline.h"
#include "ramify/skeleton/assemble.h"

namespace ramify {
namespace {

// Carries over the loop links whose ends still exist. index_of: new index of every old node, or kNone.
void keep_links(const Skeleton& old, const std::vector<int>& index_of, Skeleton& result) {
  for (const auto& [a, b] : old.loop_links) {
    if (index_of[a] != kNone && index_of[b] != kNone) result.loop_links.emplace_back(index_of[a], index_of[b]);
  }
}

Skeleton like(const Skeleton& skeleton) {
  Skeleton result(skeleton.size);
  result.dim = skeleton.dim;
  return result;
}

Vec3 lifted(const Vec2& p, double z) { return {p.x(), p.y(), z}; }

}  // namespace

Vec2 Similarity::apply(const Vec2& p) const {
  const Vec2 q(mirror ? -p.x() : p.x(), p.y());
  const double c = std::cos(angle), s = std::sin(angle);
  return scale * Vec2(c * q.x() - s * q.y(), s * q.x() + c * q.y()) + shift;
}

Skeleton transform_skeleton(const Skeleton& skeleton, const Similarity& canvas_from_old, Size canvas) {
  Skeleton result = skeleton;
  result.size = canvas;
  for (int i = 0; i < result.count(); ++i) {
    result.set_position(i, lifted(canvas_from_old.apply(skeleton[i].xy()), canvas_from_old.scale * skeleton[i].position.z()));
    result.set_radius(i, canvas_from_old.scale * skeleton[i].radius);
  }
  return result;
}

Skeleton resample_skeleton(const Skeleton& skeleton, double step) {
  if (!(step > 0.0)) throw std::invalid_argument("resample_skeleton: the step must be positive");
  std::vector<int> children(static_cast<std::size_t>(skeleton.count()), 0);
  for (const Node& node : skeleton.nodes()) {
    if (node.parent != kNone) ++children[node.parent];
  }
  std::vector<bool> fixed(children.size());
  for (int i = 0; i < skeleton.count(); ++i) fixed[i] = skeleton[i].parent == kNone || children[i] != 1;
  for (const auto& [a, b] : skeleton.loop_links) fixed[a] = fixed[b] = true;
  Skeleton result = like(skeleton);
  std::vector<int> index_of(children.size(), kNone);
  // Continuations keep the lowest index among their siblings because whole branches are written base to tip.
  for (const Branch& branch : branch_tree(skeleton).branches) {
    int anchor = branch.parent_node;  // old index of the last fixed node
    std::vector<int> piece;
    for (const int i : branch.nodes) {
      piece.push_back(i);
      if (!fixed[i]) continue;
      if (anchor == kNone) {
        index_of[i] = result.append(skeleton[i]);
      } else {
        std::vector<Vec3> points{skeleton[anchor].position};
        std::vector<double> radii{skeleton[anchor == branch.parent_node ? piece.front() : anchor].radius}, arcs{0.0};
        for (const int k : piece) {
          arcs.push_back(arcs.back() + (skeleton[k].position - points.back()).norm());
          points.push_back(skeleton[k].position);
          radii.push_back(skeleton[k].radius);
        }
        const int steps = static_cast<int>(std::clamp(std::round(arcs.back() / step), 1.0, 1e8));
        int last = index_of[anchor];
        for (int s = 1; s <= steps; ++s) {
          const ArcPosition at = locate_arc(arcs, arcs.back() * s / steps);
          const double t = at.fraction;
          Node node = skeleton[piece[std::max(0, t < 0.5 ? at.segment - 1 : at.segment)]];
          if (s == steps) node = skeleton[i];
          else node.position = (1.0 - t) * points[at.segment] + t * points[at.segment + 1],
               node.radius = (1.0 - t) * radii[at.segment] + t * radii[at.segment + 1];
          node.parent = last;
          last = result.append(node);
        }
        index_of[i] = last;
      }
      anchor = i;
      piece.clear();
    }
  }
  keep_links(skeleton, index_of, result);
  count_orders(result);
  return result;
}

Skeleton smooth_skeleton(const Skeleton& skeleton, double sigma) {
  Skeleton result = skeleton;
  for (const Branch& branch : branch_tree(skeleton).branches) {
    // Parents come first, so the parent's node has its new place already.
    std::vector<Vec2> points;
    if (branch.parent_node != kNone) points.push_back(result[branch.parent_node].xy());
    for (const int i : branch.nodes) points.push_back(skeleton[i].xy());
    const std::size_t lead = points.size() - branch.nodes.size();
    const std::vector<Vec2> smooth = smooth_polyline(points, sigma);
    for (std::size_t k = 0; k < branch.nodes.size(); ++k) {
      const int i = branch.nodes[k];
      result.set_position(i, lifted(smooth[k + lead], skeleton[i].position.z()));
    }
  }
  return result;
}

Skeleton remove_subtrees(const Skeleton& skeleton, const std::vector<bool>& drop) {
  Skeleton result = like(skeleton);
  std::vector<int> index_of(static_cast<std::size_t>(skeleton.count()), kNone);
  for (int i = 0; i < skeleton.count(); ++i) {
    Node node = skeleton[i];
    if (drop[i] || (node.parent != kNone && index_of[node.parent] == kNone)) continue;
    if (node.parent != kNone) node.parent = index_of[node.parent];
    index_of[i] = result.append(node);
  }
  keep_links(skeleton, index_of, result);
  count_orders(result);
  return result;
}

Skeleton prune_skeleton(const Skeleton& skeleton, double length) {
  // Longest way down from every node, its own edge to the parent included.
  std::vector<double> reach(static_cast<std::size_t>(skeleton.count()), 0.0);
  for (int i = skeleton.count() - 1; i >= 0; --i) {
    const int parent = skeleton[i].parent;
    if (parent == kNone) continue;
    reach[i] += (skeleton[i].position - skeleton[parent].position).norm();
    reach[parent] = std::max(reach[parent], reach[i]);
  }
  std::vector<bool> drop(reach.size(), false);
  for (const Branch& branch : branch_tree(skeleton).branches) {
    if (branch.parent != kNone && reach[branch.nodes.front()] < length) drop[branch.nodes.front()] = true;
  }
  return remove_subtrees(skeleton, drop);
}

Skeleton subtree(const Skeleton& skeleton, int node) {
  Skeleton result = like(skeleton);
  std::vector<int> index_of(static_cast<std::size_t>(skeleton.count()), kNone);
  for (int i = node; i < skeleton.count(); ++i) {
    Node copy = skeleton[i];
    if (i != node && (copy.parent == kNone || index_of[copy.parent] == kNone)) continue;
    copy.parent = i == node ? kNone : index_of[copy.parent];
    index_of[i] = result.append(copy);
  }
  keep_links(skeleton, index_of, result);
  count_orders(result);
  return result;
}

Skeleton join_skeletons(const Skeleton& first, const Skeleton& second) {
  Skeleton result = first;
  const int shift = first.count();
  result.dim = std::max(first.dim, second.dim);
  for (Node node : second.nodes()) {
    if (node.parent != kNone) node.parent += shift;
    result.append(node);
  }
  for (const auto& [a, b] : second.loop_links) result.loop_links.emplace_back(a + shift, b + shift);
  return result;
}

std::vector<int> strahler_orders(const Skeleton& skeleton) {
  std::vector<int> order(static_cast<std::size_t>(skeleton.count()), 1), ties(order.size(), 0);
  for (int i = skeleton.count() - 1; i >= 0; --i) {
    // ties[i] counts the children of the highest order; children have all been settled.
    if (ties[i] > 1) ++order[i];
    const int parent = skeleton[i].parent;
    if (parent == kNone) continue;
    if (ties[parent] == 0 || order[i] > order[parent]) {
      order[parent] = order[i], ties[parent] = 1;
    } else if (order[i] == order[parent]) {
      ++ties[parent];
    }
  }
  return order;
}

}  // namespace ramify
