// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/skeleton/assemble.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "ramify/skeleton/branches.h"

namespace ramify {
namespace {

using Nodes = std::vector<LooseNode>;

// Children of every node in the order they are listed: those of node i are items[first[i]] … items[first[i + 1] - 1].
struct Children {
  std::vector<int> first;
  std::vector<int> items;
};

Children children_of(const Nodes& nodes) {
  const int count = static_cast<int>(nodes.size());
  Children children;
  children.first.assign(nodes.size() + 1, 0);
  for (int i = 0; i < count; ++i) {
    const int parent = nodes[i].parent;
    if (parent != kNone && (parent < 0 || parent >= count || parent == i)) {
      throw std::invalid_argument("assemble_skeleton: node " + std::to_string(i) + " has no valid parent");
    }
    if (parent != kNone) ++children.first[parent + 1];
  }
  for (int i = 0; i < count; ++i) children.first[i + 1] += children.first[i];
  children.items.resize(children.first.back());
  std::vector<int> next(children.first.begin(), children.first.end() - 1);
  for (int i = 0; i < count; ++i) {
    if (nodes[i].parent != kNone) children.items[next[nodes[i].parent]++] = i;
  }
  return children;
}

// Parents before children.
std::vector<int> downward(const Nodes& nodes, const Children& children) {
  std::vector<int> order;
  order.reserve(nodes.size());
  for (int i = 0; i < static_cast<int>(nodes.size()); ++i) {
    if (nodes[i].parent == kNone) order.push_back(i);
  }
  for (std::size_t k = 0; k < order.size(); ++k) {
    for (int c = children.first[order[k]]; c < children.first[order[k] + 1]; ++c) order.push_back(children.items[c]);
  }
  if (order.size() != nodes.size()) throw std::invalid_argument("assemble_skeleton: the parents form a cycle");
  return order;
}

// Direction and radius are taken some way along, not on the first edge: a traced edge of one pixel has one of eight
// directions, and a child's first stretch lies inside its parent (PICTURES 3).
constexpr int kLookSteps = 64;
double look_length(double radius) { return std::max(3.0 * radius, 5.0); }

struct Straightness {
  const Nodes& nodes;
  const std::vector<double>& subtree;  // px of edges below every node, its own edge to the parent included
  const std::vector<int>& heaviest;    // child with the longest subtree, or kNone

  double score(int parent, int child, double total) const {
    const double reach = look_length(nodes[parent].radius);
    int ahead = child, behind = parent;
    for (int k = 0; k < kLookSteps && heaviest[ahead] != kNone && far(parent, ahead) < reach; ++k) ahead = heaviest[ahead];
    for (int k = 0; k < kLookSteps && nodes[behind].parent != kNone && far(parent, behind) < reach; ++k) {
      behind = nodes[behind].parent;
    }
    const Vec3 in = nodes[parent].position - nodes[behind].position, out = nodes[ahead].position - nodes[parent].position;
    const double norms = in.norm() * out.norm();
    const double straight = norms > 0.0 ? in.dot(out) / norms : 0.0;
    const double ratio = std::min(nodes[ahead].radius / nodes[parent].radius, 1.5);
    return straight + 0.5 * ratio + (total > 0.0 ? 0.25 * subtree[child] / total : 0.0);
  }
  double far(int a, int b) const { return (nodes[a].position - nodes[b].position).norm(); }
};

// The child that continues its parent's branch, or kNone at tips.
std::vector<int> continuations(const Nodes& nodes, const Children& children, const std::vector<int>& order,
                               ContinuationRule rule) {
  std::vector<int> next(nodes.size(), kNone);
  std::vector<double> subtree(nodes.size(), 0.0);
  std::vector<int> heaviest(nodes.size(), kNone);
  for (auto it = order.rbegin(); it != order.rend(); ++it) {
    const int parent = nodes[*it].parent;
    if (parent == kNone) continue;
    subtree[*it] += (nodes[*it].position - nodes[parent].position).norm();
    subtree[parent] += subtree[*it];
    if (heaviest[parent] == kNone || subtree[*it] > subtree[heaviest[parent]]) heaviest[parent] = *it;
  }
  const Straightness straightness{nodes, subtree, heaviest};
  for (const int i : order) {
    const int from = children.first[i], to = children.first[i + 1];
    if (from < to) next[i] = children.items[from];
    if (rule == ContinuationRule::AsListed || to - from < 2) continue;
    double total = 0.0, best = -1e300;
    for (int c = from; c < to; ++c) total += subtree[children.items[c]];
    for (int c = from; c < to; ++c) {
      const double score = straightness.score(i, children.items[c], total);
      if (score > best) best = score, next[i] = children.items[c];
    }
  }
  return next;
}

// True when the nodes may stay as listed.
bool in_order(const Nodes& nodes, const Children& children, const std::vector<int>& next) {
  for (int i = 0; i < static_cast<int>(nodes.size()); ++i) {
    if (nodes[i].parent >= i) return false;
    if (next[i] != kNone && next[i] != children.items[children.first[i]]) return false;
  }
  return true;
}

// Branch after branch, base to tip, side branches queued behind.
std::vector<int> emission(const Nodes& nodes, const Children& children, const std::vector<int>& next) {
  std::vector<int> order, starts;
  for (int i = 0; i < static_cast<int>(nodes.size()); ++i) {
    if (nodes[i].parent == kNone) starts.push_back(i);
  }
  for (std::size_t k = 0; k < starts.size(); ++k) {
    for (int i = starts[k]; i != kNone; i = next[i]) {
      order.push_back(i);
      for (int c = children.first[i]; c < children.first[i + 1]; ++c) {
        if (children.items[c] != next[i]) starts.push_back(children.items[c]);
      }
    }
  }
  return order;
}

}  // namespace

Assembled assemble_skeleton(const Nodes& nodes, Size canvas, ContinuationRule rule) {
  const Children children = children_of(nodes);
  std::vector<int> order = downward(nodes, children);
  const std::vector<int> next = continuations(nodes, children, order, rule);
  if (in_order(nodes, children, next)) {
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = static_cast<int>(i);
  } else {
    order = emission(nodes, children, next);
  }
  Assembled result{Skeleton(canvas), std::vector<int>(nodes.size(), kNone)};
  for (const int i : order) {
    const LooseNode& node = nodes[i];
    const int parent = node.parent == kNone ? kNone : result.index_of[node.parent];
    result.index_of[i] = result.skeleton.append({node.position, node.radius, parent, 0, node.tag});
  }
  count_orders(result.skeleton);
  return result;
}

std::vector<std::pair<int, int>> cut_cycles(Nodes& nodes) {
  std::vector<std::pair<int, int>> cut;
  std::vector<int> seen(nodes.size(), kNone);  // the walk that came by first
  for (int start = 0; start < static_cast<int>(nodes.size()); ++start) {
    int i = start;
    while (i != kNone && seen[i] == kNone) {
      seen[i] = start;
      i = nodes[i].parent;
    }
    if (i == kNone || seen[i] != start) continue;  // a root, or what an earlier walk has settled
    int lowest = i;
    for (int k = nodes[i].parent; k != i; k = nodes[k].parent) lowest = std::min(lowest, k);
    cut.emplace_back(lowest, nodes[lowest].parent);
    nodes[lowest].parent = kNone;
  }
  return cut;
}

Skeleton order_continuations(const Skeleton& skeleton) {
  Nodes nodes;
  for (const Node& node : skeleton.nodes()) nodes.push_back({node.position, node.radius, node.parent, node.tag});
  Assembled result = assemble_skeleton(nodes, skeleton.size, ContinuationRule::Straightest);
  result.skeleton.dim = skeleton.dim;
  for (const auto& [a, b] : skeleton.loop_links) {
    result.skeleton.loop_links.emplace_back(result.index_of[a], result.index_of[b]);
  }
  return result.skeleton;
}

void count_orders(Skeleton& skeleton) {
  const BranchTree tree = branch_tree(skeleton);
  for (int i = 0; i < skeleton.count(); ++i) skeleton.set_order(i, tree.branches[tree.branch_of_node[i]].order);
}

}  // namespace ramify
