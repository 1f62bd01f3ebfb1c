// SPDX-License-Identifier: GPL-3.0-or-later
// Finds the stretches of the exemplar that look like the last vertices of a growing branch (paper 002, section 4.2), all
// at once: the squared difference to every window, plain and mirrored, by one sliding correlation.
#pragma once

#include <vector>

#include "ramify/growth/growing_branch.h"
#include "ramify/style/bending.h"

namespace ramify {

// The log of Q for a window that ends at every exemplar vertex; -infinity where the window is not legal: it lies in one
// branch, has at least min(history of the branch, m) vertices and at least `ahead` vertices follow.
struct WindowQualities {
  std::vector<float> plain;
  std::vector<float> mirrored;
};

class WindowMatcher {
 public:
  explicit WindowMatcher(const BendingModel& model);

  // Compares the last k + 1 nodes of the branch (fewer when it has fewer, or the exemplar's branch has).
  void match(const GrowingBranch& branch, int ahead, bool raw, WindowQualities& out) const;

  // From an exemplar vertex to the one `count` further on, px, in the frame of the edge that leads to it (of the edge that
  // leads on where `from_start`): x ahead, y clockwise. count <= following(vertex).
  Vec2 displacement(int vertex, int count, bool from_start) const;

  // Vertices that follow an exemplar vertex in its branch.
  int following(int vertex) const { return after_[static_cast<std::size_t>(vertex)]; }

 private:

  const BendingModel& model_;
  int pad_;                         // zeros between branches, so that windows never mix two
  std::vector<int> place_;          // vertex -> padded index
  std::vector<int> in_branch_;      // vertex -> index within its branch
  std::vector<int> after_;          // vertex -> vertices that follow in its branch
  std::vector<Vec2> along_;         // vertex -> unit vector of the edge that leads to it
  std::vector<float> alpha_;        // padded
  std::vector<float> radius_;       // padded
  std::vector<double> alpha_sums_;  // of squares over vertices, prefix
  std::vector<double> radius_sums_;
};

}  // namespace ramify
