// SPDX-License-Identifier: GPL-3.0-or-later
// One step of a lattice per node, as small as it can be.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace ramify {

// What stands in place of a step.
inline constexpr std::uint8_t kSource = 253;     // the node is a source
inline constexpr std::uint8_t kForbidden = 254;  // no path may use the node
inline constexpr std::uint8_t kUnreached = 255;

// Two steps in a byte, the even node's in its low half. The three values above keep their low halves, so there may be
// at most 13 steps. `bytes` must outlive the view.
class PackedSteps {
 public:
  static constexpr int kMostSteps = kSource & 15;
  explicit PackedSteps(std::uint8_t* bytes) : bytes_(bytes) {}

  class Place {
   public:
    Place(std::uint8_t* byte, int shift) : byte_(byte), shift_(shift) {}
    operator std::uint8_t() const { return decoded(*byte_ >> shift_ & 15); }
    Place& operator=(std::uint8_t step) {
      *byte_ = static_cast<std::uint8_t>((*byte_ & (0xF0 >> shift_)) | ((step & 15) << shift_));
      return *this;
    }

   private:
    std::uint8_t* byte_;
    int shift_;
  };
  Place operator[](std::size_t node) const { return {bytes_ + node / 2, static_cast<int>(node & 1) * 4}; }
  static std::uint8_t decoded(int half) { return static_cast<std::uint8_t>(half < kMostSteps ? half : half | 0xF0); }

 private:
  std::uint8_t* bytes_;
};

// A step for each node of a lattice: half a byte a node where the lattice has at most 13 steps, else a byte.
class StepArray {
 public:
  StepArray() = default;
  // All unreached. `steps`: of the lattice's connectivity.
  StepArray(std::size_t count, int steps);

  std::size_t size() const { return count_; }
  bool empty() const { return count_ == 0; }
  std::uint8_t operator[](std::size_t node) const {
    return packed_ ? PackedSteps::decoded(bytes_[node / 2] >> (node & 1) * 4 & 15) : bytes_[node];
  }
  void set(std::size_t node, std::uint8_t step);
  friend bool operator==(const StepArray&, const StepArray&) = default;

  // For code that knows the number of steps.
  PackedSteps halves() { return PackedSteps(bytes_.data()); }
  std::uint8_t* bytes() { return bytes_.data(); }

 private:
  std::size_t count_ = 0;
  bool packed_ = false;
  std::vector<std::uint8_t> bytes_;
};

}  // namespace ramify
