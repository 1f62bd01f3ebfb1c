// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/exemplar/trace_net.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace ramify {
namespace {

constexpr double kMeshShare = 0.2;   // meshes per edge; a tree has none, a honeycomb a third
constexpr double kTimesStronger = 2.0;
constexpr double kSeparation = 0.55; // variance between the classes over the whole variance
constexpr double kBridge = 8.0;      // px: a weak piece up to this long between strong ones is a junction's dip

int mesh_count(const TraceGraph& graph) {
  std::vector<int> parent(graph.nodes.size());
  std::iota(parent.begin(), parent.end(), 0);
  const auto find = [&](int i) {
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
  };
  int meshes = 0;
  for (const TraceEdge& e : graph.edges) {
    const int a = find(e.from), b = find(e.to);
    meshes += a == b;
    parent[a] = b;
  }
  return meshes;
}

// Otsu's cut of the logarithm of strength, edges weighted by their length; 0 when the classes are too alike.
double class_cut(const TraceGraph& graph) {
  std::vector<std::pair<double, double>> values;  // log strength, length
  double total = 0.0, sum = 0.0, square = 0.0;
  for (const TraceEdge& e : graph.edges) {
    const double v = std::log(std::max(e.strength, 1e-6)), w = line_length(e.line);
    values.emplace_back(v, w);
    total += w;
    sum += w * v;
    square += w * v * v;
  }
  std::sort(values.begin(), values.end());
  const double variance = square / total - sum * sum / (total * total);
  double below = 0.0, sum_below = 0.0, best = 0.0, cut = 0.0, ratio = 0.0;
  for (std::size_t i = 0; i + 1 < values.size(); ++i) {
    below += values[i].second;
    sum_below += values[i].second * values[i].first;
    const double gap = (sum - sum_below) / (total - below) - sum_below / below;
    const double between = below * (total - below) / (total * total) * gap * gap;
    if (between <= best) continue;
    best = between;
    cut = values[i].first;
    ratio = std::exp(gap);
  }
  return best >= kSeparation * variance && ratio >= kTimesStronger ? std::exp(cut) : 0.0;
}

}  // namespace

TraceGraph without_net(const TraceGraph& graph) {
  if (graph.edges.size() < 2 || mesh_count(graph) < kMeshShare * static_cast<double>(graph.edges.size())) return graph;
  const double cut = class_cut(graph);
  if (cut <= 0.0) return graph;
  std::vector<bool> strong(graph.nodes.size(), false);
  for (const TraceEdge& e : graph.edges) {
    if (e.strength > cut) strong[e.from] = strong[e.to] = true;
  }
  TraceGraph out{graph.nodes, {}};
  for (const TraceEdge& e : graph.edges) {
    if (e.strength > cut || (strong[e.from] && strong[e.to] && line_length(e.line) <= kBridge)) out.edges.push_back(e);
  }
  return out;
}

}  // namespace ramify
