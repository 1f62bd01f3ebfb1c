// SPDX-License-Identifier: GPL-3.0-or-later
// The counter hash behind HashedWeights. One round of SplitMix64's finalizer (Steele et al. 2014) over a Weyl sequence:
// it is asked for at every edge, where core's hash01 with its four rounds would cost more than the search.
#pragma once

#include <algorithm>
#include <cstdint>

namespace ramify {

inline std::uint32_t lattice_hash(std::uint64_t seed, std::uint64_t counter) {
  std::uint64_t x = seed * 0xD1342543DE82EF95ull + (counter + 1) * 0x9E3779B97F4A7C15ull;
  x = (x ^ (x >> 30)) * 0xBF58476D1CE4E5B9ull;
  x = (x ^ (x >> 27)) * 0x94D049BB133111EBull;
  return static_cast<std::uint32_t>(x >> 32);
}

// The same from both ends of an edge.
inline std::uint32_t edge_hash(std::uint64_t seed, std::uint32_t a, std::uint32_t b) {
  return lattice_hash(seed, (static_cast<std::uint64_t>(std::min(a, b)) << 32) | std::max(a, b));
}

inline double lattice_hash01(std::uint64_t seed, std::uint64_t counter) { return lattice_hash(seed, counter) * 0x1.0p-32; }
inline double edge_hash01(std::uint64_t seed, std::uint32_t a, std::uint32_t b) { return edge_hash(seed, a, b) * 0x1.0p-32; }

}  // namespace ramify
