// SPDX-License-Identifier: GPL-3.0-or-later
// The definition of search_lattice, instantiated by search_plane.cpp and search_volume.cpp: the views of all kinds of
// weights times the metrics are much code. Private to the layer.
#pragma once

#include "ramify/graph/lattice_search.h"
#include "ramify/graph/lattice_view.h"
#include "ramify/graph/run_second.h"

namespace ramify {

template <int kSteps>
auto links_of(StepArray& steps) {
  if constexpr (kSteps <= PackedSteps::kMostSteps) {
    return steps.halves();
  } else {
    return steps.bytes();
  }
}

// Calls f(view, least, most) with the view of the lattice's weights in the plan's ticks, and the range of their halves.
template <int kSteps, class F>
SearchEnd with_view(const Lattice& lattice, const Plan& plan, const WeightRange& weights, const F& f) {
  const double half_ticks = plan.ticks_per_unit / 2.0;
  const auto call = [&](const auto& ticks, std::uint32_t least_half, std::uint32_t most_half) {
    return f(LatticeView<kSteps, std::decay_t<decltype(ticks)>>(lattice, ticks, plan.step), least_half, most_half);
  };
  if (const auto* whole = std::get_if<WholeWeights>(&lattice.weights)) {
    const WholeTicks ticks{whole->data(), static_cast<std::uint32_t>(half_ticks)};
    return call(ticks, ticks.half_of(weights.least), ticks.half_of(weights.most));
  }
  if (const auto* real = std::get_if<RealWeights>(&lattice.weights)) {
    const RealTicks ticks{real->data(), static_cast<float>(half_ticks)};
    return call(ticks, ticks.half_of(weights.least), ticks.half_of(weights.most));
  }
  const HashedWeights& hashed = std::get<HashedWeights>(lattice.weights);
  const auto base = static_cast<std::uint32_t>(std::max(1.0, std::round(hashed.base * half_ticks)));
  const auto spread = static_cast<std::uint32_t>(hashed.spread * half_ticks);
  if (hashed.per_edge) return call(HashedTicks<true>{hashed.seed, base, spread}, base, base + spread);
  return call(HashedTicks<false>{hashed.seed, base, spread}, base, base + spread);
}

template <int kSteps>
SearchEnd search_lattice(const Lattice& lattice, Plan& plan, SearchTask task, const WeightRange& weights, const Monitor& monitor) {
  return with_view<kSteps>(lattice, plan, weights, [&](const auto& view, std::uint32_t least_half, std::uint32_t most_half) {
    task.bounds = view.bounds(least_half, most_half);
    return run_search(view, plan, links_of<kSteps>(plan.step), task, monitor);
  });
}

template <int kSteps>
SearchEnd search_lattice_again(const Lattice& lattice, const Plan& plan, const WeightRange& weights, TwoNearest& nearest, const Monitor& monitor) {
  return with_view<kSteps>(lattice, plan, weights, [&](const auto& view, std::uint32_t least_half, std::uint32_t most_half) {
    StepArray way = plan.step;
    return run_second(view, plan, links_of<kSteps>(way), view.bounds(least_half, most_half).cheapest, nearest, monitor);
  });
}

}  // namespace ramify
