// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/paint/leaf.h"

#include <algorithm>
#include <cmath>

#include "ramify/paint/palette.h"

namespace ramify {
namespace {

constexpr double kVeinedSize = 13.0;  // px; on smaller leaves veins would be a grey veil
const Vec2 kLight(-0.55, -0.83);      // unit; light comes from the upper left

// Half a leaf from its base (0,0) to its tip (1,0) along y > 0, in lengths of the blade.
struct Template {
  std::vector<CubicBezier> half;
  std::vector<double> veins;  // where side veins leave the midrib
  double vein_slant = 0.8;    // rad from the midrib
};

CubicBezier curve(double x0, double y0, double x1, double y1, double x2, double y2, double x3, double y3) {
  return {Vec2(x0, y0), Vec2(x1, y1), Vec2(x2, y2), Vec2(x3, y3)};
}

Template leaf_template(LeafShape shape) {
  switch (shape) {
    case LeafShape::Ovate:
      return {{curve(0, 0, 0.02, 0.17, 0.2, 0.27, 0.4, 0.265), curve(0.4, 0.265, 0.66, 0.26, 0.8, 0.07, 1, 0)}, {0.16, 0.34, 0.52, 0.68}, 0.85};
    case LeafShape::Lance:
      return {{curve(0, 0, 0.1, 0.1, 0.28, 0.135, 0.44, 0.13), curve(0.44, 0.13, 0.68, 0.12, 0.86, 0.04, 1, 0)}, {0.18, 0.36, 0.54}, 0.55};
    case LeafShape::Heart:
      return {{curve(0, 0, -0.06, 0.1, -0.15, 0.3, 0.05, 0.4), curve(0.05, 0.4, 0.32, 0.52, 0.6, 0.2, 1, 0)}, {0.04, 0.24, 0.46}, 0.95};
    case LeafShape::Ivy:
      return {{curve(0, 0, -0.1, 0.06, -0.22, 0.2, -0.17, 0.36), curve(-0.17, 0.36, -0.02, 0.34, 0.08, 0.31, 0.15, 0.3),
               curve(0.15, 0.3, 0.22, 0.4, 0.34, 0.5, 0.47, 0.54), curve(0.47, 0.54, 0.5, 0.4, 0.5, 0.28, 0.54, 0.2),
               curve(0.54, 0.2, 0.7, 0.16, 0.86, 0.08, 1, 0)}, {0.02, 0.12, 0.46}, 0.95};
    case LeafShape::Oak:
      return {{curve(0, 0, 0.06, 0.03, 0.1, 0.05, 0.14, 0.06), curve(0.14, 0.06, 0.18, 0.2, 0.3, 0.2, 0.33, 0.1),
               curve(0.33, 0.1, 0.38, 0.28, 0.54, 0.3, 0.57, 0.13), curve(0.57, 0.13, 0.62, 0.3, 0.78, 0.28, 0.8, 0.12),
               curve(0.8, 0.12, 0.86, 0.2, 0.99, 0.14, 1, 0)}, {0.13, 0.36, 0.58, 0.78}, 0.9};
    case LeafShape::Round:
      return {{curve(0, 0, 0.02, 0.24, 0.2, 0.42, 0.5, 0.42), curve(0.5, 0.42, 0.8, 0.42, 0.97, 0.22, 1, 0)}, {0.14, 0.36, 0.58}, 0.9};
  }
  return {};
}

// Leaf coordinates to the canvas: the midrib is an arc of a circle.
class Placer {
 public:
  explicit Placer(const LeafPose& pose) : pose_(pose) {}
  Vec2 operator()(const Vec2& p) const {
    const double turn = pose_.bend * p.x();
    const Vec2 rib = std::abs(pose_.bend) < 1e-4 ? Vec2(p.x(), 0.0) : Vec2(std::sin(turn), 1.0 - std::cos(turn)) / pose_.bend;
    const Vec2 local = rib + pose_.breadth * p.y() * Vec2(-std::sin(turn), std::cos(turn));
    const Vec2 x = direction_of(pose_.angle - 0.5 * pose_.bend);
    return pose_.base + pose_.size * (local.x() * x + local.y() * perpendicular(x));
  }
  CubicBezier operator()(const CubicBezier& c) const { return {(*this)(c[0]), (*this)(c[1]), (*this)(c[2]), (*this)(c[3])}; }

 private:
  LeafPose pose_;
};

CubicBezier mirrored(const CubicBezier& c) {
  const auto flip = [](const Vec2& p) { return Vec2(p.x(), -p.y()); };
  return {flip(c[0]), flip(c[1]), flip(c[2]), flip(c[3])};
}

CubicBezier reversed(const CubicBezier& c) { return {c[3], c[2], c[1], c[0]}; }

std::vector<CubicBezier> whole_blade(const Template& leaf, const Placer& place) {
  std::vector<CubicBezier> loop;
  for (const CubicBezier& c : leaf.half) loop.push_back(place(c));
  for (auto c = leaf.half.rbegin(); c != leaf.half.rend(); ++c) loop.push_back(place(reversed(mirrored(*c))));
  return loop;
}

std::vector<CubicBezier> half_blade(const Template& leaf, const Placer& place, bool mirror) {
  std::vector<CubicBezier> loop;
  for (const CubicBezier& c : leaf.half) loop.push_back(place(mirror ? mirrored(c) : c));
  loop.push_back(place(straight_bezier({1, 0}, {0, 0})));
  return loop;
}

// A wedge that narrows to a point, in leaf coordinates.
std::vector<CubicBezier> vein(const Vec2& from, const Vec2& to, double wide, const Placer& place) {
  const Vec2 side = 0.5 * wide * perpendicular(Vec2((to - from).normalized()));
  return {place(straight_bezier(from + side, to)), place(straight_bezier(to, from - side)), place(straight_bezier(from - side, from + side))};
}

// How far along a ray from the midrib the blade reaches, in blade lengths.
double blade_reach(const Template& leaf, const Vec2& from, const Vec2& way) {
  double best = 0.0;
  for (const CubicBezier& c : leaf.half) {
    for (int i = 0; i < 16; ++i) {
      const Vec2 a = point_on(c, i / 16.0) - from, b = point_on(c, (i + 1) / 16.0) - from;
      const double ca = cross(way, a), cb = cross(way, b);
      if ((ca < 0.0) == (cb < 0.0) || ca == cb) continue;
      const double t = (a + (ca / (ca - cb)) * (b - a)).dot(way);
      if (t > 0.02 && (best == 0.0 || t < best)) best = t;
    }
  }
  return best;
}

Shape vein_shape(const Template& leaf, const LeafPose& pose, const Placer& place, const Rgb& color) {
  Shape out;
  out.color = color;
  const double wide = std::max(0.022, 0.55 / pose.size);
  out.loops.push_back(vein({-0.02, 0}, {0.96, 0}, 1.5 * wide, place));
  for (const double at : leaf.veins) {
    const Vec2 way = direction_of(leaf.vein_slant);
    const double reach = 0.82 * blade_reach(leaf, {at, 0}, way);
    if (reach <= 0.05) continue;
    for (const double side : {1.0, -1.0}) {
      out.loops.push_back(vein({at, 0}, Vec2(at, 0) + reach * Vec2(way.x(), side * way.y()), 0.8 * wide, place));
    }
  }
  return out;
}

}  // namespace

std::vector<Shape> leaf_shapes(LeafShape shape, const LeafPose& pose, const LeafColors& colors) {
  const Template leaf = leaf_template(shape);
  const Placer place(pose);
  LeafPose larger = pose;
  const double rim = std::clamp(0.035 * pose.size, 0.25, 0.9);  // px
  larger.size += 2.0 * rim;
  larger.base -= rim * direction_of(pose.angle);
  std::vector<Shape> out;
  out.push_back({{whole_blade(leaf, Placer(larger))}, colors.edge, 1.0});
  out.push_back({{whole_blade(leaf, place)}, colors.blade, 1.0});
  const bool mirror = kLight.dot(perpendicular(direction_of(pose.angle))) > 0.0;  // the half away from the light
  out.push_back({{half_blade(leaf, place, mirror)}, colors.shade, 1.0});
  if (pose.size >= kVeinedSize) out.push_back(vein_shape(leaf, pose, place, colors.vein));
  return out;
}

Shape disc_shape(const Vec2& centre, double radius, const Rgb& color) {
  constexpr double kHandle = 0.5522847498;  // four curves make a circle to 0.03 %
  std::vector<CubicBezier> loop;
  for (int q = 0; q < 4; ++q) {
    const Vec2 a = direction_of(q * kPi / 2), b = perpendicular(a);
    loop.push_back({centre + radius * a, centre + radius * (a + kHandle * b), centre + radius * (b + kHandle * a), centre + radius * b});
  }
  return {{loop}, color, 1.0};
}

std::vector<Shape> flower_shapes(const Vec2& centre, double radius, double angle, const Rgb& petal, const Rgb& heart) {
  std::vector<Shape> out;
  const Rgb rim = mix(petal, {0.25f, 0.05f, 0.12f}, 0.35), deep = mix(petal, heart, 0.35);
  const auto add_petals = [&](double length, double wide, const Rgb& color) {
    for (int k = 0; k < 5; ++k) {
      const Vec2 x = direction_of(angle + k * 2 * kPi / 5), y = perpendicular(x);
      const auto at = [&](double u, double v) { return Vec2(centre + length * u * x + wide * v * y); };
      // Broad petals with a small notch at the end.
      out.push_back({{{{at(0, 0), at(0.25, 0.75), at(0.62, 1.05), at(0.94, 0.42)}, {at(0.94, 0.42), at(1.03, 0.24), at(0.99, 0.08), at(0.92, 0)},
                       {at(0.92, 0), at(0.99, -0.08), at(1.03, -0.24), at(0.94, -0.42)}, {at(0.94, -0.42), at(0.62, -1.05), at(0.25, -0.75), at(0, 0)}}},
                     color, 1.0});
    }
  };
  const double thin = std::clamp(0.05 * radius, 0.25, 0.8);
  add_petals(radius + thin, 0.52 * radius + thin, rim);
  add_petals(radius, 0.52 * radius, petal);
  add_petals(0.5 * radius, 0.2 * radius, deep);
  out.push_back(disc_shape(centre, 0.2 * radius, heart));
  return out;
}

}  // namespace ramify
