// SPDX-License-Identifier: GPL-3.0-or-later
// A point graph as the search sees it. Private to the layer.
#pragma once

#include "ramify/graph/lattice_hash.h"
#include "ramify/graph/plan.h"
#include "ramify/graph/search.h"

namespace ramify {

class PointView {
 public:
  using Link = std::int32_t;  // the parent
  static constexpr bool kCostlyEdges = false;
  static constexpr Link kSourceLink = -kSource, kForbiddenLink = -kForbidden, kUnreachedLink = -kUnreached;

  PointView(const PointGraph& graph, double ticks_per_unit) : graph_(graph), ticks_(ticks_per_unit) {}

  template <class Test, class Take>
  void visit(std::uint32_t node, const Test& test, const Take& take) const {
    for (std::int32_t i = graph_.first[node]; i < graph_.first[node + 1]; ++i) {
      const std::uint32_t to = static_cast<std::uint32_t>(graph_.neighbor[i]), ticks = cost_ticks(graph_.cost[i]);
      const Edge edge{ticks, ticks};
      if (test(to, [&] { return edge; })) take(to, static_cast<Link>(node), edge);
    }
  }
  std::uint32_t cost_ticks(float cost) const {
    const std::uint32_t ticks = static_cast<std::uint32_t>(cost * ticks_ + 0.5);
    return ticks > 1 ? ticks : 1;
  }
  std::uint32_t parent(std::uint32_t, Link link) const { return static_cast<std::uint32_t>(link); }
  std::uint32_t lead(std::uint32_t) const { return 0; }
  template <class Labels>
  void prefetch(const Labels&, std::uint32_t) const {}
  std::uint32_t start_ticks(std::uint32_t) const { return 0; }
  std::uint64_t unique_key(const Edge& e, std::uint32_t a, std::uint32_t b, Link) const {
    return (static_cast<std::uint64_t>(e.plain) << 32) | edge_hash(0, a, b);
  }

 private:
  const PointGraph& graph_;
  double ticks_;
};

}  // namespace ramify
