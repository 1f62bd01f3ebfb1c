// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/exemplar/trace_tree.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <set>

#include "ramify/exemplar/trace_plan.h"
#include "ramify/exemplar/traced_line.h"
#include "ramify/geometry/polyline.h"

namespace ramify {
namespace {

constexpr double kRootReach = 0.05;    // of the larger side: how far from a given root the structure may be
constexpr double kWideParent = 3.0;    // px of radius: thinner parents bend no child
constexpr std::size_t kMostRoots = 48; // ends tried as roots, the thickest ones

// Component of every node (the smallest node index in it).
std::vector<int> components_of(const TraceGraph& graph) {
  std::vector<int> parent(graph.nodes.size());
  std::iota(parent.begin(), parent.end(), 0);
  const auto find = [&](int i) {
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
  };
  for (const TraceEdge& e : graph.edges) {
    const int a = find(e.from), b = find(e.to);
    parent[std::max(a, b)] = std::min(a, b);
  }
  for (std::size_t n = 0; n < parent.size(); ++n) parent[n] = find(static_cast<int>(n));
  return parent;
}

std::vector<int> given_roots(const TraceGraph& graph, Size size, const TreeOptions& options) {
  std::vector<int> roots;
  for (const Vec2& p : options.roots) {
    int nearest = 0;
    for (std::size_t n = 0; n < graph.nodes.size(); ++n) {
      if ((graph.nodes[n] - p).norm() < (graph.nodes[nearest] - p).norm()) nearest = static_cast<int>(n);
    }
    if ((graph.nodes[nearest] - p).norm() < kRootReach * std::max(size.width, size.height)) roots.push_back(nearest);
  }
  return roots;
}

// Ends that the frame has cut. The rim of an outside region is no frame: a leaf's veins do end at its margin.
std::vector<bool> frame_nodes(const TraceGraph& graph, Size size, const TreeOptions& options) {
  const auto incident = graph.edges_of_nodes();
  std::vector<bool> on_frame(graph.nodes.size(), false);
  for (std::size_t n = 0; n < graph.nodes.size(); ++n) {
    if (incident[n].size() != 1) continue;
    const TraceEdge& e = graph.edges[incident[n].front()];
    const Vec2 p = graph.nodes[n];
    const double edge = std::min({p.x(), p.y(), size.width - 1 - p.x(), size.height - 1 - p.y()});
    on_frame[n] = edge < options.frame_margin + (e.from == static_cast<int>(n) ? e.radii.front() : e.radii.back());
  }
  return on_frame;
}

// The entries of one component: all strokes at its root node.
std::vector<StrokePlace> best_plan(const StrokeNet& net, std::vector<std::pair<double, int>> candidates,
                                   const std::vector<bool>& on_frame) {
  std::sort(candidates.begin(), candidates.end());
  if (candidates.size() > kMostRoots) candidates.resize(kMostRoots);
  std::vector<StrokePlace> best;
  double best_score = 0.0;
  for (const auto& [radius, node] : candidates) {
    std::vector<StrokePlace> plan = plan_from(net, net.touching[node]);
    const double score = plan_score(net, plan, on_frame[node]);
    if (!best.empty() && score <= best_score) continue;
    best = std::move(plan);
    best_score = score;
  }
  return best;
}

std::vector<StrokePlace> plan_component(const StrokeNet& net, const std::vector<int>& nodes, const std::vector<int>& roots,
                                        const std::vector<bool>& on_frame) {
  std::vector<std::pair<int, int>> entries;
  for (const int root : roots) {
    if (std::binary_search(nodes.begin(), nodes.end(), root)) {
      entries.insert(entries.end(), net.touching[root].begin(), net.touching[root].end());
    }
  }
  if (!entries.empty()) return plan_from(net, entries);
  std::vector<std::pair<double, int>> candidates;
  for (const bool ends_only : {true, false}) {
    for (const int n : nodes) {
      if ((ends_only && net.touching[n].size() != 1) || net.touching[n].empty()) continue;
      const auto& [s, i] = net.touching[n].front();
      const TraceStroke& stroke = net.strokes[s];
      if (ends_only && i > 0 && i + 1 < static_cast<int>(stroke.nodes.size())) continue;
      candidates.emplace_back(-stroke.radii[stroke.at[i]], n);
    }
    if (!candidates.empty()) break;
  }
  return best_plan(net, std::move(candidates), on_frame);
}

// Turns placed strokes into annotated branches; remembers which branch point each stroke node became.
class BranchBuilder {
 public:
  BranchBuilder(const StrokeNet& net, const std::vector<bool>& on_frame, Size size) : net_(net), on_frame_(on_frame) {
    annotation_.photo_size = size;
  }

  void add(const std::vector<StrokePlace>& plan) {
    point_of_.assign(plan.size(), {});
    for (std::size_t p = 0; p < plan.size(); ++p) {
      const TraceStroke& s = net_.strokes[plan[p].stroke];
      const int last = static_cast<int>(s.nodes.size()) - 1, start = plan[p].start;
      point_of_[p].assign(s.nodes.size(), std::nullopt);
      std::optional<BranchPoint> parent;
      if (plan[p].parent != kNone) parent = point_of_[plan[p].parent][plan[p].parent_node];
      // The way that goes straighter on comes first: it may carry on the parent where that ends.
      bool forward = start < last;
      if (start > 0 && start < last && parent) {
        const Vec2 way = way_into(*parent);
        forward = way.dot(heading(s, s.at[start], 1)) >= way.dot(heading(s, s.at[start], -1));
      }
      for (const int sign : {forward ? 1 : -1, forward ? -1 : 1}) {
        if (sign > 0 ? start < last : start > 0) walk(static_cast<int>(p), s, start, sign, parent);
      }
    }
  }

  Annotation take() {
    link_tips();
    return std::move(annotation_);
  }

 private:
  struct Tip {
    int node = kNone;
    double confidence_length = 0.0;
  };

  Vec2 way_into(const BranchPoint& p) const {
    const auto& points = annotation_.branches[p.branch].points;
    return tangent_at(points, p.point, 8);
  }

  double radius_at(const BranchPoint& p) const { return annotation_.branches[p.branch].radii[p.point]; }

  // One stroke from node `start` to one of its ends: a new branch, or more of the parent that ends there.
  void walk(int place, const TraceStroke& s, int start, int sign, const std::optional<BranchPoint>& parent) {
    std::vector<Vec2> line;
    std::vector<double> radii;
    std::vector<std::pair<int, int>> passed;  // index into the stroke's nodes, point
    const int end = sign > 0 ? static_cast<int>(s.nodes.size()) - 1 : 0;
    for (int i = s.at[start]; i != s.at[end] + sign; i += sign) {
      line.push_back(s.line[i]);
      radii.push_back(s.radii[i]);
    }
    for (int k = start; k != end + sign; k += sign) passed.emplace_back(k, std::abs(s.at[k] - s.at[start]));
    const int tip_node = s.nodes[end];
    if (parent && extends(*parent, line)) return extend(place, s, *parent, line, radii, passed, tip_node);
    AnnotatedBranch branch;
    branch.parent = parent;
    int cut = 0;
    if (parent) {
      cut = inside_parent(line, *parent, 0.9);
      const int covered = inside_parent(line, *parent, 1.25);
      const int n = static_cast<int>(line.size());
      if (covered + 4 >= n) {  // never leaves the parent: its nodes are the parent's
        for (const auto& [k, point] : passed) point_of_[place][k] = nearest_on(parent->branch, s.line[s.at[k]]);
        return;
      }
      clear_start(radii, line, *parent);
      cut = straightened_start(line, radii, cut, branch.parent);
      line.erase(line.begin(), line.begin() + cut);
      radii.erase(radii.begin(), radii.begin() + cut);
    }
    const int index = static_cast<int>(annotation_.branches.size());
    for (const auto& [k, point] : passed) {
      if (point < cut) point_of_[place][k] = nearest_on(parent->branch, s.line[s.at[k]]);
      else point_of_[place][k] = BranchPoint{index, point - cut};
      if (point >= cut) at_node_.emplace_back(s.nodes[k], BranchPoint{index, point - cut});
    }
    branch.points = std::move(line);
    branch.radii = std::move(radii);
    branch.confidence = s.confidence;
    if (on_frame_[tip_node]) branch.leaves_frame = true;
    annotation_.branches.push_back(std::move(branch));
    tips_.push_back({tip_node, line_length(annotation_.branches.back().points)});
  }

  // Does the parent end where the child starts, and go straight on in it?
  bool extends(const BranchPoint& p, const std::vector<Vec2>& line) const {
    const AnnotatedBranch& b = annotation_.branches[p.branch];
    if (p.point + 1 != static_cast<int>(b.points.size()) || line.size() < 2) return false;
    const Vec2 on = tangent_at(line, 0, std::min<int>(12, static_cast<int>(line.size()) - 1));
    return tangent_at(b.points, p.point, 12).dot(on) > 0.0;
  }

  void extend(int place, const TraceStroke& s, const BranchPoint& parent, const std::vector<Vec2>& line,
              const std::vector<double>& radii, const std::vector<std::pair<int, int>>& passed, int tip_node) {
    AnnotatedBranch& b = annotation_.branches[parent.branch];
    const int offset = static_cast<int>(b.points.size()) - 1;
    const double more = line_length(line), before = tips_[parent.branch].confidence_length;
    b.confidence = (*b.confidence * before + s.confidence * more) / std::max(before + more, 1e-9);
    b.points.insert(b.points.end(), line.begin() + 1, line.end());
    b.radii.insert(b.radii.end(), radii.begin() + 1, radii.end());
    b.leaves_frame.reset();
    if (on_frame_[tip_node]) b.leaves_frame = true;
    tips_[parent.branch] = {tip_node, before + more};
    for (const auto& [k, point] : passed) {
      point_of_[place][k] = BranchPoint{parent.branch, offset + point};
      if (point > 0) at_node_.emplace_back(s.nodes[k], *point_of_[place][k]);
    }
  }

  // The middle line of an area enters a wide parent at a right angle. Where the child's own course, read once it is clear
  // of the rim, meets the parent's middle nearby, it starts there, and its bent first piece goes. Returns the first point
  // kept.
  int straightened_start(const std::vector<Vec2>& line, const std::vector<double>& radii, int cut,
                         std::optional<BranchPoint>& at) const {
    const AnnotatedBranch& b = annotation_.branches[at->branch];
    const double wide = b.radii[at->point];
    const int n = static_cast<int>(line.size()), clear = cut + static_cast<int>(1.5 * radii[cut]);
    const int ahead = clear + std::max(8, static_cast<int>(2.0 * radii[cut]));
    if (wide < kWideParent || ahead >= n) return cut;
    const Vec2 way = (line[ahead] - line[clear]).normalized();
    BranchPoint best = *at;
    double nearest = 2.0;
    for (int i = 0; i < static_cast<int>(b.points.size()); ++i) {
      const Vec2 back = line[clear] - b.points[i];
      if (back.norm() > 3.0 * wide + (line[clear] - line[cut]).norm() || back.dot(way) <= 0.0) continue;
      const double beside = std::abs(back.dot(perpendicular(way)));
      if (beside >= nearest) continue;
      nearest = beside;
      best.point = i;
    }
    if (best.point == at->point) return cut;
    at = best;
    return clear;
  }

  // How many points from the start lie within `share` of the parent's radius of its middle line.
  int inside_parent(const std::vector<Vec2>& line, const BranchPoint& at, double share) const {
    const AnnotatedBranch& b = annotation_.branches[at.branch];
    int inside = 0;
    for (; inside + 2 < static_cast<int>(line.size()); ++inside) {
      const BranchPoint near = nearest_on(at.branch, line[inside]);
      if ((b.points[near.point] - line[inside]).norm() >= share * b.radii[near.point] + (share > 1.0 ? 1.0 : 0.0)) break;
    }
    return inside;
  }

  BranchPoint nearest_on(int branch, const Vec2& p) const {
    return {branch, nearest_point(annotation_.branches[branch].points, p)};
  }

  // A child's stretch beside its parent sees the parent's width and would teach a false taper (PICTURES 3): it gets the
  // radius the child has once it is clear.
  void clear_start(std::vector<double>& radii, const std::vector<Vec2>& line, const BranchPoint& parent) const {
    const int n = static_cast<int>(line.size());
    int clear = std::min(n - 1, inside_parent(line, parent, 1.5) + 2);
    clear = std::min(clear, (2 * n) / 3);
    for (int i = 0; i < clear; ++i) radii[i] = std::min(radii[clear], radius_at(parent));
  }

  // Tips on another branch close a loop or make a T.
  void link_tips() {
    std::set<std::pair<int, int>> linked;
    for (std::size_t b = 0; b < tips_.size(); ++b) {
      const BranchPoint tip{static_cast<int>(b), static_cast<int>(annotation_.branches[b].points.size()) - 1};
      for (const auto& [node, place] : at_node_) {
        if (node != tips_[b].node || place.branch == tip.branch || linked.count({place.branch, tip.branch})) continue;
        const auto& parent = annotation_.branches[place.branch].parent;
        if (parent && parent->branch == tip.branch && place.point < 3) continue;  // a child that starts at the tip
        annotation_.links.emplace_back(tip, place);
        linked.emplace(tip.branch, place.branch);
        break;
      }
    }
  }

  const StrokeNet& net_;
  const std::vector<bool>& on_frame_;
  std::vector<std::vector<std::optional<BranchPoint>>> point_of_;  // of the component's places, per stroke node
  std::vector<std::pair<int, BranchPoint>> at_node_;
  std::vector<Tip> tips_;  // one per branch
  Annotation annotation_;
};

}  // namespace

Annotation annotation_from_graph(const TraceGraph& graph, Size size, const TreeOptions& options) {
  const std::vector<int> roots = given_roots(graph, size, options);
  const std::vector<bool> on_frame = frame_nodes(graph, size, options);
  const StrokeNet net = stroke_net(graph, strokes_of(graph, roots), on_frame);
  const std::vector<int> component = components_of(graph);
  std::vector<std::vector<int>> members(graph.nodes.size());
  for (std::size_t n = 0; n < graph.nodes.size(); ++n) members[component[n]].push_back(static_cast<int>(n));
  std::vector<double> total(graph.nodes.size(), 0.0);
  for (const TraceEdge& e : graph.edges) total[component[e.from]] += line_length(e.line);
  std::vector<std::pair<double, int>> order;  // the component with most line first
  for (std::size_t c = 0; c < members.size(); ++c) {
    if (!members[c].empty() && total[c] > 0.0) order.emplace_back(-total[c], static_cast<int>(c));
  }
  std::sort(order.begin(), order.end());
  BranchBuilder builder(net, on_frame, size);
  for (const auto& [length, c] : order) builder.add(plan_component(net, members[c], roots, on_frame));
  return builder.take();
}

Annotation annotation_from_strokes(const std::vector<OwnStroke>& strokes, Size size, const TreeOptions& options) {
  // Every stroke is an edge with its own two nodes, and has a node where each of its children starts.
  TraceGraph graph;
  StrokeNet net;
  std::vector<StrokePlace> plan;
  std::vector<std::vector<int>> forks(strokes.size());  // indices into the line
  for (const OwnStroke& s : strokes) {
    if (s.parent != kNone) forks[s.parent].push_back(s.parent_at);
  }
  for (std::size_t i = 0; i < strokes.size(); ++i) {
    const OwnStroke& s = strokes[i];
    TraceStroke stroke;
    stroke.line = s.line;
    stroke.radii = s.radii;
    stroke.confidence = 1.0;
    stroke.at = forks[i];
    stroke.at.push_back(0);
    stroke.at.push_back(static_cast<int>(s.line.size()) - 1);
    std::sort(stroke.at.begin(), stroke.at.end());
    stroke.at.erase(std::unique(stroke.at.begin(), stroke.at.end()), stroke.at.end());
    for (const int at : stroke.at) {
      stroke.nodes.push_back(static_cast<int>(graph.nodes.size()));
      graph.nodes.push_back(s.line[at]);
    }
    graph.edges.push_back({stroke.nodes.front(), stroke.nodes.back(), s.line, s.radii});
    StrokePlace place;
    place.stroke = static_cast<int>(i);
    place.parent = s.parent;
    if (s.parent != kNone) {
      const std::vector<int>& at = net.strokes[s.parent].at;
      place.parent_node = static_cast<int>(std::lower_bound(at.begin(), at.end(), s.parent_at) - at.begin());
    }
    plan.push_back(place);
    net.strokes.push_back(std::move(stroke));
  }
  const std::vector<bool> on_frame = frame_nodes(graph, size, options);
  BranchBuilder builder(net, on_frame, size);
  builder.add(plan);
  return builder.take();
}

}  // namespace ramify
