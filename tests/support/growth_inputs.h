// SPDX-License-Identifier: GPL-3.0-or-later
// Styles and canvases for tests of growth.
#pragma once

#include "ramify/growth/grow.h"
#include "support/wavy_tree.h"

namespace ramify::test {

inline Style style_of(const WavyTree& tree, std::uint64_t seed) {
  return learn_style(wavy_tree(tree, seed), LearnStyleOptions{}, Monitor{});
}

inline GrowthTarget canvas(int width, int height) {
  GrowthTarget target;
  target.size = {width, height};
  return target;
}

inline WavyTree dense_tree() {
  WavyTree tree;
  tree.children = 14;
  tree.radius = 4.0;
  return tree;
}

}  // namespace ramify::test
