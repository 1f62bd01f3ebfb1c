// SPDX-License-Identifier: GPL-3.0-or-later
// The envelope of discs of changing radius along a curve, as one polygon.
#include <algorithm>
#include <cmath>

#include "ramify/geometry/polyline.h"
#include "ramify/paint/stroke.h"

namespace ramify {
namespace {

constexpr double kArcStep = kPi / 10;  // rad between points of a round end

// Points of a circle from one angle to another, the first and last included, turning in the direction of the sign.
void append_arc(const Vec2& centre, double radius, double from, double sweep, std::vector<Vec2>& out) {
  const int steps = std::max(2, static_cast<int>(std::ceil(std::abs(sweep) / kArcStep)));
  for (int i = 0; i <= steps; ++i) out.push_back(centre + radius * direction_of(from + sweep * i / steps));
}

// Unit vectors from every disc's centre to where the envelope touches it, on the left (-1) or right (+1) side.
std::vector<Vec2> contacts(const std::vector<Vec2>& along, const std::vector<double>& slopes, int side) {
  std::vector<Vec2> out(along.size());
  for (std::size_t i = 0; i < along.size(); ++i) {
    const double s = std::clamp(slopes[i], -0.95, 0.95);
    out[i] = -s * along[i] + side * std::sqrt(1.0 - s * s) * perpendicular(along[i]);
  }
  return out;
}

// Points of one side, without those that another disc of the stroke nearby covers: the swallowtails on the inside of bends.
void append_side(const std::vector<Vec2>& points, const std::vector<double>& radii, const std::vector<double>& arcs,
                 const std::vector<Vec2>& contact, std::vector<Vec2>& out) {
  const int n = static_cast<int>(points.size());
  for (int i = 0; i < n; ++i) {
    const Vec2 p = points[i] + radii[i] * contact[i];
    const double reach = 4.0 * radii[i];
    bool covered = false;
    for (const int step : {-1, 1}) {
      for (int k = i + step; k >= 0 && k < n && !covered && std::abs(arcs[k] - arcs[i]) < reach; k += step) {
        covered = (p - points[k]).norm() < radii[k] - 0.01 - 0.02 * radii[k];
      }
    }
    if (!covered) out.push_back(p);
  }
}

std::vector<Vec2> disc(const Vec2& centre, double radius) {
  std::vector<Vec2> out;
  append_arc(centre, radius, 0.0, 2.0 * kPi, out);
  out.pop_back();
  return out;
}

}  // namespace

std::vector<Vec2> stroke_outline(const Stroke& stroke, double grow) {
  if (stroke.points.empty()) return {};
  std::vector<double> radii = stroke.radii;
  for (double& radius : radii) radius = std::max(0.0, radius + grow);
  const std::vector<double> arcs = arc_lengths(stroke.points);
  const std::size_t n = stroke.points.size();
  if (n < 2 || arcs.back() <= 0.0) return disc(stroke.points.front(), radii.front());
  const std::vector<Vec2> along = tangents(stroke.points);
  std::vector<double> slopes(n, 0.0);
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t a = i > 0 ? i - 1 : 0, b = std::min(n - 1, i + 1);
    if (arcs[b] > arcs[a]) slopes[i] = (radii[b] - radii[a]) / (arcs[b] - arcs[a]);
  }
  const std::vector<Vec2> left = contacts(along, slopes, -1), right = contacts(along, slopes, 1);
  std::vector<Vec2> out;
  append_side(stroke.points, radii, arcs, left, out);
  const auto cap = [&](std::size_t i, const Vec2& from, const Vec2& to) {  // over the end, clockwise on the screen
    double sweep = angle_of(to) - angle_of(from);
    if (sweep <= 0.0) sweep += 2.0 * kPi;
    append_arc(stroke.points[i], radii[i], angle_of(from), sweep, out);
  };
  cap(n - 1, left[n - 1], right[n - 1]);
  std::vector<Vec2> back;
  append_side(stroke.points, radii, arcs, right, back);
  out.insert(out.end(), back.rbegin(), back.rend());
  cap(0, right[0], left[0]);
  return out;
}

}  // namespace ramify
