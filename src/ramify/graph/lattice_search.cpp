// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/graph/lattice_search.h"

#include <algorithm>
#include <cmath>

namespace ramify {
namespace {

template <class T>
WeightRange range_of(const std::vector<T>& weights, const std::vector<std::uint8_t>& allowed) {
  T least = std::numeric_limits<T>::max(), most = 0;
  double sum = 0.0, count = 0.0;
  for (std::size_t i = 0; i < weights.size(); ++i) {
    const T w = weights[i];
    if (!(w > T(0)) || !std::isfinite(static_cast<double>(w)) || (!allowed.empty() && !allowed[i])) continue;
    least = std::min(least, w);
    most = std::max(most, w);
    sum += w;
    count += 1.0;
  }
  if (count == 0.0) return {};
  return {static_cast<double>(least), static_cast<double>(most), sum / count};
}

}  // namespace

WeightRange weight_range(const Lattice& lattice) {
  if (const auto* w = std::get_if<WholeWeights>(&lattice.weights)) return range_of(*w, lattice.allowed);
  if (const auto* w = std::get_if<RealWeights>(&lattice.weights)) return range_of(*w, lattice.allowed);
  const HashedWeights& w = std::get<HashedWeights>(lattice.weights);
  return {w.base, w.base + w.spread, w.base + 0.5 * w.spread};
}

double dearest_edge(const Lattice& lattice, const WeightRange& weights) {
  double dearest = 0.0;
  const auto steps = lattice_steps(lattice.connectivity);
  for (std::size_t k = 0; k < steps.size(); ++k) {
    const LatticeStep& s = steps[k];
    const double factor = lattice.direction_factor.empty() ? 1.0 : lattice.direction_factor[k];
    const double length = lattice.diagonal == DiagonalLength::None ? 1.0 : std::sqrt(s.dx * s.dx + s.dy * s.dy + s.dz * s.dz);
    dearest = std::max(dearest, weights.most * factor * length);
  }
  return dearest;
}

}  // namespace ramify
