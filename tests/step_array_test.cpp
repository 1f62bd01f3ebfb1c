// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/graph/step_array.h"

#include <catch2/catch.hpp>

#include "ramify/core/random.h"

using namespace ramify;

TEST_CASE("an array of steps holds what plain bytes hold") {
  Rng rng(1);
  for (const int steps : {4, 8, PackedSteps::kMostSteps, 26}) {
    for (const std::size_t count : {1, 2, 777}) {
      StepArray array(count, steps);
      std::vector<std::uint8_t> plain(count, kUnreached);
      for (int i = 0; i < 5000; ++i) {
        const auto node = static_cast<std::size_t>(rng.below(static_cast<int>(count)));
        const int drawn = rng.below(steps + 3);
        const auto step = static_cast<std::uint8_t>(drawn < steps ? drawn : kSource + drawn - steps);
        plain[node] = step;
        array.set(node, step);
        const auto other = static_cast<std::size_t>(rng.below(static_cast<int>(count)));
        REQUIRE(array[other] == plain[other]);
      }
      REQUIRE(array.size() == count);
      for (std::size_t node = 0; node < count; ++node) REQUIRE(array[node] == plain[node]);
    }
  }
}
