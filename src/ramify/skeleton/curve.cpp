// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/skeleton/curve.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "ramify/geometry/polyline.h"
#include "ramify/skeleton/branches.h"

namespace ramify {
namespace {

bool near_frame(const Vec2& p, double margin, Size size) {
  return p.x() < margin || p.y() < margin || p.x() > size.width - 1 - margin || p.y() > size.height - 1 - margin;
}

// The branch's polyline, continued over a loop link that starts at its tip.
Polyline linked_polyline(const Skeleton& skeleton, const Branch& branch, bool& linked) {
  Polyline line = branch_polyline(skeleton, branch);
  const int tip = branch.nodes.back();
  for (const auto& [a, b] : skeleton.loop_links) {
    if (a != tip && b != tip) continue;
    line.points.push_back(skeleton[a == tip ? b : a].xy());
    line.radii.push_back(line.radii.back());
    linked = true;
    break;
  }
  return line;
}

// First vertex of the child that lies outside the parent's width around the furcation.
int vertex_at_rim(const BranchCurve& child, const BranchCurve& parent) {
  const int reach = static_cast<int>(3.0 * parent.radii[child.parent_vertex]) + 2;
  const int low = std::max(0, child.parent_vertex - reach);
  const int high = std::min(parent.count() - 1, child.parent_vertex + reach);
  for (int i = 0; i + 1 < child.count(); ++i) {
    bool outside = true;
    for (int k = low; k <= high && outside; ++k) outside = (child.points[i] - parent.points[k]).norm() > parent.radii[k];
    if (outside) return i;
  }
  return std::max(0, child.count() - 1);
}

// The nearest vertex of another curve, or of a far part of the same one, that lies ahead of the curve's end.
void join_end(std::vector<BranchCurve>& curves, std::size_t index, double reach) {
  BranchCurve& curve = curves[index];
  const int n = curve.count();
  if (!curve.tip || n < 12) return;
  const Vec2 end = curve.points.back(), ahead = (end - curve.points[n - 8]).normalized();
  const double radius = curve.radii.back();
  double best = std::numeric_limits<double>::infinity();
  Vec2 target = end;
  for (std::size_t c = 0; c < curves.size(); ++c) {
    for (int i = 0; i < curves[c].count(); ++i) {
      if (c == index && n - 1 - i < 40 + 6 * radius) break;
      const Vec2 way = curves[c].points[i] - end;
      const double distance = way.norm();
      if (distance > reach * radius + 6 + curves[c].radii[i]) continue;
      if (distance > 1.0 && way.dot(ahead) < 0.3 * distance) continue;
      if (distance - 0.5 * curves[c].radii[i] < best) {
        best = distance - 0.5 * curves[c].radii[i];
        target = curves[c].points[i];
      }
    }
  }
  if (!std::isfinite(best)) return;
  const int steps = static_cast<int>((target - end).norm());
  for (int i = 1; i <= steps; ++i) {
    curve.points.push_back(end + (target - end) * (static_cast<double>(i) / steps));
    curve.radii.push_back(radius);
  }
  curve.tip = false;
}

}  // namespace

std::vector<BranchCurve> branch_curves(const Skeleton& skeleton, const CurveOptions& options) {
  const BranchTree tree = branch_tree(skeleton);
  std::vector<BranchCurve> curves(tree.branches.size());
  std::vector<double> vertex_of_node(static_cast<std::size_t>(skeleton.count()), 0.0);
  for (std::size_t b = 0; b < curves.size(); ++b) {
    const Branch& branch = tree.branches[b];
    BranchCurve& curve = curves[b];
    bool linked = false;
    const Polyline line = linked_polyline(skeleton, branch, linked);
    const std::vector<double> arcs = arc_lengths(line.points);
    if (line.points.size() < 2 || arcs.back() <= 0.0) continue;
    const SampledPolyline dense = resample_arc(line.points, 1.0);
    curve.points = smooth_polyline(dense.points, options.smoothing);
    for (const double arc : dense.arcs) curve.radii.push_back(value_at_arc(line.radii, arcs, arc));
    curve.radii = smooth_values(curve.radii, dense.arcs, options.smoothing);
    const std::size_t first = branch.parent_node == kNone ? 0 : 1;
    for (std::size_t i = 0; i < branch.nodes.size(); ++i) {
      vertex_of_node[branch.nodes[i]] = arcs[i + first] / arcs.back() * (curve.count() - 1);
    }
    if (branch.parent != kNone && curves[branch.parent].count() > 0) {
      curve.parent = branch.parent;
      curve.parent_vertex = std::min(static_cast<int>(std::lround(vertex_of_node[branch.parent_node])),
                                     curves[branch.parent].count() - 1);
      curve.rim = vertex_at_rim(curve, curves[branch.parent]);
    }
    curve.tip = !linked && !near_frame(curve.points.back(), curve.radii.back() + 3.0, skeleton.size);
  }
  if (options.join_reach > 0.0) {
    for (std::size_t b = 0; b < curves.size(); ++b) join_end(curves, b, options.join_reach);
  }
  return curves;
}

Vec2 point_along(const BranchCurve& curve, double vertex) {
  const int last = curve.count() - 1;
  if (vertex < 0.0) {
    const Vec2 back = curve.points[0] - curve.points[std::min(last, 8)];
    return curve.points[0] - vertex * back.normalized();
  }
  if (vertex > last) {
    const Vec2 on = curve.points[last] - curve.points[std::max(0, last - 8)];
    return curve.points[last] + (vertex - last) * on.normalized();
  }
  const int i = std::min(static_cast<int>(vertex), std::max(0, last - 1));
  const double f = vertex - i;
  return last == 0 ? curve.points[0] : Vec2((1.0 - f) * curve.points[i] + f * curve.points[i + 1]);
}

double radius_along(const BranchCurve& curve, double vertex) {
  return curve.radii[std::clamp(static_cast<int>(std::lround(vertex)), 0, curve.count() - 1)];
}

Vec2 tangent_along(const BranchCurve& curve, double vertex) {
  return (point_along(curve, vertex + 3.0) - point_along(curve, vertex - 3.0)).normalized();
}

}  // namespace ramify
