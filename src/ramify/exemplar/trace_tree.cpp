// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/exemplar/trace_tree.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "ramify/exemplar/traced_line.h"

namespace ramify {
namespace {

double mean_radius(const TraceEdge& e) {
  return std::accumulate(e.radii.begin(), e.radii.end(), 0.0) / static_cast<double>(e.radii.size());
}

// Radius of an edge near one of its ends, beyond the other branches' width.
double end_radius(const TraceEdge& e, bool at_from) {
  const std::size_t i = std::min(e.radii.size() - 1, static_cast<std::size_t>(6));
  return at_from ? e.radii[i] : e.radii[e.radii.size() - 1 - i];
}

// Direction in which an edge leaves one of its ends.
Vec2 leaving(const TraceEdge& e, bool at_from) {
  const int n = static_cast<int>(e.line.size());
  const int reach = std::min(n - 1, std::max(8, static_cast<int>(2.0 * end_radius(e, at_from))));
  const Vec2 d = at_from ? Vec2(e.line[reach] - e.line[0]) : Vec2(e.line[n - 1 - reach] - e.line[n - 1]);
  return d.norm() > 0.0 ? Vec2(d.normalized()) : Vec2(1.0, 0.0);
}

// The graph being ordered: which edges are in the tree, and the tree's shape once a root is chosen.
struct Forest {
  const TraceGraph& graph;
  std::vector<std::vector<int>> incident;
  std::vector<bool> in_tree;
  std::vector<int> component;  // of a node
};

int other_end(const TraceEdge& e, int node) { return e.from == node ? e.to : e.from; }

// Maximum spanning forest by thickness x length x confidence (Kruskal).
Forest spanning_forest(const TraceGraph& graph) {
  Forest f{graph, graph.edges_of_nodes(), std::vector<bool>(graph.edges.size(), false),
           std::vector<int>(graph.nodes.size())};
  std::vector<int> order(graph.edges.size());
  std::iota(order.begin(), order.end(), 0);
  std::vector<double> weight;
  for (const TraceEdge& e : graph.edges) weight.push_back(mean_radius(e) * line_length(e.line) * (0.05 + e.confidence));
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return weight[a] > weight[b]; });
  std::iota(f.component.begin(), f.component.end(), 0);
  const auto find = [&](int i) {
    while (f.component[i] != i) i = f.component[i] = f.component[f.component[i]];
    return i;
  };
  for (const int i : order) {
    const int a = find(graph.edges[i].from), b = find(graph.edges[i].to);
    if (a == b) continue;
    f.component[a] = b;
    f.in_tree[i] = true;
  }
  for (std::size_t n = 0; n < graph.nodes.size(); ++n) f.component[n] = find(static_cast<int>(n));
  return f;
}

// How well the forks open forwards and get thinner when the component hangs from `root` (PICTURES 12.2-2).
double root_score(const Forest& f, int root, Size size, double margin) {
  double sum = 0.0;
  int forks = 0;
  std::vector<std::pair<int, int>> stack{{root, kNone}};  // node, edge it was reached by
  while (!stack.empty()) {
    const auto [node, by] = stack.back();
    stack.pop_back();
    for (const int e : f.incident[node]) {
      if (!f.in_tree[e] || e == by) continue;
      const TraceEdge& child = f.graph.edges[e];
      if (by != kNone) {
        const TraceEdge& parent = f.graph.edges[by];
        const double cosine = -leaving(parent, parent.from == node).dot(leaving(child, child.from == node));
        const double ratio = end_radius(parent, parent.from == node) / end_radius(child, child.from == node);
        sum += cosine + 0.5 * std::log(ratio);
        ++forks;
      }
      stack.emplace_back(other_end(child, node), e);
    }
  }
  const int first = f.incident[root].front();
  const TraceEdge& e = f.graph.edges[first];
  const double r = end_radius(e, e.from == root);
  const Vec2 p = f.graph.nodes[root];
  const double edge = std::min({p.x(), p.y(), size.width - 1 - p.x(), size.height - 1 - p.y()});
  return (forks ? sum / forks : 0.0) + 0.5 * std::log(r) + (edge < margin + r ? 0.3 : 0.0);
}

int choose_root(const Forest& f, const std::vector<int>& nodes, Size size, const TreeOptions& options) {
  if (options.root) {
    // Only a root really pointed at counts; other components choose their own.
    int nearest = nodes.front();
    for (const int n : nodes) {
      if ((f.graph.nodes[n] - *options.root).norm() < (f.graph.nodes[nearest] - *options.root).norm()) nearest = n;
    }
    if ((f.graph.nodes[nearest] - *options.root).norm() < 0.05 * std::max(size.width, size.height)) return nearest;
  }
  // True ends only; where a loop was cut the tree ends as well, but nothing starts there. A component of loops alone may
  // start anywhere.
  int best = kNone;
  double best_score = -1e300;
  for (const bool ends_only : {true, false}) {
    for (const int n : nodes) {
      if (best != kNone && !ends_only) break;
      if (ends_only && f.incident[n].size() != 1) continue;
      const double score = root_score(f, n, size, options.frame_margin);
      if (score > best_score) {
        best_score = score;
        best = n;
      }
    }
  }
  return best;
}

// Builds branches from the tree; remembers which branch point each graph node became.
class BranchBuilder {
 public:
  BranchBuilder(const Forest& forest, Size size, double margin)
      : f_(forest), size_(size), margin_(margin), place_(forest.graph.nodes.size()) {
    annotation_.photo_size = size;
    subtree_.assign(forest.graph.edges.size(), 0.0);
  }

  void grow(int root) {
    measure_subtrees(root);
    std::vector<std::pair<int, int>> starts;  // node, edge
    const int first = best_child(root, kNone);
    if (first == kNone) return;
    walk(root, first, std::nullopt, starts);
    queue_children(root, kNone, first, starts);
    for (std::size_t i = 0; i < starts.size(); ++i) {
      const auto [node, edge] = starts[i];
      walk(node, edge, place_[node], starts);
    }
  }

  // An edge that closes a loop: a branch of the thicker end whose tip is linked to the other end.
  void add_loop(int edge) {
    const TraceEdge& e = f_.graph.edges[edge];
    if (!place_[e.from] || !place_[e.to]) return;
    const double at_from = radius_of(*place_[e.from]), at_to = radius_of(*place_[e.to]);
    const int start = at_from >= at_to ? e.from : e.to;
    const int end = other_end(e, start);
    AnnotatedBranch branch;
    branch.parent = place_[start];
    append(branch, edge, start);
    cut_at_rim(branch, radius_of(*place_[start]), true);
    const BranchPoint tip{static_cast<int>(annotation_.branches.size()), static_cast<int>(branch.points.size()) - 1};
    finish(branch);
    annotation_.links.emplace_back(tip, *place_[end]);
  }

  Annotation take() { return std::move(annotation_); }

 private:
  double radius_of(const BranchPoint& p) const {
    return annotation_.branches[p.branch].radii[p.point];
  }

  void measure_subtrees(int root) {
    std::vector<std::pair<int, int>> order{{root, kNone}};
    for (std::size_t i = 0; i < order.size(); ++i) {
      const auto [node, by] = order[i];
      for (const int e : f_.incident[node]) {
        if (f_.in_tree[e] && e != by) order.emplace_back(other_end(f_.graph.edges[e], node), e);
      }
    }
    for (std::size_t i = order.size(); i-- > 1;) {
      const auto [node, by] = order[i];
      double length = line_length(f_.graph.edges[by].line);
      for (const int e : f_.incident[node]) {
        if (f_.in_tree[e] && e != by) length += subtree_[e];
      }
      subtree_[by] = length;
    }
  }

  // The continuation at a node reached by edge `by`: straight on, thick, and with much behind it (ALGORITHMS 3.3-9).
  int best_child(int node, int by) const {
    double total = 0.0;
    for (const int e : f_.incident[node]) {
      if (f_.in_tree[e] && e != by) total += subtree_[e];
    }
    int best = kNone;
    double best_score = -1e300;
    for (const int e : f_.incident[node]) {
      if (!f_.in_tree[e] || e == by) continue;
      const TraceEdge& child = f_.graph.edges[e];
      double score = 0.5 * end_radius(child, child.from == node) + 0.25 * subtree_[e] / std::max(total, 1e-9);
      if (by != kNone) {
        const TraceEdge& parent = f_.graph.edges[by];
        score = -leaving(parent, parent.from == node).dot(leaving(child, child.from == node)) +
                0.5 * std::min(1.5, end_radius(child, child.from == node) / end_radius(parent, parent.from == node)) +
                0.25 * subtree_[e] / std::max(total, 1e-9);
      }
      if (score > best_score) {
        best_score = score;
        best = e;
      }
    }
    return best;
  }

  void queue_children(int node, int by, int continuation, std::vector<std::pair<int, int>>& starts) const {
    for (const int e : f_.incident[node]) {
      if (f_.in_tree[e] && e != by && e != continuation) starts.emplace_back(node, e);
    }
  }

  void append(AnnotatedBranch& branch, int edge, int from) const {
    const TraceEdge& e = f_.graph.edges[edge];
    const int n = static_cast<int>(e.line.size());
    for (int k = branch.points.empty() && !branch.parent ? 0 : 1; k < n; ++k) {
      const int i = e.from == from ? k : n - 1 - k;
      branch.points.push_back(e.line[i]);
      branch.radii.push_back(e.radii[i]);
    }
    const double length = line_length(e.line), before = length_;
    confidence_ = (confidence_ * before + e.confidence * length) / std::max(before + length, 1e-9);
    length_ += length;
  }

  // Follows continuations from `node` along `edge` to a tip.
  void walk(int node, int edge, std::optional<BranchPoint> parent, std::vector<std::pair<int, int>>& starts) {
    AnnotatedBranch branch;
    branch.parent = parent;
    const int index = static_cast<int>(annotation_.branches.size());
    std::vector<std::pair<int, int>> passed;  // node, point of this branch
    if (!parent) passed.emplace_back(node, 0);
    while (edge != kNone) {
      append(branch, edge, node);
      node = other_end(f_.graph.edges[edge], node);
      passed.emplace_back(node, static_cast<int>(branch.points.size()) - 1);
      const int next = best_child(node, edge);
      queue_children(node, edge, next, starts);
      edge = next;
    }
    const int cut = parent ? cut_at_rim(branch, radius_of(*parent), passed.size() == 1) : 0;
    for (const auto& [n, point] : passed) place_[n] = BranchPoint{index, std::max(0, point - cut)};
    finish(branch);
  }

  // A child's stretch inside its parent teaches a false taper (PICTURES 3): drop the points inside the parent's rim and
  // give the next ones the radius the branch has once it is clear. Returns how many points went.
  int cut_at_rim(AnnotatedBranch& branch, double parent_radius, bool single) const {
    const Vec2 base = annotation_.branches[branch.parent->branch].points[branch.parent->point];
    const int n = static_cast<int>(branch.points.size());
    int cut = 0, clear = 0;
    while (cut + 2 < n && (branch.points[cut] - base).norm() < 0.9 * parent_radius) ++cut;
    while (clear + 1 < n && (branch.points[clear] - base).norm() < 1.5 * parent_radius + 2.0) ++clear;
    if (!single) cut = std::min(cut, n / 4);
    for (int i = 0; i < clear; ++i) branch.radii[i] = std::min(branch.radii[clear], parent_radius);
    branch.points.erase(branch.points.begin(), branch.points.begin() + cut);
    branch.radii.erase(branch.radii.begin(), branch.radii.begin() + cut);
    return cut;
  }

  void finish(AnnotatedBranch& branch) {
    branch.confidence = confidence_;
    const Vec2& tip = branch.points.back();
    const double edge = std::min({tip.x(), tip.y(), size_.width - 1 - tip.x(), size_.height - 1 - tip.y()});
    if (edge < margin_ + branch.radii.back()) branch.leaves_frame = true;
    annotation_.branches.push_back(std::move(branch));
    confidence_ = length_ = 0.0;
  }

  const Forest& f_;
  Size size_;
  double margin_;
  std::vector<std::optional<BranchPoint>> place_;
  std::vector<double> subtree_;
  Annotation annotation_;
  mutable double confidence_ = 0.0, length_ = 0.0;
};

}  // namespace

Annotation annotation_from_graph(const TraceGraph& graph, Size size, const TreeOptions& options) {
  const Forest forest = spanning_forest(graph);
  std::vector<std::vector<int>> members(graph.nodes.size());
  for (std::size_t n = 0; n < graph.nodes.size(); ++n) members[forest.component[n]].push_back(static_cast<int>(n));
  std::vector<std::pair<double, int>> order;  // the component with most line first
  std::vector<double> total(graph.nodes.size(), 0.0);
  for (const TraceEdge& e : graph.edges) total[forest.component[e.from]] += line_length(e.line);
  for (std::size_t c = 0; c < members.size(); ++c) {
    if (!members[c].empty()) order.emplace_back(-total[c], static_cast<int>(c));
  }
  std::sort(order.begin(), order.end());
  BranchBuilder builder(forest, size, options.frame_margin);
  for (const auto& [length, c] : order) builder.grow(choose_root(forest, members[c], size, options));
  for (std::size_t e = 0; e < graph.edges.size(); ++e) {
    if (!forest.in_tree[e]) builder.add_loop(static_cast<int>(e));
  }
  return builder.take();
}

}  // namespace ramify
