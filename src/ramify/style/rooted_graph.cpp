// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/style/rooted_graph.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

#include "ramify/geometry/capsule_index.h"
#include "ramify/style/hierarchy.h"

namespace ramify {
namespace {

constexpr double kTieReach = kStartTogether;  // px between rims (PICTURES 12.2-2)
constexpr double kLooseShare = 0.3;      // of all nodes: larger trees stay on their own
constexpr double kSmallestShare = 0.015; // of the length
constexpr double kClearlyBetter = 0.7;   // of a continuation over the one drawn: twice as wide, or much longer and straighter
constexpr std::size_t kLead = 12;                // nodes over which a direction is looked at

struct Trees {
  std::vector<int> tree;  // per node
  std::vector<int> size;  // nodes per tree
  std::vector<int> root;  // node per tree
};

Trees find_trees(const Skeleton& skeleton) {
  Trees trees;
  trees.tree.resize(skeleton.count());
  for (int i = 0; i < skeleton.count(); ++i) {
    const int parent = skeleton[i].parent;
    if (parent == kNone) {
      trees.tree[i] = static_cast<int>(trees.size.size());
      trees.size.push_back(0);
      trees.root.push_back(i);
    } else {
      trees.tree[i] = trees.tree[parent];
    }
    ++trees.size[trees.tree[i]];
  }
  return trees;
}

// Trees that start from one place, as vessels from a disc do: each stays a tree of its own.
bool start_together(const Skeleton& skeleton, int root, int other) {
  return (skeleton[root].xy() - skeleton[other].xy()).norm() <= skeleton[root].radius + skeleton[other].radius + kTieReach;
}

bool on_frame(const Skeleton& skeleton, int node) {
  const Vec2 p = skeleton[node].xy();
  const double margin = std::min({p.x(), p.y(), skeleton.size.width - 1 - p.x(), skeleton.size.height - 1 - p.y()});
  return margin <= std::max(4.0, skeleton[node].radius + 3.0);
}

// Whether a tree begins where branches do, on the frame or beside other roots: nothing else is its root.
std::vector<bool> rooted_trees(const Skeleton& skeleton, const Trees& trees) {
  std::vector<bool> rooted(trees.root.size());
  for (std::size_t t = 0; t < rooted.size(); ++t) {
    rooted[t] = on_frame(skeleton, trees.root[t]);
    for (std::size_t other = 0; other < rooted.size() && !rooted[t]; ++other) {
      rooted[t] = other != t && start_together(skeleton, trees.root[t], trees.root[other]);
    }
  }
  return rooted;
}

struct Tie {
  double gap;  // px between the rims
  int end;     // a leaf or root of the loose tree
  int onto;    // node of another tree
};

// The nearest node of another tree for every end of a small tree that is not anchored.
std::vector<Tie> find_ties(const Skeleton& skeleton, const Trees& trees, const std::vector<std::vector<int>>& near,
                           const std::vector<bool>& anchored, const Monitor& monitor) {
  CapsuleIndex index(Vec2::Zero(), Vec2(skeleton.size.width, skeleton.size.height), 32.0);
  for (int i = 0; i < skeleton.count(); ++i) {
    const Node& node = skeleton[i];
    index.add({node.xy(), node.xy(), node.radius, node.radius, trees.tree[i], i});
  }
  const std::vector<bool> rooted = rooted_trees(skeleton, trees);
  std::vector<Tie> ties;
  for (int i = 0; i < skeleton.count(); ++i) {
    if (i % 1024 == 0) monitor.check();
    if (near[i].size() > 1 || trees.size[trees.tree[i]] >= kLooseShare * skeleton.count()) continue;
    if (!anchored.empty() && anchored[trees.root[trees.tree[i]]]) continue;
    if (rooted[trees.tree[i]] || on_frame(skeleton, i)) continue;
    const Vec2 end = skeleton[i].xy();
    const double radius = skeleton[i].radius;
    const Vec2 reach = Vec2::Constant(radius + kTieReach);
    Tie best{kTieReach, i, kNone};
    index.visit_box(end - reach, end + reach, [&](int number) {
      const int onto = index[number].place;
      if (index[number].owner == trees.tree[i] || (near[onto].size() < 2 && on_frame(skeleton, onto))) return true;
      const double gap = (index[number].a - end).norm() - index[number].radius_a - radius;
      if (gap < best.gap || (gap == best.gap && number < best.onto)) best = {gap, i, number};
      return true;
    });
    if (best.onto != kNone) ties.push_back(best);
  }
  std::sort(ties.begin(), ties.end(), [](const Tie& a, const Tie& b) {
    return std::tie(a.gap, a.end, a.onto) < std::tie(b.gap, b.end, b.onto);
  });
  return ties;
}

class Walker {
 public:
  Walker(const Skeleton& skeleton, const std::vector<std::vector<int>>& near) : skeleton_(skeleton), near_(near) {
    parent_.assign(near.size(), kNone);
    children_.resize(near.size());
    beyond_.assign(near.size(), 0.0);
  }

  // Roots everything that hangs together with `root`; continuations are chosen anew in the trees that were turned
  // round. Returns the length, px.
  double root_at(int root, const std::vector<bool>& turned, const std::vector<int>& tree) {
    std::vector<int> order{root};
    for (std::size_t next = 0; next < order.size(); ++next) {
      for (const int other : near_[order[next]]) {
        if (other == parent_[order[next]]) continue;
        parent_[other] = order[next];
        children_[order[next]].push_back(other);
        order.push_back(other);
      }
    }
    double length = 0.0;
    for (auto node = order.rbegin(); node != order.rend(); ++node) {
      if (parent_[*node] == kNone) continue;
      const double edge = (skeleton_[*node].xy() - skeleton_[parent_[*node]].xy()).norm();
      length += edge;
      beyond_[parent_[*node]] = std::max(beyond_[parent_[*node]], beyond_[*node] + edge);
    }
    for (const int node : order) {
      put_continuation_first(node, turned[tree[node]] ? 0.0 : kClearlyBetter);
    }
    put_longest_first(root);
    return length;
  }

  void collect_runs(int root, std::vector<GraphRun>& runs) const {
    std::vector<GraphRun> open{{{root}, kNone, kNone}};
    while (!open.empty()) {
      GraphRun run = std::move(open.back());
      open.pop_back();
      const int number = static_cast<int>(runs.size());
      for (std::size_t i = 0; i < run.nodes.size(); ++i) {
        const std::vector<int>& children = children_[run.nodes[i]];
        for (std::size_t c = 1; c < children.size(); ++c) open.push_back({{children[c]}, number, run.nodes[i]});
        if (children.empty()) continue;
        if (i >= kLead && (leaves_here(run.nodes[i], children.front()) || turns_back(run.nodes[i], run.nodes[i - kLead]))) {
          open.push_back({{children.front()}, kNone, kNone});
        } else {
          run.nodes.push_back(children.front());
        }
      }
      runs.push_back(std::move(run));
    }
  }

 private:
  // A stump at the root (a collar drawn first) leads no tree: the way that goes on does.
  void put_longest_first(int root) {
    std::vector<int>& children = children_[root];
    if (children.size() < 2) return;
    const auto longest = std::max_element(children.begin(), children.end(), [&](int a, int b) { return beyond_[a] < beyond_[b]; });
    if (beyond_[children.front()] < 0.1 * beyond_[*longest]) std::rotate(children.begin(), longest, longest + 1);
  }

  // margin: by how much another child must be better than the first.
  void put_continuation_first(int node, double margin) {
    std::vector<int>& children = children_[node];
    if (children.size() < 2) return;
    int back = node;
    for (std::size_t i = 0; i < kLead && parent_[back] != kNone; ++i) back = parent_[back];
    const Vec2 arriving = (skeleton_[node].xy() - skeleton_[back].xy()).stableNormalized();
    const auto score = [&](int child) {
      int ahead = child;
      double widths = std::log(skeleton_[child].radius + 0.3);
      std::size_t count = 1;
      while (count < kLead && !children_[ahead].empty()) {
        ahead = *std::max_element(children_[ahead].begin(), children_[ahead].end(),
                                  [&](int a, int b) { return beyond_[a] < beyond_[b]; });
        widths += std::log(skeleton_[ahead].radius + 0.3);
        ++count;
      }
      const Vec2 leaving = (skeleton_[ahead].xy() - skeleton_[node].xy()).stableNormalized();
      return arriving.dot(leaving) + widths / static_cast<double>(count) + 0.35 * std::log(beyond_[child] + 5.0);
    };
    const auto best = std::max_element(children.begin(), children.end(),
                                       [&](int a, int b) { return score(a) < score(b); });
    if (score(*best) > score(children.front()) + margin) std::rotate(children.begin(), best, best + 1);
  }

  // Whether a branch leaves the picture at this node: what goes on from there is much thinner, and another.
  bool leaves_here(int node, int next) const {
    constexpr double kOnEdge = 3.0, kThinner = 0.6;
    const Vec2 p = skeleton_[node].xy();
    if (std::min({p.x(), p.y(), skeleton_.size.width - 1 - p.x(), skeleton_.size.height - 1 - p.y()}) > kOnEdge) return false;
    double widths = 0.0;
    int count = 0;
    for (; count < static_cast<int>(kLead); ++count) {
      widths += skeleton_[next].radius;
      if (children_[next].empty()) break;
      next = children_[next].front();
    }
    return widths / std::max(1, count) < kThinner * skeleton_[node].radius;
  }

  // Whether a branch that has come to the frame doubles back: traced twice in wide water, or another branch that enters.
  bool turns_back(int node, int before) const {
    constexpr double kNearFrame = 12.0, kBack = -0.5;
    const Vec2 p = skeleton_[node].xy();
    const double margin = std::min({p.x(), p.y(), skeleton_.size.width - 1 - p.x(), skeleton_.size.height - 1 - p.y()});
    if (margin > kNearFrame) return false;
    int ahead = node;
    for (std::size_t i = 0; i < kLead && !children_[ahead].empty(); ++i) ahead = children_[ahead].front();
    const Vec2 arriving = (p - skeleton_[before].xy()).stableNormalized();
    return arriving.dot((skeleton_[ahead].xy() - p).stableNormalized()) < kBack;
  }

  const Skeleton& skeleton_;
  const std::vector<std::vector<int>>& near_;
  std::vector<int> parent_;
  std::vector<std::vector<int>> children_;
  std::vector<double> beyond_;  // px, longest way on from a node
};

bool reaches_frame(const Skeleton& skeleton, const std::vector<int>& nodes) {
  return std::any_of(nodes.begin(), nodes.end(), [&](int i) {
    const Vec2 p = skeleton[i].xy();
    return std::min({p.x(), p.y(), skeleton.size.width - 1 - p.x(), skeleton.size.height - 1 - p.y()}) < 5.0;
  });
}

int find_group(std::vector<int>& group, int i) {
  while (group[i] != i) i = group[i] = group[group[i]];
  return i;
}

}  // namespace

RootedGraph tie_loose_trees(const Skeleton& skeleton, const std::vector<bool>& anchored, const Monitor& monitor) {
  std::vector<std::vector<int>> near(skeleton.count());
  for (int i = 0; i < skeleton.count(); ++i) {
    if (skeleton[i].parent == kNone) continue;
    near[skeleton[i].parent].push_back(i);
    near[i].push_back(skeleton[i].parent);
  }
  const Trees trees = find_trees(skeleton);
  RootedGraph graph;
  std::vector<int> group(trees.size.size());
  std::iota(group.begin(), group.end(), 0);
  std::vector<bool> turned(group.size(), false);
  for (const Tie& tie : find_ties(skeleton, trees, near, anchored, monitor)) {
    const int loose = find_group(group, trees.tree[tie.end]), host = find_group(group, trees.tree[tie.onto]);
    if (loose == host) continue;
    near[tie.end].push_back(tie.onto);
    near[tie.onto].push_back(tie.end);
    group[loose] = host;
    if (tie.end != trees.root[trees.tree[tie.end]]) turned[trees.tree[tie.end]] = true;
    ++graph.tied;
  }
  // The root of a group is that of its largest tree.
  std::vector<int> main_tree(group.size(), kNone);
  for (int t = 0; t < static_cast<int>(group.size()); ++t) {
    const int g = find_group(group, t);
    if (main_tree[g] == kNone || trees.size[t] > trees.size[main_tree[g]]) main_tree[g] = t;
  }
  Walker walker(skeleton, near);
  std::vector<double> lengths(group.size(), 0.0);
  double total = 0.0;
  for (std::size_t g = 0; g < group.size(); ++g) {
    if (main_tree[g] != kNone) total += lengths[g] = walker.root_at(trees.root[main_tree[g]], turned, trees.tree);
  }
  for (std::size_t g = 0; g < group.size(); ++g) {
    if (main_tree[g] == kNone) continue;
    std::vector<GraphRun> runs;
    walker.collect_runs(trees.root[main_tree[g]], runs);
    std::vector<int> nodes;
    for (const GraphRun& run : runs) nodes.insert(nodes.end(), run.nodes.begin(), run.nodes.end());
    if (lengths[g] < kSmallestShare * total && !reaches_frame(skeleton, nodes)) {
      ++graph.dropped;
      continue;
    }
    const int offset = static_cast<int>(graph.runs.size());
    for (GraphRun& run : runs) {
      if (run.parent_run != kNone) run.parent_run += offset;
      graph.runs.push_back(std::move(run));
    }
  }
  return graph;
}

}  // namespace ramify
