// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/exemplar/drawn_strokes.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "ramify/exemplar/bank_wire.h"
#include "ramify/exemplar/stroke_text.h"
#include "ramify/exemplar/trace_graph.h"
#include "ramify/exemplar/traced_line.h"
#include "ramify/image/filter.h"

namespace ramify {
namespace {

constexpr double kSnap = 8.0;     // px, how far a given point may be moved to the ridge (ALGORITHMS 3.1-4)
constexpr double kAttach = 16.0;  // px, strokes starting or ending this near to another one join it

void draw_path(Mask& lines, const std::vector<Pixel>& path) {
  for (const Pixel& p : path) lines(p.x, p.y) = 255;
}

// The polygon through the points, pixel by pixel.
std::vector<Pixel> straight_path(const std::vector<Vec2>& points, Size size) {
  std::vector<Pixel> path;
  for (const Vec2& p : evenly_spaced(points, 0.5)) {
    const Pixel q{std::clamp(static_cast<int>(std::lround(p.x())), 0, size.width - 1),
                  std::clamp(static_cast<int>(std::lround(p.y())), 0, size.height - 1)};
    if (path.empty() || !(path.back() == q)) path.push_back(q);
  }
  return path;
}

// The drawn pixel nearest to p within kAttach px, or within the wide stroke p lies in; else p: strokes that start or
// end at another stroke join it.
Vec2 attached(const DrawnStrokes& drawn, const Vec2& p) {
  const int cx = static_cast<int>(std::lround(p.x())), cy = static_cast<int>(std::lround(p.y()));
  Vec2 best = p;
  double nearest = kAttach;
  if (drawn.wide.contains(cx, cy) && drawn.wide(cx, cy)) nearest = 1e9;
  const int reach = nearest > kAttach ? drawn.lines.width() + drawn.lines.height() : static_cast<int>(kAttach);
  for (int y = std::max(0, cy - reach); y <= std::min(drawn.lines.height() - 1, cy + reach); ++y) {
    for (int x = std::max(0, cx - reach); x <= std::min(drawn.lines.width() - 1, cx + reach); ++x) {
      const double away = std::hypot(x - p.x(), y - p.y());
      if (!drawn.lines(x, y) || away >= nearest) continue;
      nearest = away;
      best = Vec2(x, y);
    }
  }
  return best;
}

}  // namespace

DrawnStrokes no_strokes(Size size) {
  return {Mask(size), Mask(size), ScalarImage(size)};
}

DrawnStrokes draw_strokes(const RidgeEvidence& evidence, const LatticeCosts& costs, const TraceOptions& options,
                          const Monitor& monitor) {
  const Size size = evidence.picture.size();
  DrawnStrokes drawn = no_strokes(size);
  for (std::vector<Vec2> stroke : parse_strokes("through", options.through)) {
    auto ribbon = options.straight || options.banks <= 0.0
                      ? std::nullopt
                      : trace_banks(evidence.picture, evidence.bright, stroke, options.banks, monitor);
    if (ribbon)
      stroke = {Vec2(ribbon->middle.front().x, ribbon->middle.front().y),
                Vec2(ribbon->middle.back().x, ribbon->middle.back().y)};
    const Vec2 first = attached(drawn, stroke.front()), last = attached(drawn, stroke.back());
    if (ribbon) {
      draw_path(drawn.lines, straight_path({first, stroke.front()}, size));
      draw_path(drawn.lines, ribbon->middle);
      draw_path(drawn.lines, straight_path({stroke.back(), last}, size));
      for (std::size_t i = 0; i < drawn.wide.pixels().size(); ++i) {
        if (!ribbon->inside.pixels()[i]) continue;
        drawn.wide.pixels()[i] = 255;
        drawn.radius.pixels()[i] = std::max(drawn.radius.pixels()[i], ribbon->radius.pixels()[i]);
      }
      continue;
    }
    if (first != stroke.front()) stroke.insert(stroke.begin(), first);
    if (last != stroke.back()) stroke.push_back(last);
    draw_path(drawn.lines, draw_stroke(evidence, costs, stroke, options.straight, drawn.lines, monitor));
  }
  return drawn;
}

std::vector<Pixel> draw_stroke(const RidgeEvidence& evidence, const LatticeCosts& costs,
                               const std::vector<Vec2>& points, bool straight, const Mask& fixed,
                               const Monitor& monitor) {
  return straight ? straight_path(points, evidence.picture.size())
                  : live_wire(evidence, costs, points, kSnap, fixed, monitor);
}

void leave_out(RidgeEvidence& evidence, const DrawnStrokes& drawn) {
  for (std::size_t i = 0; i < drawn.wide.pixels().size(); ++i)
    if (drawn.wide.pixels()[i]) evidence.thick.pixels()[i] = 0;
}

void take_in(RidgeEvidence& evidence, const DrawnStrokes& drawn) {
  for (std::size_t i = 0; i < drawn.wide.pixels().size(); ++i) {
    if (!drawn.wide.pixels()[i]) continue;
    evidence.thick.pixels()[i] = 255;
    evidence.radius.pixels()[i] = drawn.radius.pixels()[i];
  }
}

void join_at_banks(Mask& lines, const DrawnStrokes& drawn) {
  if (mean_of(drawn.wide) == 0.0) return;
  constexpr float kNear = 8.0f;  // px
  const ScalarImage away = distance_to(drawn.wide);
  const TraceGraph graph = graph_from_lines(lines);
  const auto incident = graph.edges_of_nodes();
  for (std::size_t n = 0; n < graph.nodes.size(); ++n) {
    const Vec2& end = graph.nodes[n];
    if (incident[n].size() != 1 || away.clamped(static_cast<int>(end.x()), static_cast<int>(end.y())) > kNear) continue;
    Vec2 best = end;
    double nearest = std::numeric_limits<double>::max();
    for (int y = 0; y < lines.height(); ++y) {
      for (int x = 0; x < lines.width(); ++x) {
        const double d = drawn.lines(x, y) && drawn.wide(x, y) ? (Vec2(x, y) - end).norm() : nearest;
        if (d < nearest) nearest = d, best = Vec2(x, y);
      }
    }
    draw_path(lines, straight_path({end, best}, lines.size()));
  }
}

}  // namespace ramify
