// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/growth/figure_curves.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "ramify/geometry/bezier.h"
#include "ramify/geometry/polyline.h"

namespace ramify {
namespace {

constexpr double kSpacing = 1.5;  // px between points of a line

struct Contact {
  Vec2 at;      // px, between the two pixels
  Vec2 across;  // unit, from the parent's pixel to the child's
};

std::vector<Vec2> sampled(const CubicBezier& curve) {
  const double length = (curve[1] - curve[0]).norm() + (curve[2] - curve[1]).norm() + (curve[3] - curve[2]).norm();
  const int steps = std::max(1, static_cast<int>(std::ceil(length / kSpacing)));
  std::vector<Vec2> out;
  for (int i = 0; i <= steps; ++i) out.push_back(point_on(curve, static_cast<double>(i) / steps));
  return out;
}

// The members of the longest chain of contacts no more than 1.5 px apart.
std::vector<Contact> longest_run(const std::vector<Contact>& contacts) {
  std::vector<int> run(contacts.size(), kNone);
  std::vector<Contact> best;
  for (std::size_t seed = 0; seed < contacts.size(); ++seed) {
    if (run[seed] != kNone) continue;
    std::vector<std::size_t> open{seed};
    std::vector<Contact> members;
    run[seed] = static_cast<int>(seed);
    while (!open.empty()) {
      const std::size_t at = open.back();
      open.pop_back();
      members.push_back(contacts[at]);
      for (std::size_t k = 0; k < contacts.size(); ++k) {
        if (run[k] != kNone || (contacts[k].at - contacts[at].at).squaredNorm() > 1.5 * 1.5) continue;
        run[k] = static_cast<int>(seed);
        open.push_back(k);
      }
    }
    if (members.size() > best.size()) best = std::move(members);
  }
  return best;
}

Portal portal_of(const std::vector<Contact>& contacts) {
  const std::vector<Contact> run = longest_run(contacts);
  Vec2 mean = Vec2::Zero(), across = Vec2::Zero();
  for (const Contact& c : run) mean += c.at, across += c.across;
  mean /= static_cast<double>(run.size());
  Portal portal;
  double nearest = 1e300, xx = 0, xy = 0, yy = 0;
  for (const Contact& c : run) {
    const Vec2 d = c.at - mean;
    xx += d.x() * d.x(), xy += d.x() * d.y(), yy += d.y() * d.y();
    if (d.squaredNorm() < nearest) nearest = d.squaredNorm(), portal.middle = c.at;
  }
  // The border's direction by principal axes; across it, towards the child.
  if (run.size() >= 3) {
    const double axis = 0.5 * std::atan2(2 * xy, xx - yy);
    portal.inward = perpendicular(direction_of(axis));
  } else {
    portal.inward = across.norm() > 0 ? Vec2(across.normalized()) : run.front().across;
  }
  if (portal.inward.dot(across) < 0.0) portal.inward = -portal.inward;
  return portal;
}

}  // namespace

std::vector<Portal> find_portals(const LabelImage& label, const std::vector<Vec2>& sites, const std::vector<int>& parents) {
  std::vector<std::vector<Contact>> contacts(sites.size());
  const auto meet = [&](int x, int y, int dx, int dy) {
    const int a = label(x, y), b = label(x + dx, y + dy);
    if (a == b || a == kNone || b == kNone) return;
    const Vec2 at(x + 0.5 * dx, y + 0.5 * dy), step(dx, dy);
    if (parents[b] == a) contacts[b].push_back({at, step});
    if (parents[a] == b) contacts[a].push_back({at, -step});
  };
  for (int y = 0; y < label.height(); ++y) {
    for (int x = 0; x < label.width(); ++x) {
      if (x + 1 < label.width()) meet(x, y, 1, 0);
      if (y + 1 < label.height()) meet(x, y, 0, 1);
    }
  }
  std::vector<Portal> portals(sites.size());
  for (std::size_t i = 0; i < sites.size(); ++i) {
    if (parents[i] == kNone) {
      portals[i].middle = sites[i];
    } else {
      if (contacts[i].empty()) throw std::logic_error("find_portals: a cell does not touch its parent");
      portals[i] = portal_of(contacts[i]);
    }
  }
  return portals;
}

bool FigurePen::is_inside(const Vec2& p) const {
  const int x = static_cast<int>(std::lround(p.x())), y = static_cast<int>(std::lround(p.y()));
  return inside_.contains(x, y) && inside_(x, y);
}

bool FigurePen::is_inside(const std::vector<Vec2>& points) const {
  if (inside_.empty()) return true;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!is_inside(points[i]) || (i > 0 && !is_inside(0.5 * (points[i] + points[i - 1])))) return false;
  }
  return true;
}

std::vector<int> FigurePen::way_to_site(int cell, const Vec2& p) const {
  // A portal lies between two pixels: take the one in the cell.
  std::vector<int> way;
  int node = kNone;
  double nearest = 1e300;
  for (int y = static_cast<int>(std::floor(p.y())); y <= static_cast<int>(std::ceil(p.y())); ++y) {
    for (int x = static_cast<int>(std::floor(p.x())); x <= static_cast<int>(std::ceil(p.x())); ++x) {
      if (!inside_.contains(x, y) || cells_.label(x, y) != cell || (Vec2(x, y) - p).norm() >= nearest) continue;
      nearest = (Vec2(x, y) - p).norm();
      node = cells_.lattice.node(x, y);
    }
  }
  for (; node != kNone; node = path_parent(cells_.plan, cells_.lattice, node)) way.push_back(node);
  return way;
}

// Along the planned ways by way of a site, pulled tight: every point goes on to the farthest it can see.
std::vector<Vec2> FigurePen::way_inside(int cell, const Vec2& from, const Vec2& to) const {
  const std::vector<int> first = way_to_site(cell, from), second = way_to_site(cell, to);
  std::vector<Vec2> pixels{from};
  for (const int node : first) pixels.push_back(node_position(cells_.lattice, node).head<2>());
  for (auto node = second.rbegin(); node != second.rend(); ++node) pixels.push_back(node_position(cells_.lattice, *node).head<2>());
  pixels.push_back(to);
  std::vector<Vec2> tight{from};
  for (std::size_t at = 0; at + 1 < pixels.size();) {
    std::size_t next = at + 1;
    for (std::size_t k = pixels.size() - 1; k > at + 1; --k) {
      if (is_inside(sampled(straight_bezier(pixels[at], pixels[k])))) {
        next = k;
        break;
      }
    }
    at = next;
    tight.push_back(pixels[at]);
  }
  const SampledPolyline fine = resample_arc(tight, 1.0);
  for (const double sigma : {3.0, 1.5}) {
    const std::vector<Vec2> smooth = smooth_polyline(fine.points, sigma);
    if (is_inside(smooth)) return smooth;
  }
  return fine.points;
}

std::vector<Vec2> FigurePen::line(int cell, const Vec2& from, const Vec2& out, const Vec2& to, const Vec2& in) {
  const double length = (to - from).norm();
  if (length <= 0.0) return {from, to};
  const Vec2 chord = (to - from) / length;
  if (options_.lines == FigureLines::Curved) {
    for (const double handle : {options_.curl, 0.5 * options_.curl, 0.25 * options_.curl}) {
      const Vec2 a = out.isZero() ? chord : out, b = in.isZero() ? chord : in;
      const std::vector<Vec2> points = sampled({from, from + handle * length * a, to - handle * length * b, to});
      if (is_inside(points)) return points;
    }
    ++straightened_;
  }
  const std::vector<Vec2> straight = sampled(straight_bezier(from, to));
  return is_inside(straight) ? straight : way_inside(cell, from, to);
}

}  // namespace ramify
