// SPDX-License-Identifier: GPL-3.0-or-later
// Properties of grown skeletons, counted the plain way.
#pragma once

#include <algorithm>
#include <vector>

#include "ramify/skeleton/branches.h"
#include "ramify/skeleton/skeleton.h"

namespace ramify::test {

// Pairs of edges without a common node whose segments cross or touch: every pair is looked at.
inline int crossing_pairs(const Skeleton& s) {
  const auto side = [](const Vec2& a, const Vec2& b, const Vec2& c) { return cross(b - a, c - a); };
  int crossings = 0;
  for (int i = 0; i < s.count(); ++i) {
    if (s[i].parent == kNone) continue;
    const Vec2 a = s[i].xy(), b = s[s[i].parent].xy();
    const Vec2 low = a.cwiseMin(b), high = a.cwiseMax(b);
    for (int j = i + 1; j < s.count(); ++j) {
      if (s[j].parent == kNone || s[j].parent == i || s[i].parent == s[j].parent || s[i].parent == j) continue;
      const Vec2 c = s[j].xy(), d = s[s[j].parent].xy();
      if ((high - c.cwiseMin(d)).minCoeff() < 0 || (c.cwiseMax(d) - low).minCoeff() < 0) continue;
      crossings += side(a, b, c) * side(a, b, d) <= 0 && side(c, d, a) * side(c, d, b) <= 0;
    }
  }
  return crossings;
}

// Median over all runs of nodes copied in one piece from the exemplar (tags name the vertex, negative when mirrored).
inline int median_verbatim_run(const Skeleton& s) {
  std::vector<int> runs;
  for (const Branch& branch : branch_tree(s).branches) {
    int run = 1;
    for (std::size_t i = 1; i < branch.nodes.size(); ++i, ++run) {
      const int a = s[branch.nodes[i - 1]].tag, b = s[branch.nodes[i]].tag;
      if (a != 0 && b == a + (a > 0 ? 1 : -1)) continue;
      runs.push_back(run);
      run = 0;
    }
    runs.push_back(run);
  }
  if (runs.empty()) return 0;
  std::nth_element(runs.begin(), runs.begin() + static_cast<std::ptrdiff_t>(runs.size() / 2), runs.end());
  return runs[runs.size() / 2];
}

}  // namespace ramify::test
