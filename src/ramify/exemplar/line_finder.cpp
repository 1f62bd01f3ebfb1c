// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/exemplar/line_finder.h"

#include <algorithm>
#include <cmath>

#include "ramify/exemplar/trace_graph.h"
#include "ramify/image/filter.h"
#include "ramify/skeleton/skeletonize.h"
#include "ramify/skeleton/thickness.h"

namespace ramify {
namespace {

constexpr double kBridgeCost = 0.35;
constexpr int kSmallestHole = 60;  // px: smaller holes in where lines may run are noise, not loops

// Pixels stronger than `low` that are not weaker than both neighbours across the line.
Mask crests(const ScalarImage& strength, const VectorImage& tangent, double low, const Mask& excluded) {
  Mask out(strength.size());
  for (int y = 0; y < strength.height(); ++y) {
    for (int x = 0; x < strength.width(); ++x) {
      const float here = strength(x, y);
      if (here < low || (!excluded.empty() && excluded(x, y))) continue;
      const Eigen::Vector2f t = tangent(x, y);
      const int dx = static_cast<int>(std::lround(-t.y())), dy = static_cast<int>(std::lround(t.x()));
      if (here >= strength.clamped(x + dx, y + dy) && here >= strength.clamped(x - dx, y - dy)) out(x, y) = 255;
    }
  }
  return out;
}

// Crest pixels of those touching groups of ridge pixels (stronger than `low`) whose crest is long enough and reaches
// `high`. Grouping over the whole ridge closes the pinholes that a crest has where the best scale changes.
Mask long_crests(const Mask& crest, const ScalarImage& strength, double low, double high, double min_pixels) {
  Mask out(crest.size());
  int count = 0;
  const LabelImage group = label_components(threshold(strength, static_cast<float>(low)), true, count);
  std::vector<int> length(static_cast<std::size_t>(count), 0), strong(length);
  for (std::size_t i = 0; i < crest.pixels().size(); ++i) {
    if (!crest.pixels()[i] || group.pixels()[i] == kNone) continue;
    ++length[group.pixels()[i]];
    strong[group.pixels()[i]] += strength.pixels()[i] >= high;
  }
  for (std::size_t i = 0; i < crest.pixels().size(); ++i) {
    const int g = group.pixels()[i];
    if (crest.pixels()[i] && g != kNone && strong[g] >= 3 && length[g] >= min_pixels) out.pixels()[i] = 255;
  }
  return out;
}

// Where lines may run: near crests, wherever there is any ridge, so that junctions close.
Mask domain_of(const RidgeEvidence& e, const Mask& anchors) {
  Mask free(anchors.size());
  for (std::size_t i = 0; i < free.pixels().size(); ++i) free.pixels()[i] = anchors.pixels()[i] ? 0 : 255;
  const ScalarImage away = distance_inside(free);
  Mask domain(anchors.size());
  for (std::size_t i = 0; i < domain.pixels().size(); ++i) {
    const bool near = away.pixels()[i] <= 2.5f + e.field.sigma.pixels()[i] && e.field.sato.pixels()[i] > 0.6f * e.low;
    domain.pixels()[i] = anchors.pixels()[i] || near || e.thick.pixels()[i] ? 255 : 0;
  }
  return fill_small_holes(domain, kSmallestHole);
}

std::vector<Vec2> pixel_points(const std::vector<Pixel>& pixels) {
  std::vector<Vec2> points;
  for (const Pixel& p : pixels) points.emplace_back(p.x, p.y);
  return points;
}

Pixel snapped(const RidgeEvidence& e, const Vec2& p, double snap, const Mask& fixed) {
  const int cx = std::clamp(static_cast<int>(std::lround(p.x())), 0, e.picture.width() - 1);
  const int cy = std::clamp(static_cast<int>(std::lround(p.y())), 0, e.picture.height() - 1);
  Pixel best{cx, cy};
  if (!fixed.empty() && fixed(cx, cy)) return best;
  double best_value = -1.0;
  const int reach = static_cast<int>(snap);
  for (int y = cy - reach; y <= cy + reach; ++y) {
    for (int x = cx - reach; x <= cx + reach; ++x) {
      const double away = std::hypot(x - p.x(), y - p.y());
      if (!e.picture.contains(x, y) || away > snap) continue;
      const double value = e.field.strength(x, y) * (1.0 - 0.5 * away / (snap + 1.0));
      if (value > best_value) {
        best_value = value;
        best = {x, y};
      }
    }
  }
  return best;
}

}  // namespace

Mask find_lines(const RidgeEvidence& e, const Mask& excluded, const TraceOptions& options, const Monitor& monitor) {
  Mask anchors(e.picture.size());
  if (options.mode != TraceMode::Area) {
    anchors = long_crests(crests(e.field.strength, e.field.tangent, e.low, excluded), e.field.strength, e.low,
                          e.high, 0.4 * options.min_length);
  }
  double deepest = 0.0;
  for (std::size_t i = 0; i < e.thick.pixels().size(); ++i) {
    if (!e.thick.pixels()[i]) continue;
    anchors.pixels()[i] = 0;
    deepest = std::max(deepest, static_cast<double>(e.radius.pixels()[i]));
  }
  const int border = 2 + static_cast<int>(deepest);
  Mask domain = padded(domain_of(e, anchors), border);
  ScalarImage height(domain.size());
  const Mask wide = padded(e.thick, border);
  const Mask middle = deepest > 0.0 ? thin(wide, monitor) : wide;
  const ScalarImage depth = distance_inside(wide);
  Mask ends = padded(anchors, border);
  for (int y = 0; y < domain.height(); ++y) {
    for (int x = 0; x < domain.width(); ++x) {
      const int u = std::clamp(x - border, 0, e.picture.width() - 1), v = std::clamp(y - border, 0, e.picture.height() - 1);
      height(x, y) = wide(x, y) ? 1e4f + depth(x, y) : e.field.sato(u, v) + e.field.strength(u, v);
      if (middle(x, y)) ends(x, y) = 255;
    }
  }
  return cropped(thin_along_crests(domain, height, ends, monitor), border);
}

LatticeCosts live_wire_costs(const RidgeEvidence& e) {
  LatticeCosts costs{Image<std::uint16_t>(e.picture.size()), e.field.tangent, 1.0};
  for (std::size_t i = 0; i < costs.cost.pixels().size(); ++i) {
    const double v = e.thick.pixels()[i] ? 0.9 : std::min(1.0, e.field.strength.pixels()[i] / e.high);
    costs.cost.pixels()[i] = static_cast<std::uint16_t>(std::lround(1024.0 * (0.02 + (1.0 - v) * (1.0 - v))));
  }
  return costs;
}

std::vector<Pixel> live_wire(const RidgeEvidence& e, const LatticeCosts& costs, const std::vector<Vec2>& points,
                             double snap, const Mask& fixed, const Monitor& monitor) {
  std::vector<Pixel> path{snapped(e, points.front(), snap, fixed)};
  for (std::size_t i = 1; i < points.size(); ++i) {
    const Pixel from = path.back(), to = snapped(e, points[i], snap, fixed);
    const int grow = 32 + std::max(std::abs(from.x - to.x), std::abs(from.y - to.y)) / 4;
    PixelBox box{std::min(from.x, to.x) - grow, std::min(from.y, to.y) - grow, std::max(from.x, to.x) + grow,
                 std::max(from.y, to.y) + grow};
    auto piece = cheapest_path(costs, from, {to}, box, monitor);
    if (piece && piece->touches_rim) {  // once more in a larger box
      box = {box.left - 2 * grow, box.top - 2 * grow, box.right + 2 * grow, box.bottom + 2 * grow};
      piece = cheapest_path(costs, from, {to}, box, monitor);
    }
    if (piece) path.insert(path.end(), piece->pixels.begin() + 1, piece->pixels.end());
  }
  return path;
}

Mask bridge_gaps(const RidgeEvidence& e, const LatticeCosts& costs, const Mask& lines, double gap,
                 const Monitor& monitor) {
  const TraceGraph graph = graph_from_lines(lines);
  const auto incident = graph.edges_of_nodes();
  Mask out = lines;
  for (std::size_t n = 0; n < graph.nodes.size(); ++n) {
    monitor.check();
    if (incident[n].size() != 1) continue;
    const TraceEdge& own = graph.edges[incident[n].front()];
    const int length = static_cast<int>(own.line.size());
    if (length < 8) continue;
    const Vec2 end = graph.nodes[n];
    const bool at_from = own.from == static_cast<int>(n);
    const Vec2 before = own.line[at_from ? std::min(7, length - 1) : std::max(0, length - 8)];
    const Vec2 forward = (end - before).normalized();
    const Pixel start{static_cast<int>(std::lround(end.x())), static_cast<int>(std::lround(end.y()))};
    const int reach = static_cast<int>(4.0 + gap * std::min(12.0, static_cast<double>(e.radius(start.x, start.y))));
    Mask mine(2 * reach + 1, 2 * reach + 1);
    for (const Vec2& p : own.line) {
      const int u = static_cast<int>(std::lround(p.x())) - start.x + reach, v = static_cast<int>(std::lround(p.y())) - start.y + reach;
      if (mine.contains(u, v)) mine(u, v) = 255;
    }
    std::vector<Pixel> targets;
    for (int y = start.y - reach; y <= start.y + reach; ++y) {
      for (int x = start.x - reach; x <= start.x + reach; ++x) {
        if (!lines.contains(x, y) || !lines(x, y) || mine(x - start.x + reach, y - start.y + reach)) continue;
        if (forward.dot(Vec2(x - end.x(), y - end.y()).normalized()) > 0.5) targets.push_back({x, y});
      }
    }
    if (targets.empty()) continue;
    const auto path = cheapest_path(costs, start, targets,
                                    {start.x - reach, start.y - reach, start.x + reach, start.y + reach}, monitor);
    const double way = path ? line_length(pixel_points(path->pixels)) : 0.0;
    if (!path || way > 1.4 * reach) continue;
    // Mean cost well below what plain background costs (about 1024 x 1.5 with the turn factor).
    if (static_cast<double>(path->cost) / std::max(way, 1.0) > kBridgeCost * 1024.0) continue;
    for (const Pixel& p : path->pixels) out(p.x, p.y) = 255;
  }
  return out;
}

}  // namespace ramify
