// SPDX-License-Identifier: GPL-3.0-or-later
// Where children come out of their parents (PICTURES 3).
#include <algorithm>
#include <cmath>

#include "ramify/geometry/polyline.h"
#include "ramify/skeleton/assemble.h"
#include "ramify/skeleton/capsules.h"
#include "ramify/skeleton/edit.h"

namespace ramify {
namespace {

constexpr double kSettled = 1.5;  // parent radii beyond the rim where a child's radius is its own (PICTURES 3)

// The parent's capsules near the junction; farther ones cannot be the reason why the child is still inside.
std::vector<BodyCapsule> parent_body(const Skeleton& skeleton, const Branch& parent, int node) {
  std::vector<BodyCapsule> body;
  const Polyline line = branch_polyline(skeleton, parent);
  const std::size_t lead = line.points.size() - parent.nodes.size();
  const auto at = static_cast<int>(std::lower_bound(parent.nodes.begin(), parent.nodes.end(), node) - parent.nodes.begin() + lead);
  const Vec2 centre = skeleton[node].xy();
  const double reach = 4.0 * skeleton[node].radius;
  const auto add = [&](int i) {
    body.push_back({line.points[i - 1], line.points[i], line.radii[i - 1], line.radii[i], kNone, 0.0, 0.0});
  };
  for (int i = at; i >= 1 && (line.points[i] - centre).norm() <= reach; --i) add(i);
  for (int i = at + 1; i < static_cast<int>(line.points.size()) && (line.points[i - 1] - centre).norm() <= reach; ++i) add(i);
  if (body.empty()) body.push_back({centre, centre, skeleton[node].radius, skeleton[node].radius, kNone, 0.0, 0.0});
  return body;
}

double distance_to(const std::vector<BodyCapsule>& body, const Vec2& p) {
  double best = 1e300;
  for (const BodyCapsule& capsule : body) best = std::min(best, capsule_hit(capsule, p).signed_distance);
  return best;
}

// Arc at which the line leaves the body for the first time and stays out to the next point; < 0 when it never does.
double rim_arc(const std::vector<BodyCapsule>& body, const Polyline& line, const std::vector<double>& arcs) {
  for (std::size_t i = 1; i < line.points.size(); ++i) {
    if (distance_to(body, line.points[i]) <= 0.0) continue;
    double inside = arcs[i - 1], outside = arcs[i];
    for (int k = 0; k < 40; ++k) {
      const double middle = 0.5 * (inside + outside);
      (distance_to(body, point_at_arc(line.points, arcs, middle)) > 0.0 ? outside : inside) = middle;
    }
    return outside;
  }
  return -1.0;
}

double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2), values.end());
  return values[values.size() / 2];
}

// Direction of the parent through a node, over about its own radius on both sides.
Vec2 direction_at(const Skeleton& skeleton, const Branch& parent, int node) {
  const auto at = static_cast<int>(std::lower_bound(parent.nodes.begin(), parent.nodes.end(), node) - parent.nodes.begin());
  const double reach = std::max(3.0, skeleton[node].radius);
  int from = at, to = at;
  const Vec2 centre = skeleton[node].xy();
  while (from > 0 && (skeleton[parent.nodes[from]].xy() - centre).norm() < reach) --from;
  while (to + 1 < static_cast<int>(parent.nodes.size()) && (skeleton[parent.nodes[to]].xy() - centre).norm() < reach) ++to;
  return skeleton[parent.nodes[to]].xy() - skeleton[parent.nodes[from]].xy();
}

}  // namespace

std::vector<ChildStart> measure_child_starts(const Skeleton& skeleton, const BranchTree& tree) {
  std::vector<ChildStart> starts;
  for (std::size_t b = 0; b < tree.branches.size(); ++b) {
    const Branch& child = tree.branches[b];
    if (child.parent == kNone) continue;
    const Branch& parent = tree.branches[child.parent];
    const double parent_radius = skeleton[child.parent_node].radius;
    const Polyline line = branch_polyline(skeleton, child);
    const std::vector<double> arcs = arc_lengths(line.points);
    ChildStart start;
    start.branch = static_cast<int>(b);
    const double rim = rim_arc(parent_body(skeleton, parent, child.parent_node), line, arcs);
    start.emerges = rim >= 0.0;
    start.rim_arc = start.emerges ? rim : arcs.back();
    std::vector<double> settled;
    for (std::size_t i = 1; i < arcs.size(); ++i) {
      if (arcs[i] >= start.rim_arc + kSettled * parent_radius) settled.push_back(line.radii[i]);
    }
    if (settled.empty()) settled.push_back(line.radii.back());
    settled.resize(std::min<std::size_t>(settled.size(), 16));  // the child's beginning, not its tip
    start.radius = median(settled);
    start.ratio = start.radius / parent_radius;
    const double stretch = std::max(8.0, 2.0 * parent_radius);
    const Vec2 from = start.emerges ? point_at_arc(line.points, arcs, rim) : line.points.front();
    const Vec2 out = point_at_arc(line.points, arcs, start.rim_arc + stretch) - from, along = direction_at(skeleton, parent, child.parent_node);
    start.side = cross(along, out) >= 0.0 ? 1 : -1;
    start.angle = std::abs(std::atan2(cross(along, out), along.dot(out)));
    starts.push_back(start);
  }
  return starts;
}

Skeleton cut_at_rim(const Skeleton& skeleton) {
  const BranchTree tree = branch_tree(skeleton);
  std::vector<bool> drop(static_cast<std::size_t>(skeleton.count()), false);
  std::vector<Node> nodes = skeleton.nodes();
  for (const ChildStart& start : measure_child_starts(skeleton, tree)) {
    const Branch& child = tree.branches[start.branch];
    const Polyline line = branch_polyline(skeleton, child);
    const std::vector<double> arcs = arc_lengths(line.points);  // node k of the child has arc k + 1
    std::size_t first = 0;
    while (first < child.nodes.size() && arcs[first + 1] <= start.rim_arc) drop[child.nodes[first++]] = true;
    if (!start.emerges) {
      drop[child.nodes.back()] = true;
      continue;
    }
    if (first > 0) {
      Node& rim = nodes[child.nodes[--first]];
      drop[child.nodes[first]] = false;
      rim.position.head<2>() = point_at_arc(line.points, arcs, start.rim_arc);
    }
    nodes[child.nodes[first]].parent = child.parent_node;
    const double settled = start.rim_arc + kSettled * skeleton[child.parent_node].radius;
    for (std::size_t k = first; k < child.nodes.size() && arcs[k + 1] < settled; ++k) {
      nodes[child.nodes[k]].radius = start.radius;
    }
  }
  Skeleton result(skeleton.size);
  result.dim = skeleton.dim;
  std::vector<int> index_of(nodes.size(), kNone);
  for (int i = 0; i < skeleton.count(); ++i) {
    if (drop[i]) continue;
    // The parent's node comes before the continuation and that before every child, so continuations stay what they are.
    int parent = nodes[i].parent;
    while (parent != kNone && drop[parent]) parent = tree.branches[tree.branch_of_node[parent]].parent_node;
    nodes[i].parent = parent == kNone ? kNone : index_of[parent];
    index_of[i] = result.append(nodes[i]);
  }
  for (const auto& [a, b] : skeleton.loop_links) {
    if (index_of[a] != kNone && index_of[b] != kNone) result.loop_links.emplace_back(index_of[a], index_of[b]);
  }
  count_orders(result);
  return result;
}

}  // namespace ramify
