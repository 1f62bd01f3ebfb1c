// SPDX-License-Identifier: GPL-3.0-or-later
// What callers read from a plan.
#include <cmath>
#include <limits>

#include "ramify/graph/plan.h"

namespace ramify {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// The source at the end of every node's way, each way walked once.
template <class Parent>
std::vector<int> follow_to_sources(const Plan& plan, int count, const Parent& parent) {
  std::vector<int> source(static_cast<std::size_t>(count), kNone), way;
  for (int start = 0; start < count; ++start) {
    if (source[start] != kNone || !is_reached(plan, start)) continue;
    int at = start;
    for (int next = parent(at); source[at] == kNone && next != kNone; next = parent(at)) {
      way.push_back(at);
      at = next;
    }
    if (source[at] == kNone) source[at] = at;
    for (; !way.empty(); way.pop_back()) source[way.back()] = source[at];
  }
  return source;
}

}  // namespace

bool is_reached(const Plan& plan, int node) {
  if (!plan.step.empty()) return plan.step[node] != kUnreached && plan.step[node] != kForbidden;
  return plan.parent[node] >= 0 || plan.parent[node] == -kSource;
}

double path_cost(const Plan& plan, int node) {
  if (!is_reached(plan, node)) return kInfinity;
  const MetricOptions& m = plan.metric;
  switch (m.metric) {
    case Metric::Sum: return plan.sum[node] / plan.ticks_per_unit;
    case Metric::Power: return std::pow(plan.power_sum[node], 1.0 / m.power) * plan.power_unit;
    case Metric::Mix: return (m.peak_share * plan.pair[node].peak + m.sum_share * plan.pair[node].sum) / plan.ticks_per_unit;
    case Metric::Partial:
    case Metric::Full: break;
  }
  return plan.pair[node].peak / plan.ticks_per_unit;
}

double path_sum(const Plan& plan, int node) {
  if (!is_reached(plan, node) || plan.metric.metric == Metric::Power) return kInfinity;
  return (plan.sum.empty() ? plan.pair[node].sum : plan.sum[node]) / plan.ticks_per_unit;
}

int path_parent(const Plan& plan, const Lattice& lattice, int node) {
  if (plan.step[node] >= kSource) return kNone;
  const LatticeStep s = lattice_steps(lattice.connectivity)[plan.step[node]];
  return node + s.dx + lattice.width * (s.dy + lattice.height * s.dz);
}

int path_parent(const Plan& plan, const PointGraph&, int node) { return plan.parent[node] >= 0 ? plan.parent[node] : kNone; }

std::vector<int> nearest_sources(const Plan& plan, const Lattice& lattice) {
  return follow_to_sources(plan, lattice.count(), [&](int node) { return path_parent(plan, lattice, node); });
}

std::vector<int> nearest_sources(const Plan& plan, const PointGraph& graph) {
  return follow_to_sources(plan, graph.count(), [&](int node) { return path_parent(plan, graph, node); });
}

}  // namespace ramify
