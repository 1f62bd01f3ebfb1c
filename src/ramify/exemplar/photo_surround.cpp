// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/exemplar/photo_surround.h"

#include <algorithm>
#include <cmath>

#include "ramify/image/contour.h"
#include "ramify/image/filter.h"

namespace ramify {
namespace {

constexpr float kBlack = 0.09f;        // of full scale, largest channel, slightly smoothed
constexpr int kFewestCorners = 3;
constexpr double kLeastShare = 0.005;  // of the picture: a smaller surround does no harm
constexpr double kWhole = 0.98;        // of what is not surround lies in one piece
constexpr double kConvex = 0.96;       // area of the field over that of its convex hull
constexpr double kRim = 3.0;           // px of the field's rim that still fade into the black
constexpr int kSpacing = 8;            // px between points of the polygon

double cross(const Vec2& o, const Vec2& a, const Vec2& b) {
  return (a.x() - o.x()) * (b.y() - o.y()) - (a.y() - o.y()) * (b.x() - o.x());
}

double polygon_area(const std::vector<Vec2>& p) {
  double twice = 0.0;
  for (std::size_t i = 0; i < p.size(); ++i) twice += cross(Vec2::Zero(), p[i], p[(i + 1) % p.size()]);
  return 0.5 * std::abs(twice);
}

// Andrew's monotone chain.
std::vector<Vec2> convex_hull(std::vector<Vec2> points) {
  std::sort(points.begin(), points.end(), [](const Vec2& a, const Vec2& b) {
    return a.x() < b.x() || (a.x() == b.x() && a.y() < b.y());
  });
  std::vector<Vec2> hull;
  for (const bool upper : {false, true}) {
    const std::size_t first = hull.size();
    for (const Vec2& p : points) {
      while (hull.size() >= first + 2 && cross(hull[hull.size() - 2], hull.back(), p) <= 0.0) hull.pop_back();
      hull.push_back(p);
    }
    hull.pop_back();
    if (!upper) std::reverse(points.begin(), points.end());
  }
  return hull;
}

// Black areas that hold a corner of the picture; how many corners they hold.
Mask black_corners(const ColorImage& photo, int& corners) {
  const ColorImage smooth = gaussian_blur(photo, 1.5);
  Mask black(photo.size());
  for (std::size_t i = 0; i < black.pixels().size(); ++i) {
    const Rgb& c = smooth.pixels()[i];
    black.pixels()[i] = std::max({c.r, c.g, c.b}) < kBlack ? 255 : 0;
  }
  int count = 0;
  const LabelImage label = label_components(black, false, count);
  std::vector<bool> at_corner(static_cast<std::size_t>(count), false);
  corners = 0;
  const int right = photo.width() - 1, bottom = photo.height() - 1;
  for (const auto& [x, y] : {std::pair{0, 0}, {right, 0}, {0, bottom}, {right, bottom}}) {
    if (label(x, y) == kNone) continue;
    ++corners;
    at_corner[label(x, y)] = true;
  }
  for (std::size_t i = 0; i < black.pixels().size(); ++i) {
    const int k = label.pixels()[i];
    if (k == kNone || !at_corner[k]) black.pixels()[i] = 0;
  }
  return black;
}

}  // namespace

std::optional<Region> dark_surround(const ColorImage& photo) {
  int corners = 0;
  const Mask black = black_corners(photo, corners);
  if (corners < kFewestCorners) return std::nullopt;
  const Mask wide = dilate(black, kRim);
  // A margin of nothing around the picture closes the field's outline along the frame.
  ScalarImage field(photo.width() + 2, photo.height() + 2);
  double inside = 0.0;
  for (int y = 0; y < photo.height(); ++y) {
    for (int x = 0; x < photo.width(); ++x) {
      field(x + 1, y + 1) = wide(x, y) ? 0.0f : 1.0f;
      inside += !wide(x, y);
    }
  }
  if (static_cast<double>(photo.pixels().size()) - inside < kLeastShare * static_cast<double>(photo.pixels().size())) {
    return std::nullopt;
  }
  std::vector<Vec2> outline;
  double largest = 0.0;
  for (const Contour& contour : trace_contours(field, 0.5f)) {
    const double area = polygon_area(contour.points);
    if (area <= largest) continue;
    largest = area;
    outline = contour.points;
  }
  if (outline.size() < 3 || largest < kWhole * inside || largest < kConvex * polygon_area(convex_hull(outline))) return std::nullopt;
  Region region{RegionRole::Outside, {}};
  const double right = photo.width() - 0.5, bottom = photo.height() - 0.5;
  region.polygon = {{-0.5, -0.5}, {right, -0.5}, {right, bottom}, {-0.5, bottom}, {-0.5, -0.5}};
  for (std::size_t i = 0; i < outline.size(); i += kSpacing) region.polygon.push_back(outline[i] - Vec2(1, 1));
  region.polygon.push_back(outline.front() - Vec2(1, 1));
  return region;
}

}  // namespace ramify
