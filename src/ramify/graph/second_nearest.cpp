// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/graph/second_nearest.h"

#include <algorithm>
#include <stdexcept>
#include <string>

#include "ramify/graph/lattice_search.h"
#include "ramify/graph/point_view.h"
#include "ramify/graph/run_second.h"

namespace ramify {
namespace {

TwoNearest nearest_alone(const Plan& plan, const std::vector<int>& sources, std::span<const int> generator) {
  if (plan.metric.metric != Metric::Sum || plan.stopped_early) {
    throw std::invalid_argument("two_nearest: the plan must be by Sum and go to its end");
  }
  if (generator.size() != sources.size()) throw std::invalid_argument("two_nearest: give one generator a node");
  TwoNearest out;
  out.ticks_per_unit = plan.ticks_per_unit;
  out.own.assign(sources.size(), kNone);
  out.other = out.own;
  out.sum.assign(sources.size(), kFar);
  for (std::size_t node = 0; node < sources.size(); ++node) {
    if (sources[node] == kNone) continue;
    out.own[node] = generator[static_cast<std::size_t>(sources[node])];
    if (out.own[node] < 0) throw InputError("", "the source at node " + std::to_string(sources[node]) + " belongs to no generator");
  }
  return out;
}

SearchEnd search_again(const Lattice& lattice, const Plan& plan, const WeightRange& weights, TwoNearest& out, const Monitor& monitor) {
  switch (lattice.connectivity) {
    case Connectivity::Plane4: return search_lattice_again<4>(lattice, plan, weights, out, monitor);
    case Connectivity::Plane8: return search_lattice_again<8>(lattice, plan, weights, out, monitor);
    case Connectivity::Volume6: return search_lattice_again<6>(lattice, plan, weights, out, monitor);
    case Connectivity::Volume26: break;
  }
  return search_lattice_again<26>(lattice, plan, weights, out, monitor);
}

void check_end(SearchEnd end) {
  if (end == SearchEnd::Overflow) throw LimitError("the second-nearest generators lie too far away to be counted: make the range of the weights smaller");
}

}  // namespace

TwoNearest two_nearest(const Plan& plan, const Lattice& lattice, std::span<const int> generator, const Monitor& monitor) {
  if (plan.step.size() != static_cast<std::size_t>(lattice.count())) throw std::invalid_argument("two_nearest: another lattice");
  TwoNearest out = nearest_alone(plan, nearest_sources(plan, lattice), generator);
  check_end(search_again(lattice, plan, weight_range(lattice), out, monitor));
  return out;
}

TwoNearest two_nearest(const Plan& plan, const PointGraph& graph, std::span<const int> generator, const Monitor& monitor) {
  if (plan.parent.size() != static_cast<std::size_t>(graph.count())) throw std::invalid_argument("two_nearest: another graph");
  TwoNearest out = nearest_alone(plan, nearest_sources(plan, graph), generator);
  if (graph.cost.empty()) return out;
  const PointView view(graph, plan.ticks_per_unit);
  const float least = *std::min_element(graph.cost.begin(), graph.cost.end());
  std::vector<std::int32_t> way = plan.parent;
  check_end(run_second(view, plan, way.data(), view.cost_ticks(least), out, monitor));
  return out;
}

std::vector<int> connected_generators(const Lattice& lattice, std::span<const int> sources) {
  constexpr int kOpen = -2;
  std::vector<int> out(static_cast<std::size_t>(lattice.count()), kNone), sorted(sources.begin(), sources.end()), pile;
  for (const int node : sources) {
    if (node < 0 || node >= lattice.count()) throw InputError("", "source " + std::to_string(node) + " is not one of the " + std::to_string(lattice.count()) + " nodes");
    out[static_cast<std::size_t>(node)] = kOpen;
  }
  std::sort(sorted.begin(), sorted.end());
  int next = 0;
  for (const int start : sorted) {
    if (out[static_cast<std::size_t>(start)] != kOpen) continue;
    out[static_cast<std::size_t>(start)] = next;
    for (pile.assign(1, start); !pile.empty();) {
      const auto [x, y, z] = node_place(lattice, pile.back());
      pile.pop_back();
      for (const LatticeStep& s : lattice_steps(lattice.connectivity)) {
        if (!lattice.contains(x + s.dx, y + s.dy, z + s.dz)) continue;
        const int to = lattice.node(x + s.dx, y + s.dy, z + s.dz);
        if (out[static_cast<std::size_t>(to)] != kOpen) continue;
        out[static_cast<std::size_t>(to)] = next;
        pile.push_back(to);
      }
    }
    ++next;
  }
  return out;
}

double second_cost(const TwoNearest& nearest, int node) {
  const auto i = static_cast<std::size_t>(node);
  return nearest.other[i] == kNone ? std::numeric_limits<double>::infinity() : nearest.sum[i] / nearest.ticks_per_unit;
}

}  // namespace ramify
