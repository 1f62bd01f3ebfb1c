// SPDX-License-Identifier: GPL-3.0-or-later
// One search over a view, with the labels and the queue that the plan's metric needs. Private to the layer.
#pragma once

#include <bit>
#include <queue>
#include <utility>
#include <vector>

#include "ramify/graph/labels.h"
#include "ramify/graph/peak_queue.h"
#include "ramify/graph/plan.h"

namespace ramify {

struct SearchTask {
  std::span<const int> sources;
  std::span<const int> endpoints;
  double max_cost;
  EdgeBounds bounds;
};

// Beyond this many buckets most are empty and the radix queue is faster.
inline constexpr std::uint32_t kMostBuckets = 1u << 16;

template <class View, class Labels, class Links, class Queue, class Start>
SearchEnd run_from(const View& view, Labels labels, Links links, Queue queue, const SearchTask& task,
                   typename Queue::Key limit, const Start& start, const Monitor& monitor) {
  for (const int node : task.sources) {
    const auto label = start(node);
    if (links[node] == View::kSourceLink && !(labels.key_of(label) < labels.key(node))) continue;
    labels.set(node, label);
    links[node] = View::kSourceLink;
    queue.push(labels.key(node) + Labels::lead(view, node), node);
  }
  StopAtEndpoints stop{task.endpoints};
  const SearchEnd end = search(view, labels, links, queue, stop, limit, monitor);
  if (end == SearchEnd::Stopped) {  // what was not settled is not final
    queue.for_each_node([&](std::uint32_t node) {
      if (links[node] == View::kSourceLink || StopAtEndpoints::is_settled(view, labels, node, queue.horizon())) return;
      labels.clear(node);
      links[node] = View::kUnreachedLink;
    });
  }
  return end;
}

template <class View, class Links>
SearchEnd run_sum(const View& view, Plan& plan, Links links, const SearchTask& task, const Monitor& monitor) {
  const SumLabels labels{plan.sum.data()};
  const auto start = [&](int node) { return view.start_ticks(node); };
  const std::uint32_t limit = tick_limit(task.max_cost * plan.ticks_per_unit);
  if (BucketQueue::size_for(task.bounds.cheapest, task.bounds.dearest) <= kMostBuckets) {
    return run_from(view, labels, links, BucketQueue(task.bounds.cheapest, task.bounds.dearest), task, limit, start, monitor);
  }
  return run_from(view, labels, links, RadixQueue<std::uint32_t>(std::bit_width(task.bounds.cheapest) - 1), task, limit, start, monitor);
}

template <class View, class Links>
SearchEnd run_pairs(const View& view, Plan& plan, Links links, const SearchTask& task, const Monitor& monitor) {
  const PartialLabels labels{plan.pair.data()};
  const auto start = [&](int node) { return PartialLabels::Label{view.start_ticks(node), view.start_ticks(node)}; };
  const double ticks = task.max_cost * plan.ticks_per_unit;
  RadixQueue<std::uint64_t> queue(std::bit_width(task.bounds.cheapest) - 1);  // the sum is what a key ends with
  if (plan.metric.metric == Metric::Partial) {
    const std::uint64_t limit = PartialLabels::key_of({kFar, tick_limit(ticks)});
    if (BucketQueue::size_for(task.bounds.cheapest, task.bounds.dearest) <= kMostBuckets) {
      return run_from(view, labels, links,
                      PeakQueue<View>(view, plan.pair.data(), task.bounds.cheapest, task.bounds.dearest), task, limit,
                      start, monitor);
    }
    return run_from(view, labels, links, std::move(queue), task, limit, start, monitor);
  }
  const double sum_ticks = ticks / plan.metric.sum_share;
  const std::uint64_t limit = sum_ticks < 1e18 ? static_cast<std::uint64_t>(sum_ticks) : MixLabels::kFarKey - 1;
  return run_from(view, MixLabels{{labels}, plan.metric.peak_share / plan.metric.sum_share}, links,
                  std::move(queue), task, limit, start, monitor);
}

template <class View, class Links>
SearchEnd run_power(const View& view, Plan& plan, Links links, const SearchTask& task, const Monitor& monitor) {
  const double p = plan.metric.power;
  const PowerLabels labels{plan.power_sum.data(), p, 1.0 / (plan.ticks_per_unit * plan.power_unit)};
  const auto start = [&](int node) { return std::pow(view.start_ticks(node) * labels.unit_per_tick, p); };
  const double most = std::pow(task.max_cost / plan.power_unit, p);
  const std::uint64_t limit = PowerLabels::key_of(std::isfinite(most) ? most : std::numeric_limits<double>::max());
  return run_from(view, labels, links, RadixQueue<std::uint64_t>(0), task, limit, start, monitor);
}

// Prim's algorithm: the tree grows by the cheapest edge out of it, ties to axial edges, then by a hash of the edge.
template <class View, class Links>
SearchEnd run_full(const View& view, Plan& plan, Links links, const SearchTask& task, const Monitor& monitor) {
  using Item = QueueItem<std::uint64_t>;
  const auto later = [](const Item& a, const Item& b) { return a.key != b.key ? a.key > b.key : a.node > b.node; };
  std::priority_queue<Item, std::vector<Item>, decltype(later)> queue(later);
  constexpr std::uint64_t kSettled = 0;
  std::vector<std::uint64_t> best(plan.pair.size(), std::numeric_limits<std::uint64_t>::max());
  const std::uint32_t limit = tick_limit(task.max_cost * plan.ticks_per_unit);
  for (const int node : task.sources) {
    if (links[node] == View::kSourceLink) continue;
    links[node] = View::kSourceLink;
    plan.pair[node] = {view.start_ticks(node), view.start_ticks(node)};
    queue.push({best[node] = 1, static_cast<std::uint32_t>(node)});
  }
  std::size_t missing = task.endpoints.size();
  std::vector<char> wanted(missing ? best.size() : 0, 0);
  for (const int node : task.endpoints) missing -= wanted[node]++ ? 1 : 0;
  SearchEnd end = SearchEnd::Exhausted;
  for (std::size_t count = 0; !queue.empty(); ++count) {
    const auto [key, node] = queue.top();
    queue.pop();
    if (best[node] != key) continue;
    best[node] = kSettled;
    if (plan.pair[node].sum > kTickCeiling) return SearchEnd::Overflow;
    if (count % 20000 == 0) monitor.check();
    if (!wanted.empty() && wanted[node] && --missing == 0) {
      end = SearchEnd::Stopped;
      break;
    }
    const auto open = [&](std::uint32_t to, auto&&) {
      return best[to] != kSettled && links[to] != View::kSourceLink && links[to] != View::kForbiddenLink;
    };
    view.visit(node, open, [&](std::uint32_t to, typename View::Link link, const Edge& e) {
      const std::uint64_t offered = view.unique_key(e, node, to, link);
      if (offered >= best[to] || std::max(plan.pair[node].peak, e.plain) > limit) return;
      best[to] = offered;
      links[to] = link;
      plan.pair[to] = {plan.pair[node].sum + e.full, std::max(plan.pair[node].peak, e.plain)};
      queue.push({offered, to});
    });
  }
  for (; !queue.empty(); queue.pop()) {  // after a stop
    const std::uint32_t node = queue.top().node;
    if (best[node] == kSettled || links[node] == View::kSourceLink) continue;
    links[node] = View::kUnreachedLink;
    plan.pair[node] = {kFar, kFar};
  }
  return end;
}

template <class View, class Links>
SearchEnd run_search(const View& view, Plan& plan, Links links, const SearchTask& task, const Monitor& monitor) {
  switch (plan.metric.metric) {
    case Metric::Sum: return run_sum(view, plan, links, task, monitor);
    case Metric::Power: return run_power(view, plan, links, task, monitor);
    case Metric::Full: return run_full(view, plan, links, task, monitor);
    case Metric::Partial:
    case Metric::Mix: break;
  }
  return run_pairs(view, plan, links, task, monitor);
}

}  // namespace ramify
