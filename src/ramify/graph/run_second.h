// SPDX-License-Identifier: GPL-3.0-or-later
// The search for every node's second-nearest generator, given the nearest. A path from generator g to a node whose own is
// another runs through nodes of which g is the own generator, then through nodes of which it is the second (at any other
// node two generators would be nearer, hence at its end too). So second costs spread from the borders of cells, and a node
// hands its second generator on to all neighbours but those that own it. Private to the layer.
#pragma once

#include <bit>
#include <vector>

#include "ramify/graph/labels.h"
#include "ramify/graph/second_nearest.h"

namespace ramify {

struct SecondLabels {
  std::uint32_t* sum;
  std::int32_t* other;
  struct Label {
    std::uint32_t sum;
    std::int32_t generator;
  };
  static constexpr bool kCostly = false;
  std::uint32_t key(std::uint32_t node) const { return sum[node]; }
  static std::uint32_t key_of(Label label) { return label.sum; }
  Label extended(std::uint32_t node, const Edge& edge) const { return {sum[node] + edge.full, other[node]}; }
  void set(std::uint32_t node, Label label) {
    sum[node] = label.sum;
    other[node] = label.generator;
  }
  bool overflows(std::uint32_t node) const { return sum[node] > kTickCeiling; }
  template <class View>
  static std::uint32_t lead(const View& view, std::uint32_t node) { return view.lead(node); }
};

// The edges along which second generators are handed on.
template <class View>
struct SecondView {
  using Link = typename View::Link;
  static constexpr bool kCostlyEdges = View::kCostlyEdges;
  const View& view;
  const std::int32_t* own;
  const std::int32_t* other;

  template <class Test, class Take>
  void visit(std::uint32_t node, const Test& test, const Take& take) const {
    view.visit(node, [&](std::uint32_t to, auto&& edge) { return own[to] != other[node] && test(to, edge); }, take);
  }
  std::uint32_t parent(std::uint32_t node, Link link) const { return view.parent(node, link); }
  std::uint32_t lead(std::uint32_t node) const { return view.lead(node); }
  template <class Labels>
  void prefetch(const Labels&, std::uint32_t) const {}
};

// `way` starts as a copy of the plan's links and becomes the last steps of second paths, for ties.
template <class View, class Links>
SearchEnd run_second(const View& view, const Plan& plan, Links way, std::uint32_t cheapest, TwoNearest& nearest,
                     const Monitor& monitor) {
  const std::size_t count = nearest.own.size();
  SecondLabels labels{nearest.sum.data(), nearest.other.data()};
  const std::uint32_t limit = tick_limit(plan.max_cost * plan.ticks_per_unit);
  for (std::uint32_t node = 0; node < count; ++node) {
    if (nearest.own[node] == kNone) {
      if (way[node] == View::kForbiddenLink) nearest.sum[node] = 0;  // nothing is offered to it
      continue;
    }
    const auto borders = [&](std::uint32_t to, auto&&) { return nearest.own[to] != kNone && nearest.own[to] != nearest.own[node]; };
    view.visit(node, borders, [&](std::uint32_t to, typename View::Link link, const Edge& edge) {
      const SecondLabels::Label offered{plan.sum[node] + edge.full, nearest.own[node]};
      if (offered.sum >= labels.key(to) || offered.sum > limit) return;
      labels.set(to, offered);
      way[to] = link;
    });
  }
  RadixQueue<std::uint32_t> queue(std::bit_width(cheapest) - 1);
  for (std::uint32_t node = 0; node < count; ++node) {
    if (nearest.other[node] != kNone) queue.push(labels.key(node) + view.lead(node), node);
  }
  StopAtEndpoints never{};
  return search(SecondView<View>{view, nearest.own.data(), nearest.other.data()}, labels, way, queue, never, limit, monitor);
}

}  // namespace ramify
