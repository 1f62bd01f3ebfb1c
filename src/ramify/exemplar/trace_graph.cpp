// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/exemplar/trace_graph.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace ramify {
namespace {

constexpr int kDx[8] = {0, 1, 1, 1, 0, -1, -1, -1};
constexpr int kDy[8] = {-1, -1, 0, 1, 1, 1, 0, -1};

bool is_set(const Mask& m, int x, int y) { return m.contains(x, y) && m(x, y); }

int degree(const Mask& lines, int x, int y) {
  int n = 0;
  for (int k = 0; k < 8; ++k) n += is_set(lines, x + kDx[k], y + kDy[k]);
  return n;
}

// Labels clusters of touching node pixels (degree other than two) and appends their centroids.
LabelImage label_nodes(const Mask& lines, std::vector<Vec2>& centroids) {
  LabelImage label(lines.size(), kNone);
  for (int y = 0; y < lines.height(); ++y) {
    for (int x = 0; x < lines.width(); ++x) {
      if (!lines(x, y) || label(x, y) != kNone || degree(lines, x, y) == 2) continue;
      const int id = static_cast<int>(centroids.size());
      std::vector<std::pair<int, int>> cluster{{x, y}};
      label(x, y) = id;
      Vec2 sum = Vec2::Zero();
      for (std::size_t i = 0; i < cluster.size(); ++i) {
        const auto [cx, cy] = cluster[i];
        sum += Vec2(cx, cy);
        for (int k = 0; k < 8; ++k) {
          const int u = cx + kDx[k], v = cy + kDy[k];
          if (!is_set(lines, u, v) || label(u, v) != kNone || degree(lines, u, v) == 2) continue;
          label(u, v) = id;
          cluster.emplace_back(u, v);
        }
      }
      centroids.push_back(sum / static_cast<double>(cluster.size()));
    }
  }
  return label;
}

// Follows chain pixels from (x, y), which touches node `from`; appends the edge.
void follow_chain(const Mask& lines, const LabelImage& label, int x, int y, int from, Mask& seen, TraceGraph& graph) {
  TraceEdge edge;
  edge.from = from;
  edge.line.push_back(graph.nodes[from]);
  bool left_start = false;  // a chain of one pixel may touch its start on both sides
  for (;;) {
    seen(x, y) = 255;
    edge.line.emplace_back(x, y);
    int next_x = -1, next_y = -1, reached = kNone;
    for (int k = 0; k < 8; ++k) {
      const int u = x + kDx[k], v = y + kDy[k];
      if (!is_set(lines, u, v)) continue;
      if (label(u, v) != kNone) {
        if (label(u, v) != from || left_start) reached = label(u, v);
      } else if (!seen(u, v)) {
        next_x = u;
        next_y = v;
      }
    }
    if (next_x < 0 || reached != kNone) {
      edge.to = reached != kNone ? reached : from;
      edge.line.push_back(graph.nodes[edge.to]);
      if (edge.to != from || edge.line.size() > 6) graph.edges.push_back(std::move(edge));
      return;
    }
    left_start = true;
    x = next_x;
    y = next_y;
  }
}

// Nodes without edges are dropped and the others renumbered.
TraceGraph compacted(const TraceGraph& graph) {
  TraceGraph out;
  std::vector<int> fresh(graph.nodes.size(), kNone);
  for (TraceEdge edge : graph.edges) {
    for (int* end : {&edge.from, &edge.to}) {
      if (fresh[*end] == kNone) {
        fresh[*end] = static_cast<int>(out.nodes.size());
        out.nodes.push_back(graph.nodes[*end]);
      }
      *end = fresh[*end];
    }
    out.edges.push_back(std::move(edge));
  }
  return out;
}

TraceEdge reversed(TraceEdge edge) {
  std::swap(edge.from, edge.to);
  std::reverse(edge.line.begin(), edge.line.end());
  std::reverse(edge.radii.begin(), edge.radii.end());
  return edge;
}

double radius_at(const ScalarImage& radius, const Vec2& p) {
  return radius.clamped(static_cast<int>(std::lround(p.x())), static_cast<int>(std::lround(p.y())));
}

// Moves both junctions of short connecting edges to their middle.
TraceGraph merged_junctions(TraceGraph graph, const ScalarImage& radius, double factor) {
  const auto incident = graph.edges_of_nodes();
  std::vector<bool> touched(graph.nodes.size(), false);
  std::vector<TraceEdge> kept;
  std::vector<int> target(graph.nodes.size());
  std::iota(target.begin(), target.end(), 0);
  for (TraceEdge& e : graph.edges) {
    const bool junctions = incident[e.from].size() > 2 && incident[e.to].size() > 2 && e.from != e.to;
    const double near = factor * (radius_at(radius, graph.nodes[e.from]) + radius_at(radius, graph.nodes[e.to]));
    if (!junctions || touched[e.from] || touched[e.to] || line_length(e.line) > near) {
      kept.push_back(std::move(e));
      continue;
    }
    touched[e.from] = touched[e.to] = true;
    graph.nodes[e.from] = 0.5 * (graph.nodes[e.from] + graph.nodes[e.to]);
    target[e.to] = e.from;
  }
  for (TraceEdge& e : kept) {
    e.from = target[e.from];
    e.to = target[e.to];
    e.line.front() = graph.nodes[e.from];
    e.line.back() = graph.nodes[e.to];
  }
  graph.edges = std::move(kept);
  return compacted(graph);
}

TraceGraph without_small_components(const TraceGraph& graph, double min_length) {
  std::vector<int> parent(graph.nodes.size());
  std::iota(parent.begin(), parent.end(), 0);
  const auto find = [&](int i) {
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
  };
  for (const TraceEdge& e : graph.edges) parent[find(e.from)] = find(e.to);
  std::vector<double> total(graph.nodes.size(), 0.0);
  for (const TraceEdge& e : graph.edges) total[find(e.from)] += line_length(e.line);
  TraceGraph out{graph.nodes, {}};
  for (const TraceEdge& e : graph.edges) {
    if (total[find(e.from)] >= min_length) out.edges.push_back(e);
  }
  return compacted(out);
}

}  // namespace

std::vector<std::vector<int>> TraceGraph::edges_of_nodes() const {
  std::vector<std::vector<int>> incident(nodes.size());
  for (std::size_t i = 0; i < edges.size(); ++i) {
    incident[edges[i].from].push_back(static_cast<int>(i));
    incident[edges[i].to].push_back(static_cast<int>(i));
  }
  return incident;
}

double line_length(const std::vector<Vec2>& line) {
  double length = 0.0;
  for (std::size_t i = 1; i < line.size(); ++i) length += (line[i] - line[i - 1]).norm();
  return length;
}

TraceGraph graph_from_lines(const Mask& lines) {
  TraceGraph graph;
  const LabelImage label = label_nodes(lines, graph.nodes);
  Mask seen(lines.size());
  for (int y = 0; y < lines.height(); ++y) {
    for (int x = 0; x < lines.width(); ++x) {
      if (label(x, y) == kNone) continue;
      for (int k = 0; k < 8; ++k) {
        const int u = x + kDx[k], v = y + kDy[k];
        if (is_set(lines, u, v) && label(u, v) == kNone && !seen(u, v)) {
          follow_chain(lines, label, u, v, label(x, y), seen, graph);
        }
      }
    }
  }
  for (int y = 0; y < lines.height(); ++y) {  // what is left are closed rings
    for (int x = 0; x < lines.width(); ++x) {
      if (!lines(x, y) || seen(x, y) || label(x, y) != kNone) continue;
      graph.nodes.emplace_back(x, y);
      follow_chain(lines, label, x, y, static_cast<int>(graph.nodes.size()) - 1, seen, graph);
    }
  }
  return compacted(graph);
}

TraceGraph without_passing_nodes(const TraceGraph& graph) {
  TraceGraph out = graph;
  std::vector<bool> dead(out.edges.size(), false);
  auto incident = out.edges_of_nodes();
  for (std::size_t n = 0; n < out.nodes.size(); ++n) {
    if (incident[n].size() != 2 || incident[n][0] == incident[n][1]) continue;
    const int a = incident[n][0], b = incident[n][1];
    TraceEdge first = out.edges[a].to == static_cast<int>(n) ? out.edges[a] : reversed(out.edges[a]);
    const TraceEdge second = out.edges[b].from == static_cast<int>(n) ? out.edges[b] : reversed(out.edges[b]);
    const double la = line_length(first.line), lb = line_length(second.line);
    first.confidence = (first.confidence * la + second.confidence * lb) / std::max(la + lb, 1e-9);
    first.strength = (first.strength * la + second.strength * lb) / std::max(la + lb, 1e-9);
    first.line.insert(first.line.end(), second.line.begin() + 1, second.line.end());
    if (!first.radii.empty()) first.radii.insert(first.radii.end(), second.radii.begin() + 1, second.radii.end());
    first.to = second.to;
    out.edges[a] = std::move(first);
    dead[b] = true;
    for (int& e : incident[out.edges[a].to]) e = e == b ? a : e;
    incident[n].clear();
  }
  TraceGraph alive{out.nodes, {}};
  for (std::size_t i = 0; i < out.edges.size(); ++i) {
    if (!dead[i]) alive.edges.push_back(std::move(out.edges[i]));
  }
  return compacted(alive);
}

TraceGraph pruned(TraceGraph graph, const ScalarImage& radius, const PruneOptions& options) {
  // Each round merges pairs; wide water has clusters of junctions on its medial axis.
  for (std::size_t before = graph.nodes.size() + 1; graph.nodes.size() < before;) {
    before = graph.nodes.size();
    graph = without_passing_nodes(merged_junctions(std::move(graph), radius, options.merge_factor));
  }
  for (;;) {
    const auto incident = graph.edges_of_nodes();
    std::vector<std::pair<double, int>> spurs;
    for (std::size_t i = 0; i < graph.edges.size(); ++i) {
      const TraceEdge& e = graph.edges[i];
      const bool free_from = incident[e.from].size() == 1, free_to = incident[e.to].size() == 1;
      if (free_from == free_to) continue;
      const double limit =
          std::max(options.spur_factor * radius_at(radius, graph.nodes[free_from ? e.to : e.from]) + options.spur_length,
                   2.0 * options.weak_spur * (1.0 - e.confidence));
      const double length = line_length(e.line);
      if (length < limit) spurs.emplace_back(length, static_cast<int>(i));
    }
    if (spurs.empty()) break;
    // Only the shortest spur at each junction goes in one round: its neighbours may become through lines.
    std::sort(spurs.begin(), spurs.end());
    std::vector<bool> touched(graph.nodes.size(), false), dead(graph.edges.size(), false);
    for (const auto& [length, i] : spurs) {
      const TraceEdge& e = graph.edges[i];
      const int junction = incident[e.from].size() == 1 ? e.to : e.from;
      if (touched[junction]) continue;
      touched[junction] = true;
      dead[i] = true;
    }
    TraceGraph next{graph.nodes, {}};
    for (std::size_t i = 0; i < graph.edges.size(); ++i) {
      if (!dead[i]) next.edges.push_back(std::move(graph.edges[i]));
    }
    graph = without_passing_nodes(compacted(next));
  }
  return without_small_components(graph, options.min_component);
}

}  // namespace ramify
