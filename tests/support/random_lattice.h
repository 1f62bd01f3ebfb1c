// SPDX-License-Identifier: GPL-3.0-or-later
// Lattices for the tests of plans.
#pragma once

#include "ramify/core/random.h"
#include "ramify/graph/lattice.h"

namespace ramify {

inline RealWeights random_weights(int count, Rng& rng) {
  RealWeights out(static_cast<std::size_t>(count));
  for (float& w : out) w = static_cast<float>(rng.uniform(0.5, 12.0));
  return out;
}

// A lattice with weights of any kind, now and then with forbidden nodes and dear directions.
inline Lattice random_lattice(Rng& rng, Connectivity connectivity) {
  Lattice lattice;
  lattice.connectivity = connectivity;
  const bool plane = connectivity == Connectivity::Plane4 || connectivity == Connectivity::Plane8;
  lattice.width = 5 + rng.below(plane ? 30 : 8);
  lattice.height = 5 + rng.below(plane ? 30 : 8);
  lattice.depth = plane ? 1 : 3 + rng.below(6);
  lattice.edge_cost = rng.below(2) ? EdgeCost::Mean : EdgeCost::Target;
  lattice.diagonal = rng.below(2) ? DiagonalLength::Geometric : DiagonalLength::None;
  switch (rng.below(4)) {
    case 0: lattice.weights = random_weights(lattice.count(), rng); break;
    case 1: {
      WholeWeights w(static_cast<std::size_t>(lattice.count()));
      for (auto& v : w) v = static_cast<std::uint16_t>(1 + rng.below(4));  // many ties
      lattice.weights = w;
      break;
    }
    default: lattice.weights = HashedWeights{rng.next(), 1.0, 10.0, rng.below(2) == 0};
  }
  if (rng.below(2)) {
    lattice.allowed.assign(static_cast<std::size_t>(lattice.count()), 1);
    for (auto& a : lattice.allowed) a = rng.uniform() < 0.85;
  }
  if (rng.below(4) == 0) {
    lattice.direction_factor.assign(lattice_steps(connectivity).size(), 1.0);
    lattice.direction_factor[3] = 4.0;
  }
  return lattice;
}

inline int random_node(const Lattice& lattice, Rng& rng) {
  int node = rng.below(lattice.count());
  while (!is_allowed(lattice, node)) node = rng.below(lattice.count());
  return node;
}

}  // namespace ramify
