// SPDX-License-Identifier: GPL-3.0-or-later
// What a search knows of a node under each metric, and how an edge extends it. Keys order nodes; labels of equal keys may
// differ (Mix). Private to the layer.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include "ramify/graph/plan.h"
#include "ramify/graph/search.h"

namespace ramify {

inline constexpr std::uint32_t kFar = std::numeric_limits<std::uint32_t>::max();
// No label beyond this is extended, so that no sum of ticks overflows (edges stay below 2^29 ticks).
inline constexpr std::uint32_t kTickCeiling = kFar - (1u << 30);

inline std::uint32_t tick_limit(double ticks) {
  return ticks < static_cast<double>(kFar) ? static_cast<std::uint32_t>(ticks) : kFar - 1;
}

struct SumLabels {
  std::uint32_t* sum;
  using Label = std::uint32_t;
  static constexpr bool kCostly = false;
  const void* place(std::uint32_t node) const { return sum + node; }
  std::uint32_t key(std::uint32_t node) const { return sum[node]; }
  static std::uint32_t key_of(Label label) { return label; }
  Label extended(std::uint32_t node, const Edge& edge) const { return sum[node] + edge.full; }
  void set(std::uint32_t node, Label label) { sum[node] = label; }
  void clear(std::uint32_t node) { sum[node] = kFar; }
  bool overflows(std::uint32_t node) const { return sum[node] > kTickCeiling; }
  template <class View>
  static std::uint32_t lead(const View& view, std::uint32_t node) { return view.lead(node); }
};

// Partial: peak first, then sum. Forbidden nodes have peak and sum 0, so that nothing is offered to them.
struct PartialLabels {
  SumAndPeak* pair;
  using Label = SumAndPeak;
  static constexpr bool kCostly = false;  // extending takes longer than a mispredicted branch
  const void* place(std::uint32_t node) const { return pair + node; }
  static std::uint64_t key_of(Label label) { return (static_cast<std::uint64_t>(label.peak) << 32) | label.sum; }
  std::uint64_t key(std::uint32_t node) const { return key_of(pair[node]); }
  Label extended(std::uint32_t node, const Edge& edge) const {
    const Label own = pair[node];
    return {own.sum + edge.full, own.peak > edge.plain ? own.peak : edge.plain};
  }
  void set(std::uint32_t node, Label label) { pair[node] = label; }
  void clear(std::uint32_t node) { pair[node] = {kFar, kFar}; }
  bool overflows(std::uint32_t node) const { return pair[node].sum > kTickCeiling; }
  template <class View>
  static std::uint64_t lead(const View& view, std::uint32_t node) { return view.lead(node); }  // sums stand in the low bits
};

// Mix: ratio * peak + sum, which orders as peak_share * peak + sum_share * sum does.
struct MixLabels : PartialLabels {
  double ratio;
  static constexpr std::uint64_t kFarKey = std::numeric_limits<std::uint64_t>::max();
  std::uint64_t key_of(Label label) const {
    return label.sum == kFar ? kFarKey : static_cast<std::uint64_t>(ratio * label.peak) + label.sum;
  }
  std::uint64_t key(std::uint32_t node) const { return key_of(pair[node]); }
};

// Power: the sum of (edge / unit)^p. Positive doubles order as their bits do.
struct PowerLabels {
  double* sum;
  double power;
  double unit_per_tick;
  using Label = double;
  static constexpr bool kCostly = true;
  const void* place(std::uint32_t node) const { return sum + node; }
  static std::uint64_t key_of(Label label) { return std::bit_cast<std::uint64_t>(label); }
  std::uint64_t key(std::uint32_t node) const { return key_of(sum[node]); }
  Label extended(std::uint32_t node, const Edge& edge) const { return sum[node] + std::pow(edge.full * unit_per_tick, power); }
  void set(std::uint32_t node, Label label) { sum[node] = label; }
  void clear(std::uint32_t node) { sum[node] = std::numeric_limits<double>::infinity(); }
  static bool overflows(std::uint32_t) { return false; }
  template <class View>
  static std::uint64_t lead(const View&, std::uint32_t) { return 0; }
};

}  // namespace ramify
