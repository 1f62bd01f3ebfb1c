// SPDX-License-Identifier: GPL-3.0-or-later
// Counter-based random numbers: Philox4x32-10 (Salmon et al. 2011, "Parallel random numbers: as easy as 1, 2, 3").
//
// A generator is a small value. Independent streams come from naming what they are for, never from adding loop
// counters to seeds: rng.child("placement", fragment). So a result depends neither on the number of threads nor on the
// order in which objects are visited. The draws are our own (std:: distributions differ between libraries).
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

namespace ramify {

class Rng {
 public:
  explicit Rng(std::uint64_t seed = 0) : key_(seed) {}

  // An independent stream for one object of one stage. Does not change this generator.
  Rng child(std::string_view stage, std::uint64_t object = 0) const;

  std::uint32_t next();                        // uniform over all 32-bit values
  double uniform();                            // [0, 1), 53 bits
  double uniform(double low, double high);     // [low, high)
  double normal();                             // mean 0, standard deviation 1
  int below(int count);                        // 0 … count-1, unbiased; count >= 1
  // Index drawn with probability proportional to the weight; negative and NaN weights count as 0. If none is positive,
  // uniform over all. weights must not be empty.
  int discrete(std::span<const double> weights);
  template <class T>
  void shuffle(std::vector<T>& items) {
    for (int i = static_cast<int>(items.size()) - 1; i > 0; --i) std::swap(items[i], items[below(i + 1)]);
  }

 private:
  void refill();

  std::uint64_t key_ = 0;
  std::uint64_t stream_ = 0;
  std::uint64_t counter_ = 0;
  std::array<std::uint32_t, 4> block_{};
  int left_ = 0;
};

// One Philox4x32-10 block; exposed for the known-answer test.
std::array<std::uint32_t, 4> philox4x32(std::array<std::uint32_t, 4> counter, std::array<std::uint32_t, 2> key);

// A uniform number in [0, 1) that depends only on its arguments: for weights of pixels and edges that must be the same
// wherever they are asked for.
double hash01(std::uint64_t seed, std::uint64_t a, std::uint64_t b = 0, std::uint64_t c = 0);

}  // namespace ramify
