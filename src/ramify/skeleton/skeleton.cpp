// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/skeleton/skeleton.h"

#include <cmath>
#include <stdexcept>
#include <string>

namespace ramify {
namespace {

// What is wrong with a node at `index`, or nullptr.
const char* fault(const Node& node, int index) {
  if (node.parent != kNone && (node.parent < 0 || node.parent >= index)) return "its parent is not an earlier node";
  if (!node.position.allFinite()) return "its position is not finite";
  if (!(node.radius > 0.0) || !std::isfinite(node.radius)) return "its radius is not positive";
  return nullptr;
}

}  // namespace

int Skeleton::append(const Node& node) {
  const int index = count();
  if (const char* why = fault(node, index)) throw std::invalid_argument("node " + std::to_string(index) + ": " + why);
  nodes_.push_back(node);
  return index;
}

void Skeleton::set_radius(int index, double radius) {
  if (!(radius > 0.0) || !std::isfinite(radius)) throw std::invalid_argument("Skeleton: the radius must be positive");
  nodes_[static_cast<std::size_t>(index)].radius = radius;
}

void Skeleton::set_position(int index, const Vec3& position) {
  if (!position.allFinite()) throw std::invalid_argument("Skeleton: the position must be finite");
  nodes_[static_cast<std::size_t>(index)].position = position;
}

void Skeleton::check() const {
  for (int i = 0; i < count(); ++i) {
    if (const char* why = fault((*this)[i], i)) throw std::logic_error("node " + std::to_string(i) + ": " + why);
  }
  for (const auto& [a, b] : loop_links) {
    if (a < 0 || b < 0 || a >= count() || b >= count() || a == b) {
      throw std::logic_error("loop link " + std::to_string(a) + "-" + std::to_string(b) + " names no two nodes");
    }
  }
}

}  // namespace ramify
