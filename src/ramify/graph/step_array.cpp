// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/graph/step_array.h"

#include "ramify/graph/big_array.h"

namespace ramify {

StepArray::StepArray(std::size_t count, int steps) : count_(count), packed_(steps <= PackedSteps::kMostSteps) {
  assign_big(bytes_, packed_ ? (count + 1) / 2 : count, kUnreached);
}

void StepArray::set(std::size_t node, std::uint8_t step) {
  if (packed_) {
    halves()[node] = step;
  } else {
    bytes_[node] = step;
  }
}

}  // namespace ramify
