// SPDX-License-Identifier: GPL-3.0-or-later
// Synthetic branching skeletons for tests of style and growth: wavy branches with children on both sides.
#pragma once

#include <cmath>

#include "ramify/core/random.h"
#include "ramify/skeleton/skeleton.h"

namespace ramify::test {

struct WavyTree {
  Size size{600, 400};         // px
  Vec2 root{20.0, 200.0};      // px
  double direction = 0.0;      // rad
  double length = 520.0;       // px, of the main branch
  double radius = 5.0;         // px, at its base
  double wave = 0.5;           // rad, amplitude of the direction's swing
  double wavelength = 60.0;    // px
  int children = 8;            // per branch
  int orders = 3;
};

// Adds one branch of 2 px steps and its children; random phases, lengths and sides.
inline void add_wavy_branch(Skeleton& skeleton, const WavyTree& tree, int parent, double direction, double length,
                            double radius, int order, Rng& rng) {
  const int first = skeleton.count(), steps = static_cast<int>(length / 2.0);
  const double phase = rng.uniform(0.0, 2.0 * kPi);
  Vec2 point = parent == kNone ? tree.root : skeleton[parent].xy();
  for (int i = 0; i < steps; ++i) {
    const double swing = tree.wave * std::sin(2.0 * kPi * 2.0 * i / tree.wavelength + phase) + 0.05 * rng.normal();
    if (i > 0 || parent != kNone) point += 2.0 * direction_of(direction + swing);
    Node node;
    node.position = Vec3(point.x(), point.y(), 0.0);
    node.radius = std::max(0.6, radius * (1.0 - 0.7 * i / steps));
    node.parent = i > 0 ? skeleton.count() - 1 : parent;
    node.order = order;
    skeleton.append(node);
  }
  if (order + 1 >= tree.orders) return;
  for (int c = 0; c < tree.children; ++c) {
    const int at = first + static_cast<int>((c + 0.5 + 0.3 * rng.uniform(-1, 1)) * steps / (tree.children + 0.5));
    if (at <= first + 2 || at >= first + steps - 3) continue;
    const double side = rng.uniform() < 0.5 ? 1.0 : -1.0;
    add_wavy_branch(skeleton, tree, at, direction + side * rng.uniform(0.6, 1.1), length * rng.uniform(0.2, 0.4),
                    0.6 * skeleton[at].radius, order + 1, rng);
  }
}

inline Skeleton wavy_tree(const WavyTree& tree, std::uint64_t seed) {
  Skeleton skeleton(tree.size);
  Rng rng(seed);
  add_wavy_branch(skeleton, tree, kNone, tree.direction, tree.length, tree.radius, 0, rng);
  return skeleton;
}

}  // namespace ramify::test
