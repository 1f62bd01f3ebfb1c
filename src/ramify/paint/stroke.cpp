// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/paint/stroke.h"

#include <algorithm>
#include <cmath>

#include "ramify/geometry/polyline.h"
#include "ramify/skeleton/branches.h"
#include "ramify/skeleton/curve.h"

namespace ramify {
namespace {

constexpr double kBrush = 0.9;       // radii of smoothing along a wide stroke
constexpr double kFlare = 0.45;      // how much wider than itself a side branch is at its parent's rim
constexpr double kFlareReach = 1.1;  // parent radii over which it narrows to itself

double smoothstep(double t) {
  t = std::clamp(t, 0.0, 1.0);
  return t * t * (3.0 - 2.0 * t);
}

// A wide brush cannot follow wiggles much shorter than itself: more smoothing where the branch is thick. Between the two
// smoothed lines by width, so that a long branch keeps its lively thin end.
std::vector<Vec2> smoothed_by_width(const BranchCurve& curve, const StrokeOptions& options) {
  const double widest = *std::max_element(curve.radii.begin(), curve.radii.end());
  const double sigma = options.smoothing > 0.0 ? kBrush * widest : 0.0;
  if (sigma <= options.smoothing) return curve.points;
  const std::vector<Vec2> smooth = smooth_polyline(curve.points, sigma);
  std::vector<Vec2> out = curve.points;
  for (std::size_t i = 0; i < out.size(); ++i) out[i] += std::min(1.0, curve.radii[i] / widest) * (smooth[i] - out[i]);
  return out;
}

// Resets the first points so that the stroke starts on its parent, a little towards the root, in the parent's direction.
void launch_from_parent(Stroke& child, const Stroke& parent, const StrokeOptions& options) {
  const int n = static_cast<int>(child.points.size());
  const double wide = parent.radii[child.parent_vertex];
  const int reach = std::min(n - 1, static_cast<int>(std::lround(1.0 + options.flow * 2.6 * wide)));
  const std::vector<Vec2> along = tangents(parent.points);
  const Vec2 trunk = along[child.parent_vertex];
  const Vec2 way = child.points[std::min(n - 1, reach + 2)] - child.points.front();
  const double cosine = way.norm() > 0.0 ? way.normalized().dot(trunk) : 0.0;
  // A branch that turns back leaves at a right angle to nothing: it starts where the skeleton says.
  const double upstream = options.flow * wide * std::clamp(0.3 + cosine, 0.0, 1.0);
  const int vertex = std::max(0, child.parent_vertex - static_cast<int>(std::lround(upstream)));
  const Vec2 from = parent.points[vertex], to = child.points[reach];
  const std::vector<Vec2> own = tangents(child.points);
  const double chord = (to - from).norm();
  if (reach < 1 || chord <= 0.0) {
    child.points.front() = from;
    return;
  }
  const double pull = options.flow * std::clamp(0.35 + 0.65 * cosine, 0.0, 1.0);
  const Vec2 start = (pull * along[vertex] + (1.0 - pull) * (to - from) / chord) * chord;
  const Vec2 end = own[reach] * chord;
  std::vector<Vec2> launched;
  const int steps = std::max(2, static_cast<int>(std::lround(chord * 1.1)));
  for (int i = 0; i < steps; ++i) {  // cubic Hermite
    const double t = static_cast<double>(i) / steps, t2 = t * t, t3 = t2 * t;
    launched.push_back((2 * t3 - 3 * t2 + 1) * from + (t3 - 2 * t2 + t) * start + (3 * t2 - 2 * t3) * to + (t3 - t2) * end);
  }
  std::vector<double> radii(static_cast<std::size_t>(steps), child.radii[reach]);
  for (int i = 0; i < steps; ++i) radii[i] = child.radii[static_cast<std::size_t>(std::lround(static_cast<double>(i) * reach / steps))];
  child.points.erase(child.points.begin(), child.points.begin() + reach);
  child.radii.erase(child.radii.begin(), child.radii.begin() + reach);
  child.points.insert(child.points.begin(), launched.begin(), launched.end());
  child.radii.insert(child.radii.begin(), radii.begin(), radii.end());
  child.parent_vertex = vertex;
}

// Distance from the parent's surface near the furcation, negative inside.
double outside_parent(const Vec2& p, const Stroke& parent, int around, int reach) {
  double least = 1e300;
  const int low = std::max(0, around - reach), high = std::min(static_cast<int>(parent.points.size()) - 1, around + reach);
  for (int k = low; k <= high; ++k) least = std::min(least, (p - parent.points[k]).norm() - parent.radii[k]);
  return least;
}

// Inside the parent the child's discs stay inside it; at the rim they are a little wider than the child and narrow from
// there, so that outlines meet in a web instead of a notch.
void widen_into_parent(Stroke& child, const Stroke& parent, double flow) {
  const double wide = parent.radii[child.parent_vertex];
  const int reach = static_cast<int>(4.0 * wide) + 6;
  const int n = static_cast<int>(child.points.size());
  child.rim = n - 1;
  for (int i = 0; i < n; ++i) {
    if (outside_parent(child.points[i], parent, child.parent_vertex, reach) > 0.0) {
      child.rim = i;
      break;
    }
  }
  const std::vector<double> arcs = arc_lengths(child.points);
  const double room = std::max(0.0, 0.92 * wide - child.radii[child.rim]);
  for (int i = 0; i < n; ++i) {
    const double beyond = (arcs[i] - arcs[child.rim]) / (kFlareReach * wide + 1e-9);
    if (beyond > 6.0) break;
    const double flare = std::min(room, kFlare * std::min(1.0, flow / 0.6) * child.radii[i]) * std::exp(-std::max(0.0, beyond) * 1.6);
    child.radii[i] += flare;
    if (i > child.rim) continue;
    const double inside = -outside_parent(child.points[i], parent, child.parent_vertex, reach);
    child.radii[i] = std::min(child.radii[i], std::max(inside, 0.0) + child.radii[child.rim] * (i == child.rim ? 1.0 : 0.6) + 0.1);
    child.radii[i] = std::min(child.radii[i], std::max(wide, 0.2));
  }
}

// The last vertex of every branch that bears a side branch nearly as wide as itself: up to there it must not get thin.
std::vector<int> bearing_vertices(const std::vector<BranchCurve>& curves) {
  constexpr double kNearly = 0.6;
  std::vector<int> last(curves.size(), 0);
  for (const BranchCurve& side : curves) {
    if (side.parent == kNone || side.count() < 2) continue;
    const BranchCurve& parent = curves[static_cast<std::size_t>(side.parent)];
    if (side.radii[1] < kNearly * parent.radii[static_cast<std::size_t>(side.parent_vertex)]) continue;
    int& vertex = last[static_cast<std::size_t>(side.parent)];
    vertex = std::max(vertex, side.parent_vertex);
  }
  return last;
}

// from: the first vertex that may get thinner.
void taper_tip(Stroke& stroke, double taper, int from) {
  if (!stroke.tip || taper <= 0.0) return;
  const std::vector<double> arcs = arc_lengths(stroke.points);
  const double length = arcs.back() - arcs[static_cast<std::size_t>(stroke.rim)];
  const double widest = stroke.radii[static_cast<std::size_t>(stroke.rim)];
  const double reach =
      taper * std::min({0.8 * length, 30.0 * widest, arcs.back() - arcs[static_cast<std::size_t>(from)]});
  if (reach <= 0.0) return;
  for (std::size_t i = 0; i < arcs.size(); ++i) {
    const double t = std::clamp((arcs.back() - arcs[i]) / reach, 0.0, 1.0);
    const double fine = std::pow(t, 0.75);
    stroke.radii[i] = std::max(std::min(0.28, stroke.radii[i]), stroke.radii[i] * ((1.0 - taper) * std::max(fine, 0.35) + taper * fine));
  }
}

}  // namespace

std::vector<Stroke> make_strokes(const Skeleton& skeleton, const StrokeOptions& options) {
  const BranchTree tree = branch_tree(skeleton);
  const std::vector<BranchCurve> curves = branch_curves(skeleton, {options.smoothing, 0.0});
  const std::vector<int> bearing = bearing_vertices(curves);
  std::vector<Stroke> strokes(curves.size());
  for (std::size_t b = 0; b < curves.size(); ++b) {
    const BranchCurve& curve = curves[b];
    Stroke& stroke = strokes[b];
    stroke.order = tree.branches[b].order;
    if (curve.count() < 2) {  // a node alone: a dot
      const Node& node = skeleton[tree.branches[b].nodes.front()];
      stroke.points = {node.xy()};
      stroke.radii = {std::max(options.thinnest, options.width * node.radius)};
      stroke.births = {0.0};
      continue;
    }
    stroke.points = smoothed_by_width(curve, options);
    stroke.radii = smooth_values(curve.radii, arc_lengths(stroke.points), 3.0 * options.smoothing);
    for (double& radius : stroke.radii) radius = std::max(options.thinnest, options.width * radius);
    stroke.tip = curve.tip;
    double born = 0.0;
    if (curve.parent != kNone) {
      const Stroke& parent = strokes[static_cast<std::size_t>(curve.parent)];
      stroke.parent = curve.parent;
      // The parent's own start may have moved, which shifts its vertices.
      const int shift = static_cast<int>(parent.points.size()) - curves[static_cast<std::size_t>(curve.parent)].count();
      stroke.parent_vertex = std::clamp(curve.parent_vertex + shift, 0, static_cast<int>(parent.points.size()) - 1);
      launch_from_parent(stroke, parent, options);
      widen_into_parent(stroke, parent, options.flow);
      born = parent.births[static_cast<std::size_t>(stroke.parent_vertex)];
    }
    const int last = static_cast<int>(stroke.points.size()) - 1,
              moved = last + 1 - curve.count();  // its own start may have moved
    taper_tip(stroke, options.taper, std::clamp(bearing[b] + moved, 0, last));
    stroke.births = arc_lengths(stroke.points);
    for (double& birth : stroke.births) birth += born;
  }
  return strokes;
}

double growth_reach(const std::vector<Stroke>& strokes) {
  double reach = 0.0;
  for (const Stroke& stroke : strokes) reach = std::max(reach, stroke.births.back());
  return reach;
}

std::vector<Stroke> grown_strokes(const std::vector<Stroke>& strokes, double front, double ripening) {
  std::vector<Stroke> out = strokes;
  for (Stroke& stroke : out) {
    std::size_t count = 0;
    while (count < stroke.births.size() && stroke.births[count] <= front) ++count;
    if (count > 0 && count < stroke.points.size()) {  // the tip lies between two points
      const double part = (front - stroke.births[count - 1]) / (stroke.births[count] - stroke.births[count - 1]);
      stroke.points[count] = stroke.points[count - 1] + part * (stroke.points[count] - stroke.points[count - 1]);
      stroke.births[count] = front;
      ++count;
    }
    stroke.points.resize(count);
    stroke.radii.resize(count);
    stroke.births.resize(count);
    for (std::size_t i = 0; i < count; ++i) {
      const double ripe = ripening > 0.0 ? (front - stroke.births[i]) / ripening : 1.0;
      stroke.radii[i] = std::max(0.05, stroke.radii[i] * (0.08 + 0.92 * smoothstep(std::min(1.0, std::sqrt(std::max(0.0, ripe))))));
    }
  }
  return out;
}

}  // namespace ramify
