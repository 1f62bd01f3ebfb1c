// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/exemplar/trace_strokes.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace ramify {
namespace {

constexpr double kThroughCosine = 0.2;  // the straightest pair at a node bends by less than 78 degrees
constexpr double kCrossCosine = 0.6;    // a second pair is a crossing: it bends by less than 53 degrees
constexpr double kThicknessShare = 1.0;  // of |log ratio|: a main goes on in the thick arm, not in a creek

constexpr int kLook = 24;                // px over which the radius beyond a junction is read

struct EdgeEnd {
  int edge = kNone;
  bool at_from = true;
};

TraceStroke stroke_of_edge(const TraceEdge& e) {
  return {{e.from, e.to}, {0, static_cast<int>(e.line.size()) - 1}, e.line, e.radii, e.confidence};
}

void reverse(TraceStroke& s) {
  std::reverse(s.nodes.begin(), s.nodes.end());
  std::reverse(s.line.begin(), s.line.end());
  std::reverse(s.radii.begin(), s.radii.end());
  std::reverse(s.at.begin(), s.at.end());
  for (int& a : s.at) a = static_cast<int>(s.line.size()) - 1 - a;
}

void append(TraceStroke& s, const TraceStroke& next) {
  const double mine = line_length(s.line), other = line_length(next.line);
  const int offset = static_cast<int>(s.line.size()) - 1;
  s.confidence = (s.confidence * mine + next.confidence * other) / std::max(mine + other, 1e-9);
  s.line.insert(s.line.end(), next.line.begin() + 1, next.line.end());
  s.radii.insert(s.radii.end(), next.radii.begin() + 1, next.radii.end());
  for (std::size_t i = 1; i < next.nodes.size(); ++i) {
    s.nodes.push_back(next.nodes[i]);
    s.at.push_back(next.at[i] + offset);
  }
}

struct Pairing {
  double score = 0.0, cosine = 0.0;
  int a = kNone, b = kNone;  // edge ends at the node
};

// Which edge end goes on in which other one at a node; index 2 * edge + (at its `to` end).
std::vector<int> partners_of(const TraceGraph& graph, const std::vector<int>& stops) {
  std::vector<std::vector<EdgeEnd>> ends(graph.nodes.size());
  for (std::size_t e = 0; e < graph.edges.size(); ++e) {
    ends[graph.edges[e].from].push_back({static_cast<int>(e), true});
    ends[graph.edges[e].to].push_back({static_cast<int>(e), false});
  }
  for (const int n : stops) ends[n].clear();
  std::vector<int> partner(2 * graph.edges.size(), kNone);
  const auto slot = [](const EdgeEnd& end) { return 2 * end.edge + (end.at_from ? 0 : 1); };
  for (const auto& here : ends) {
    std::vector<Pairing> pairs;
    for (std::size_t a = 0; a < here.size(); ++a) {
      for (std::size_t b = a + 1; b < here.size(); ++b) {
        if (here[a].edge == here[b].edge) continue;
        const TraceEdge &p = graph.edges[here[a].edge], &q = graph.edges[here[b].edge];
        const TraceStroke ps = stroke_of_edge(p), qs = stroke_of_edge(q);
        const Vec2 out = here[a].at_from ? heading(ps, 0, 1) : heading(ps, ps.at.back(), -1);
        const Vec2 other = here[b].at_from ? heading(qs, 0, 1) : heading(qs, qs.at.back(), -1);
        const double ra = here[a].at_from ? clear_radius(ps, 0, 1) : clear_radius(ps, ps.at.back(), -1);
        const double rb = here[b].at_from ? clear_radius(qs, 0, 1) : clear_radius(qs, qs.at.back(), -1);
        const double cosine = -out.dot(other);
        pairs.push_back({cosine - kThicknessShare * std::abs(std::log(ra / rb)), cosine, slot(here[a]), slot(here[b])});
      }
    }
    std::stable_sort(pairs.begin(), pairs.end(), [](const Pairing& x, const Pairing& y) { return x.score > y.score; });
    bool first = true;
    for (const Pairing& pair : pairs) {
      if (partner[pair.a] != kNone || partner[pair.b] != kNone) continue;
      if (pair.cosine < (first ? kThroughCosine : kCrossCosine)) continue;
      partner[pair.a] = pair.b;
      partner[pair.b] = pair.a;
      first = false;
    }
  }
  return partner;
}

}  // namespace

int clear_of_junction(const TraceStroke& s, int at, int sign) {
  const int n = static_cast<int>(s.line.size());
  int i = at;
  while (i + sign >= 0 && i + sign < n && (s.line[i] - s.line[at]).norm() < 1.2 * s.radii[at] + 2.0) i += sign;
  return i;
}

double clear_radius(const TraceStroke& s, int at, int sign) {
  const int n = static_cast<int>(s.line.size()), first = clear_of_junction(s, at, sign);
  std::vector<double> near;
  for (int i = first; i >= 0 && i < n && std::abs(i - first) <= kLook; i += sign) near.push_back(s.radii[i]);
  const auto middle = near.begin() + static_cast<std::ptrdiff_t>(near.size() / 2);
  std::nth_element(near.begin(), middle, near.end());
  return *middle;
}

Vec2 heading(const TraceStroke& s, int at, int sign) {
  const int n = static_cast<int>(s.line.size()), clear = clear_of_junction(s, at, sign);
  const int reach = std::max(8, static_cast<int>(2.0 * s.radii[clear]));
  const Vec2 d = s.line[std::clamp(clear + sign * reach / 2, 0, n - 1)] - s.line[at];
  return d.norm() > 0.0 ? Vec2(d.normalized()) : Vec2(1.0, 0.0);
}

std::vector<TraceStroke> strokes_of(const TraceGraph& graph, const std::vector<int>& stops) {
  const std::vector<int> partner = partners_of(graph, stops);
  std::vector<bool> used(graph.edges.size(), false);
  std::vector<TraceStroke> strokes;
  for (std::size_t e = 0; e < graph.edges.size(); ++e) {
    if (used[e]) continue;
    used[e] = true;
    TraceStroke stroke = stroke_of_edge(graph.edges[e]);
    for (const int side : {1, 0}) {  // onwards from the edge's end, then, turned round, from its start
      if (side == 0) reverse(stroke);
      for (int next = partner[2 * e + static_cast<std::size_t>(side)]; next != kNone && !used[next / 2];) {
        used[next / 2] = true;
        TraceStroke piece = stroke_of_edge(graph.edges[next / 2]);
        if (next % 2) reverse(piece);
        append(stroke, piece);
        next = partner[next ^ 1];
      }
    }
    strokes.push_back(std::move(stroke));
  }
  return strokes;
}

}  // namespace ramify
