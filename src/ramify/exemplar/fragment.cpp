// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/exemplar/fragment.h"

#include <algorithm>
#include <cmath>

namespace ramify {
namespace {

constexpr int kHalfSamples = 5;   // 2 * 5 + 1 along the branch
constexpr int kChildSamples = 6;
constexpr double kMostSurround = 40.0;  // px, so that wide branches' discs stay usable (PICTURES 4)

void add_sample(Fragment& f, const BranchCurve& curve, double vertex) {
  const Vec2 normal = perpendicular(tangent_along(curve, vertex));
  f.shape.push_back({point_along(curve, vertex) - f.centre, normal, radius_along(curve, vertex)});
}

// Samples from `low` to `high` with the centre sample on `middle`.
void add_run(Fragment& f, const BranchCurve& curve, double low, double middle, double high) {
  for (int k = -kHalfSamples; k <= kHalfSamples; ++k) {
    const double side = k < 0 ? middle - low : high - middle;
    add_sample(f, curve, middle + side * k / kHalfSamples);
  }
}

// First and last vertex of the stretch around f.vertex that stays inside the disc.
void find_stretch(Fragment& f, const BranchCurve& curve) {
  f.first = f.last = f.vertex;
  while (f.first > 0 && (curve.points[f.first] - f.centre).norm() < f.radius) --f.first;
  while (f.last + 1 < curve.count() && (curve.points[f.last] - f.centre).norm() < f.radius) ++f.last;
}

int last_vertex_inside(const Fragment& f, const BranchCurve& curve, int from) {
  int last = from;
  while (last + 1 < curve.count() && (curve.points[last] - f.centre).norm() < f.radius) ++last;
  return last;
}

// How far beyond the end of the curve the disc still reaches.
double overhang(const Fragment& f, const Vec2& end) { return std::max(0.0, f.radius - (end - f.centre).norm()); }

// A child's width beyond the parent's bank, where it is its own (PICTURES 3).
double radius_outside(const BranchCurve& child, double parent_radius) {
  const int from = std::min(child.count() - 1, child.rim + static_cast<int>(std::max(3.0, 0.5 * parent_radius)));
  double sum = 0.0;
  int count = 0;
  for (int i = from; i < std::min(child.count(), from + 8); ++i, ++count) sum += child.radii[i];
  return sum / std::max(1, count);
}

// Centre on the bank; the bank line is sampled as 11 points, the child as 6.
std::optional<Fragment> side_fragment(const BranchCurve& parent, const BranchCurve& child, Fragment f, double child_radius) {
  f.kind = FragmentKind::Side;
  f.centre = child.points[child.rim];
  f.branch_radius = child_radius;
  const double parent_radius = parent.radii[child.parent_vertex];
  f.radius = std::clamp(4.0 * child_radius, 10.0, std::max(12.0, 1.5 * parent_radius)) + 4.0;
  for (int i = 0; i < parent.count(); ++i) {
    if ((parent.points[i] - f.centre).norm() < (parent.points[f.vertex] - f.centre).norm()) f.vertex = i;
  }
  const Vec2 across = perpendicular(tangent_along(parent, f.vertex));
  const double side = across.dot(f.centre - parent.points[f.vertex]) > 0.0 ? 1.0 : -1.0;
  for (int k = -kHalfSamples; k <= kHalfSamples; ++k) {
    const double vertex = f.vertex + k * f.radius / kHalfSamples;
    const Vec2 normal = perpendicular(tangent_along(parent, vertex));
    f.shape.push_back({point_along(parent, vertex) + side * radius_along(parent, vertex) * normal - f.centre, normal, 0.0});
  }
  f.child_last = last_vertex_inside(f, child, child.rim);
  if (f.child_last - child.rim < 4) return std::nullopt;
  for (int k = 1; k <= kChildSamples; ++k) {
    add_sample(f, child, child.rim + (f.child_last - child.rim) * k / static_cast<double>(kChildSamples));
  }
  return f;
}

double paper_disc_radius(double branch_radius, const FragmentOptions& options) {
  const double upper = options.canvas_side > 0.0 ? std::max(8.0, 0.2 * options.canvas_side) : 1e9;
  return std::clamp(options.radius_factor * branch_radius, 8.0, upper);
}

}  // namespace

double disc_radius(double branch_radius, const FragmentOptions& options) {
  if (options.paper_spacing) return paper_disc_radius(branch_radius, options);
  return branch_radius + std::clamp((options.radius_factor - 1.0) * branch_radius, options.least_surround, kMostSurround);
}

Fragment along_fragment(const std::vector<BranchCurve>& curves, int index, int vertex, const FragmentOptions& options) {
  const BranchCurve& curve = curves[index];
  Fragment f;
  f.curve = index;
  f.vertex = vertex;
  f.centre = curve.points[vertex];
  f.branch_radius = curve.radii[vertex];
  f.radius = disc_radius(f.branch_radius, options);
  find_stretch(f, curve);
  const double before = f.first == 0 ? overhang(f, curve.points.front()) : 0.0;
  double after = f.last + 1 == curve.count() ? overhang(f, curve.points.back()) : 0.0;
  if (after > 0.0 && curve.tip) {
    f.tip = true;
    after = 0.0;  // the shape ends where the branch does
  }
  add_run(f, curve, f.first - before, vertex, f.last + after);
  return f;
}

std::optional<Fragment> furcation_fragment(const std::vector<BranchCurve>& curves, int index,
                                           const FragmentOptions& options) {
  const BranchCurve& child = curves[index];
  if (child.parent == kNone || child.rim + 3 >= child.count()) return std::nullopt;
  const BranchCurve& parent = curves[child.parent];
  Fragment f;
  f.curve = child.parent;
  f.child = index;
  f.vertex = child.parent_vertex;
  const double parent_radius = parent.radii[f.vertex], child_radius = radius_outside(child, parent_radius);
  const bool wide_parent = options.wide_radius > 0.0 && parent_radius >= options.wide_radius;
  if ((child_radius < options.side_ratio * std::max(0.5, parent_radius) && parent_radius > 5.0) || wide_parent) {
    return side_fragment(parent, child, f, child_radius);
  }
  f.kind = FragmentKind::Junction;
  f.centre = parent.points[f.vertex];
  f.branch_radius = parent_radius;
  f.radius = disc_radius(parent_radius, options);
  find_stretch(f, parent);
  const double before = f.first == 0 ? overhang(f, parent.points.front()) : 0.0;
  const double after = f.last + 1 == parent.count() ? overhang(f, parent.points.back()) : 0.0;
  add_run(f, parent, f.first - before, f.vertex, f.last + after);
  f.child_last = last_vertex_inside(f, child, child.rim);
  if (f.child_last - child.rim < 3) return std::nullopt;
  for (int k = 0; k < kChildSamples; ++k) {
    add_sample(f, child, child.rim + (f.child_last - child.rim) * k / static_cast<double>(kChildSamples - 1));
  }
  return f;
}

}  // namespace ramify
