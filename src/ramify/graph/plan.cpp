// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/graph/plan.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "ramify/graph/big_array.h"
#include "ramify/graph/lattice_search.h"
#include "ramify/graph/point_view.h"

namespace ramify {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kMostEdgeTicks = 1 << 28;

struct CostScale {
  double typical = 0.0;  // about what the dearest path costs
  double dearest = 0.0;  // edge
};

// The largest power of two to the unit that leaves room for paths of the typical cost.
double ticks_for(const CostScale& scale, const PlanOptions& options) {
  double most = std::max(scale.typical, 4.0 * scale.dearest);
  const Metric metric = options.metric.metric;
  if (metric == Metric::Sum) most = std::min(most, options.max_cost + 4.0 * scale.dearest);
  if (metric == Metric::Power) most = scale.dearest;  // the sum is kept as a double
  if (metric != Metric::Sum && metric != Metric::Power) most *= 4.0;  // these paths wind
  const double ticks = std::min(0x1.0p31 / most, kMostEdgeTicks / scale.dearest);
  return std::exp2(std::floor(std::log2(ticks)));
}

void check_plan_options(const PlanOptions& options, int count) {
  MetricOptions metric = options.metric;
  check_options(describe(metric));
  if (!(options.max_cost >= 0.0)) throw OptionError("max-cost", number_text(options.max_cost), "must be 0 or more");
  for (const int node : options.endpoints) {
    if (node < 0 || node >= count) throw InputError("", "endpoint " + std::to_string(node) + " is not one of the " + std::to_string(count) + " nodes");
  }
}

void check_sources(std::span<const int> sources, int count) {
  if (sources.empty()) throw InputError("", "paths need at least one source");
  for (const int node : sources) {
    if (node < 0 || node >= count) throw InputError("", "source " + std::to_string(node) + " is not one of the " + std::to_string(count) + " nodes");
  }
}

void check_sources(const Lattice& lattice, std::span<const int> sources) {
  check_sources(sources, lattice.count());
  for (const int node : sources) {
    if (!is_allowed(lattice, node)) throw InputError("", "the source at node " + std::to_string(node) + " is forbidden: move it or free the node");
  }
}

Plan blank_plan(const PlanOptions& options, std::size_t count) {
  Plan plan;
  plan.metric = options.metric;
  plan.max_cost = options.max_cost;
  const Metric metric = options.metric.metric;
  if (metric == Metric::Power) {
    assign_big(plan.power_sum, count, kInfinity);
  } else if (metric == Metric::Sum) {
    assign_big(plan.sum, count, kFar);
  } else {
    assign_big(plan.pair, count, {kFar, kFar});
  }
  return plan;
}

// Forbidden nodes have the label 0, so that the search need not ask: no offer is below.
void forbid(Plan& plan, int node) {
  plan.step.set(static_cast<std::size_t>(node), kForbidden);
  if (!plan.sum.empty()) plan.sum[node] = 0;
  if (!plan.pair.empty()) plan.pair[node] = {0, 0};
  if (!plan.power_sum.empty()) plan.power_sum[node] = 0.0;
}

void forbid_nodes(Plan& plan, const Lattice& lattice) {
  const int count = lattice.count();
  if (const auto* w = std::get_if<WholeWeights>(&lattice.weights)) {
    for (int i = 0; i < count; ++i) {
      if ((*w)[i] == 0) forbid(plan, i);
    }
  }
  if (const auto* w = std::get_if<RealWeights>(&lattice.weights)) {
    for (int i = 0; i < count; ++i) {
      if (!((*w)[i] > 0.0f && (*w)[i] <= std::numeric_limits<float>::max())) forbid(plan, i);
    }
  }
  if (lattice.allowed.empty()) return;
  for (int i = 0; i < count; ++i) {
    if (!lattice.allowed[i]) forbid(plan, i);
  }
}

SearchEnd search_on(const Lattice& lattice, Plan& plan, const SearchTask& task, const WeightRange& weights,
                    const Monitor& monitor) {
  switch (lattice.connectivity) {
    case Connectivity::Plane4: return search_lattice<4>(lattice, plan, task, weights, monitor);
    case Connectivity::Plane8: return search_lattice<8>(lattice, plan, task, weights, monitor);
    case Connectivity::Volume6: return search_lattice<6>(lattice, plan, task, weights, monitor);
    case Connectivity::Volume26: break;
  }
  return search_lattice<26>(lattice, plan, task, weights, monitor);
}

double typical_cost(const Lattice& lattice, const WeightRange& weights) {
  const bool diagonals = lattice.connectivity == Connectivity::Plane8 || lattice.connectivity == Connectivity::Volume26;
  const double across = diagonals ? 1.8 * std::max({lattice.width, lattice.height, lattice.depth})
                                  : 1.0 * lattice.width + lattice.height + lattice.depth;
  return 0.5 * (weights.least + weights.mean) * across;  // paths avoid what is dear
}

struct CostRange {
  double least = 1.0, most = 1.0, mean = 1.0;
};
CostRange cost_range(const PointGraph& graph) {
  if (graph.cost.empty()) return {};
  CostRange out{kInfinity, 0.0, 0.0};
  for (const float c : graph.cost) {
    if (!(c > 0.0f && std::isfinite(c))) throw InputError("", "the edges of a point graph must cost more than 0, not " + number_text(c));
    out.least = std::min<double>(out.least, c);
    out.most = std::max<double>(out.most, c);
    out.mean += c / static_cast<double>(graph.cost.size());
  }
  return out;
}

SearchEnd search_on(const PointGraph& graph, Plan& plan, SearchTask task, const CostRange& costs, const Monitor& monitor) {
  const PointView view(graph, plan.ticks_per_unit);
  task.bounds = {view.cost_ticks(static_cast<float>(costs.least)), view.cost_ticks(static_cast<float>(costs.most))};
  return run_search(view, plan, plan.parent.data(), task, monitor);
}

[[noreturn]] void throw_too_dear() {
  throw LimitError("paths on this graph cost too much to be counted: make the range of the weights smaller");
}

}  // namespace

Plan plan_paths(const Lattice& lattice, std::span<const int> sources, const PlanOptions& options, const Monitor& monitor) {
  check_lattice(lattice);
  check_sources(lattice, sources);
  check_plan_options(options, lattice.count());
  const WeightRange weights = weight_range(lattice);
  const CostScale scale{typical_cost(lattice, weights), dearest_edge(lattice, weights)};
  const double least_ticks = std::holds_alternative<WholeWeights>(lattice.weights) ? 2.0 : 1.0 / weights.least;
  for (double ticks = std::max(ticks_for(scale, options), least_ticks); ticks >= least_ticks; ticks /= 4.0) {
    Plan plan = blank_plan(options, static_cast<std::size_t>(lattice.count()));
    plan.ticks_per_unit = ticks;
    plan.power_unit = scale.dearest;
    plan.step = StepArray(static_cast<std::size_t>(lattice.count()), static_cast<int>(lattice_steps(lattice.connectivity).size()));
    forbid_nodes(plan, lattice);
    const SearchEnd end = search_on(lattice, plan, {sources, options.endpoints, options.max_cost, {}}, weights, monitor);
    plan.stopped_early = end == SearchEnd::Stopped;
    if (end != SearchEnd::Overflow) return plan;
  }
  throw_too_dear();
}

Plan plan_paths(const PointGraph& graph, std::span<const int> sources, const PlanOptions& options, const Monitor& monitor) {
  check_sources(sources, graph.count());
  check_plan_options(options, graph.count());
  const CostRange costs = cost_range(graph);
  const CostScale scale{4.0 * costs.mean * std::cbrt(graph.count()), costs.most};
  for (double ticks = ticks_for(scale, options); ticks * costs.least >= 1.0; ticks /= 4.0) {
    Plan plan = blank_plan(options, static_cast<std::size_t>(graph.count()));
    plan.ticks_per_unit = ticks;
    plan.power_unit = costs.most;
    plan.parent.assign(static_cast<std::size_t>(graph.count()), PointView::kUnreachedLink);
    const SearchEnd end = search_on(graph, plan, {sources, options.endpoints, options.max_cost, {}}, costs, monitor);
    plan.stopped_early = end == SearchEnd::Stopped;
    if (end != SearchEnd::Overflow) return plan;
  }
  throw_too_dear();
}

namespace {

// The sources of a plan and those that are added.
template <class Links, class Link>
std::vector<int> all_sources(const Links& links, Link source, std::span<const int> added) {
  std::vector<int> out;
  for (std::size_t i = 0; i < links.size(); ++i) {
    if (links[i] == source) out.push_back(static_cast<int>(i));
  }
  out.insert(out.end(), added.begin(), added.end());
  return out;
}

void check_reseed(const Plan& plan, double max_cost) {
  if (plan.stopped_early) throw std::invalid_argument("reseeded: the plan was stopped early, so what lies behind its front is unknown");
  if (!(max_cost >= 0.0 && max_cost <= plan.max_cost)) {
    throw OptionError("max-cost", number_text(max_cost), "must lie in 0 .. " + number_text(plan.max_cost) + ", the bound of the plan so far");
  }
}

bool stays_valid(const Plan& plan) { return plan.metric.metric == Metric::Sum || plan.metric.metric == Metric::Power; }

}  // namespace

Plan reseeded(Plan plan, const Lattice& lattice, std::span<const int> nodes, double max_cost, const Monitor& monitor) {
  check_reseed(plan, max_cost);
  if (plan.step.size() != static_cast<std::size_t>(lattice.count())) throw std::invalid_argument("reseeded: another lattice");
  if (!stays_valid(plan)) {
    return plan_paths(lattice, all_sources(plan.step, kSource, nodes), {plan.metric, max_cost, {}}, monitor);
  }
  if (nodes.empty()) return plan;
  check_sources(lattice, nodes);
  plan.max_cost = max_cost;
  search_on(lattice, plan, {nodes, {}, max_cost, {}}, weight_range(lattice), monitor);
  return plan;
}

Plan reseeded(Plan plan, const PointGraph& graph, std::span<const int> nodes, double max_cost, const Monitor& monitor) {
  check_reseed(plan, max_cost);
  if (plan.parent.size() != static_cast<std::size_t>(graph.count())) throw std::invalid_argument("reseeded: another graph");
  if (!stays_valid(plan)) {
    return plan_paths(graph, all_sources(plan.parent, PointView::kSourceLink, nodes), {plan.metric, max_cost, {}}, monitor);
  }
  if (nodes.empty()) return plan;
  check_sources(nodes, graph.count());
  plan.max_cost = max_cost;
  search_on(graph, plan, {nodes, {}, max_cost, {}}, cost_range(graph), monitor);
  return plan;
}

}  // namespace ramify
