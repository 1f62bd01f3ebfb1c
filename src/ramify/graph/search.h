// SPDX-License-Identifier: GPL-3.0-or-later
// The label-setting search all plans run on (Dijkstra 1959). It is put together from
//   a View, which walks a node's edges: view.visit(node, test, take) asks test(neighbour, edge) of all edges and then calls
//     take(neighbour, link, edge) for those where it held: two loops, because the first runs without a branch (most of
//     the time of a search goes into mispredicted ones), view.parent(node, link) reads a link, and view.lead(node) is what
//     the node itself adds to every edge at it;
//   Labels, what is known of a node (labels.h);
//   a queue of bucket_queue.h; a Stop that may end the search early.
// Private to the layer.
#pragma once

#include <cstdint>
#include <span>

#include "ramify/core/monitor.h"
#include "ramify/graph/bucket_queue.h"

namespace ramify {

// An edge in ticks: with the length of diagonals for sums, and without it for peaks.
struct Edge {
  std::uint32_t full;
  std::uint32_t plain;
};

// The cheapest and the dearest edge there can be, in ticks.
struct EdgeBounds {
  std::uint32_t cheapest = 1, dearest = 1;
};

// Ends when all endpoints have their final label; never when there are none.
struct StopAtEndpoints {
  std::span<const int> endpoints;
  std::size_t next = 0;
  void settled(std::uint32_t) {}
  template <class View, class Labels>
  bool done(const View& view, const Labels& labels, std::uint64_t horizon) {
    while (next < endpoints.size() && is_settled(view, labels, endpoints[next], horizon)) ++next;
    return next == endpoints.size() && !endpoints.empty();
  }
  template <class View, class Labels>
  static bool is_settled(const View& view, const Labels& labels, std::uint32_t node, std::uint64_t horizon) {
    const std::uint64_t key = labels.key(node);
    return key < horizon && key + Labels::lead(view, node) < horizon;
  }
};

enum class SearchEnd { Exhausted, Stopped, Overflow };

// `links[node]` is a node's link, `limit` is the largest key a node may get, `ceiling` the largest a settled node may have
// so that no sum overflows. Of neighbours that offer the same label the one settled first (lower key, then lower index)
// becomes the parent, whatever the order in which the queue handed them out.
//
// The queue orders nodes not by their keys but by what leaving them costs: key + view.lead(node), the node's share of its
// edges. Where an edge costs the mean of its nodes, all neighbours that reach a node pay the same share of its own, so the
// first to be worked off is nearly always the best, and few labels are ever improved. Labels are final in that order too:
// what u with key(u) + lead(u) >= key(v) + lead(v) offers to v is at least key(u) + lead(u) + lead(v) > key(v).
template <class View, class Labels, class Links, class Queue, class Stop>
SearchEnd search(const View& view, Labels& labels, Links links, Queue& queue, Stop& stop,
                 typename Queue::Key limit, const Monitor& monitor) {
  using Key = typename Queue::Key;
  using Link = typename View::Link;
  std::size_t since_check = 0;
  while (!queue.empty()) {
    const auto& batch = queue.pop_batch();
    // What is worked off next lies scattered along the front: have it brought near.
    if constexpr (requires { queue.preview([](std::uint32_t) {}); }) {
      queue.preview([&](std::uint32_t node) __attribute__((always_inline)) { view.prefetch(labels, node); });
    } else {
      for (const auto& item : batch) view.prefetch(labels, Queue::node_of(item));
    }
    for (const auto& item : batch) {
      const std::uint32_t node = Queue::node_of(item);
      const Key key = labels.key(node), leaving = key + Labels::lead(view, node);
      if (!queue.is_current(item, leaving)) continue;  // a better label came later
      if (labels.overflows(node)) return SearchEnd::Overflow;
      stop.settled(node);
      const auto may_improve = [&](std::uint32_t to, auto&& edge) {
        if constexpr (View::kCostlyEdges || Labels::kCostly) {
          if (labels.key(to) <= leaving) return false;  // every offer is above it
        }
        return labels.key_of(labels.extended(node, edge())) <= labels.key(to);
      };
      view.visit(node, may_improve, [&](std::uint32_t to, Link link, const Edge& edge) {
        const Key old = labels.key(to);
        const auto label = labels.extended(node, edge);
        const Key offered = labels.key_of(label);
        if (offered < old) {
          if (offered > limit) return;
          labels.set(to, label);
          links[to] = link;
          if constexpr (requires { queue.push(offered, to, old); }) {
            queue.push(offered + Labels::lead(view, to), to, old);
          } else {
            queue.push(offered + Labels::lead(view, to), to);
          }
        } else if (old > key) {
          const std::uint32_t rival = view.parent(to, links[to]);
          const Key rival_key = labels.key(rival);
          if (key < rival_key || (key == rival_key && node < rival)) {
            labels.set(to, label);
            links[to] = link;
          }
        }
      });
    }
    since_check += batch.size();
    if (since_check > 20000) {
      monitor.check();
      since_check = 0;
    }
    if (stop.done(view, labels, queue.horizon())) return SearchEnd::Stopped;
  }
  return SearchEnd::Exhausted;
}

}  // namespace ramify
