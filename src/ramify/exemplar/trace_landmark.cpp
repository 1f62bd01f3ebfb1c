// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/exemplar/trace_landmark.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "ramify/exemplar/traced_line.h"

namespace ramify {
namespace {

constexpr double kSizes[] = {0.035, 0.045, 0.058, 0.075};  // radius over the picture's smaller side
constexpr double kGrid = 0.012;       // spacing of the places tried, over the smaller side
constexpr double kOdd = 5.0;          // times the usual deviation (median absolute) of spots of that size
constexpr double kThickShare = 0.65;  // of the traced length is thinner than branches that count
constexpr double kThickest = 0.9;     // the same for the thickest ones, two of which must come from it
constexpr double kOutward = 0.6;      // cosine between a branch and the way out
constexpr int kFewestBranches = 4;
constexpr int kFewestQuarters = 3;

// Sums over rectangles in constant time.
struct Sums {
  Size size;
  std::vector<double> r, g, b, n;

  double of(const std::vector<double>& s, int x0, int y0, int x1, int y1) const {
    const auto at = [&](int x, int y) { return s[static_cast<std::size_t>(y) * (size.width + 1) + x]; };
    x0 = std::clamp(x0, 0, size.width), x1 = std::clamp(x1, 0, size.width);
    y0 = std::clamp(y0, 0, size.height), y1 = std::clamp(y1, 0, size.height);
    return at(x1, y1) - at(x0, y1) - at(x1, y0) + at(x0, y0);
  }
};

Sums sums_beside(const ColorImage& photo, const Mask& hidden) {
  Sums s{photo.size(), {}, {}, {}, {}};
  const std::size_t stride = static_cast<std::size_t>(photo.width()) + 1;
  for (auto* v : {&s.r, &s.g, &s.b, &s.n}) v->assign(stride * (static_cast<std::size_t>(photo.height()) + 1), 0.0);
  for (int y = 0; y < photo.height(); ++y) {
    Rgb row;
    double count = 0.0;
    for (int x = 0; x < photo.width(); ++x) {
      if (!hidden(x, y)) {
        row = row + photo(x, y);
        count += 1.0;
      }
      const std::size_t here = (static_cast<std::size_t>(y) + 1) * stride + x + 1, above = here - stride;
      s.r[here] = s.r[above] + row.r;
      s.g[here] = s.g[above] + row.g;
      s.b[here] = s.b[above] + row.b;
      s.n[here] = s.n[above] + count;
    }
  }
  return s;
}

// Difference of mean colour between a disc, taken as rows of rectangles, and the ring around it; negative when either
// is mostly hidden.
double oddness(const Sums& s, const Vec2& centre, double radius) {
  std::array<double, 4> disc{}, whole{};
  const auto add = [&](std::array<double, 4>& to, double reach) {
    constexpr int kRows = 12;
    const int cx = static_cast<int>(centre.x()), cy = static_cast<int>(centre.y());
    for (int k = 0; k < kRows; ++k) {
      const double top = reach * (2.0 * k / kRows - 1.0), bottom = reach * (2.0 * (k + 1) / kRows - 1.0);
      const double middle = 0.5 * (top + bottom);
      const int half = static_cast<int>(std::sqrt(std::max(0.0, reach * reach - middle * middle)));
      const int y0 = cy + static_cast<int>(std::lround(top)), y1 = cy + static_cast<int>(std::lround(bottom));
      to[0] += s.of(s.r, cx - half, y0, cx + half + 1, y1);
      to[1] += s.of(s.g, cx - half, y0, cx + half + 1, y1);
      to[2] += s.of(s.b, cx - half, y0, cx + half + 1, y1);
      to[3] += s.of(s.n, cx - half, y0, cx + half + 1, y1);
    }
  };
  std::array<double, 4> inner{};
  add(disc, 0.9 * radius);
  add(inner, 1.15 * radius);
  add(whole, 1.6 * radius);
  const double ring = whole[3] - inner[3];
  if (disc[3] < 0.3 * kPi * radius * radius || ring < 0.4 * kPi * radius * radius) return -1.0;
  double square = 0.0;
  for (int c = 0; c < 3; ++c) square += std::pow(disc[c] / disc[3] - (whole[c] - inner[c]) / ring, 2);
  return std::sqrt(square);
}

double median_of(std::vector<double> v) {
  const auto middle = v.begin() + static_cast<std::ptrdiff_t>(v.size() / 2);
  std::nth_element(v.begin(), middle, v.end());
  return *middle;
}

Mask hidden_pixels(const ColorImage& photo, const TraceGraph& graph, const Mask& excluded) {
  Mask hidden = excluded.empty() ? Mask(photo.size()) : excluded;
  for (const TraceEdge& e : graph.edges) {
    for (std::size_t i = 0; i < e.line.size(); ++i) {
      const int reach = static_cast<int>(std::lround(std::min(e.radii[i], 20.0))) + 1;
      const int cx = static_cast<int>(std::lround(e.line[i].x())), cy = static_cast<int>(std::lround(e.line[i].y()));
      for (int y = cy - reach; y <= cy + reach; ++y) {
        for (int x = cx - reach; x <= cx + reach; ++x) {
          if (hidden.contains(x, y)) hidden(x, y) = 255;
        }
      }
    }
  }
  return hidden;
}

double radius_quantile(const TraceGraph& graph, double share) {
  std::vector<double> radii;
  for (const TraceEdge& e : graph.edges) radii.insert(radii.end(), e.radii.begin(), e.radii.end());
  const auto at = radii.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(radii.size() - 1));
  std::nth_element(radii.begin(), at, radii.end());
  return *at;
}

// Sum of the radii of thick branches that cross the circle outwards; 0 when they are too few or all on one side.
double convergence(const TraceGraph& graph, const Vec2& centre, double reach, double thick, double thickest) {
  int count = 0, mains = 0;
  std::array<bool, 4> quarter{};
  double sum = 0.0;
  for (const TraceEdge& e : graph.edges) {
    for (std::size_t i = 1; i < e.line.size(); ++i) {
      const double before = (e.line[i - 1] - centre).norm(), after = (e.line[i] - centre).norm();
      if ((before < reach) == (after < reach) || e.radii[i] < thick) continue;
      const Vec2 out = (e.line[i] - centre).normalized();
      if (std::abs(tangent_at(e.line, static_cast<int>(i), 8).dot(out)) < kOutward) continue;
      ++count;
      mains += e.radii[i] >= thickest;
      quarter[(out.x() > 0.0) + 2 * (out.y() > 0.0)] = true;
      sum += e.radii[i];
    }
  }
  return count >= kFewestBranches && mains >= 2 && std::count(quarter.begin(), quarter.end(), true) >= kFewestQuarters ? sum : 0.0;
}

}  // namespace

std::optional<Landmark> find_landmark(const ColorImage& photo, const TraceGraph& graph, const Mask& excluded,
                                      const Monitor& monitor) {
  if (graph.edges.empty()) return std::nullopt;
  const Sums sums = sums_beside(photo, hidden_pixels(photo, graph, excluded));
  const double thick = radius_quantile(graph, kThickShare), thickest = radius_quantile(graph, kThickest);
  const double side = std::min(photo.width(), photo.height());
  const double step = std::max(2.0, kGrid * side);
  std::optional<Landmark> best;
  double best_score = 0.0;
  for (const double share : kSizes) {
    const double radius = share * side;
    std::vector<std::pair<double, Vec2>> places;
    std::vector<double> usual;
    for (double y = radius; y < photo.height() - radius; y += step) {
      monitor.check();
      for (double x = radius; x < photo.width() - radius; x += step) {
        const double odd = oddness(sums, {x, y}, radius);
        if (odd < 0.0) continue;
        places.emplace_back(odd, Vec2(x, y));
        usual.push_back(odd);
      }
    }
    if (usual.size() < 30) continue;
    const double middle = median_of(usual);
    for (double& u : usual) u = std::abs(u - middle);
    const double spread = median_of(usual) + 1e-3;
    for (const auto& [odd, centre] : places) {
      if (odd < middle + kOdd * spread) continue;
      const double meeting = convergence(graph, centre, 1.3 * radius, thick, thickest);
      const double score = odd * meeting * meeting;
      if (score <= best_score) continue;
      best_score = score;
      best = Landmark{centre, radius};
    }
  }
  return best;
}

TraceGraph cut_at(const TraceGraph& graph, const Vec2& centre, double reach, std::vector<int>& ends) {
  TraceGraph out{graph.nodes, {}};
  for (const TraceEdge& e : graph.edges) {
    const auto outside = [&](std::size_t i) { return (e.line[i] - centre).norm() >= reach; };
    for (std::size_t i = 0; i < e.line.size(); ++i) {
      if (!outside(i)) continue;
      std::size_t last = i;
      while (last + 1 < e.line.size() && outside(last + 1)) ++last;
      TraceEdge piece = e;
      piece.line = {e.line.begin() + static_cast<std::ptrdiff_t>(i), e.line.begin() + static_cast<std::ptrdiff_t>(last) + 1};
      piece.radii = {e.radii.begin() + static_cast<std::ptrdiff_t>(i), e.radii.begin() + static_cast<std::ptrdiff_t>(last) + 1};
      if (piece.line.size() >= 4) {
        for (const bool front : {true, false}) {
          if (front ? i == 0 : last + 1 == e.line.size()) continue;
          ends.push_back(static_cast<int>(out.nodes.size()));
          (front ? piece.from : piece.to) = ends.back();
          out.nodes.push_back(front ? piece.line.front() : piece.line.back());
        }
        out.edges.push_back(std::move(piece));
      }
      i = last;
    }
  }
  return out;
}

std::vector<Vec2> outline_of(const Landmark& landmark) {
  std::vector<Vec2> rim;
  constexpr int kPoints = 48;
  for (int i = 0; i < kPoints; ++i) rim.push_back(landmark.centre + landmark.radius * direction_of(2.0 * kPi * i / kPoints));
  return rim;
}

}  // namespace ramify
