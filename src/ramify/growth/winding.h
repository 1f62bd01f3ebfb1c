// SPDX-License-Identifier: GPL-3.0-or-later
// How far a branch winds. Bends that are each like the exemplar's may add up to a loop it never makes: the sum of the turns
// within a stretch stays within the exemplar's own.
#pragma once

#include "ramify/growth/growing_branch.h"
#include "ramify/style/hierarchy.h"

namespace ramify {

class WindingBound {
 public:
  // Looks at the branch as it is now; it must stay alive and unchanged.
  WindingBound(const Hierarchy& learnt, const GrowingBranch& branch);

  // Whether the branch, grown on by the extension, winds more than any branch of the exemplar within as many edges.
  bool exceeded_by(const Extension& extension) const;

 private:
  const Hierarchy& learnt_;
  std::vector<double> least_, most_;  // rad: of the sums of the branch's last 0..q turns
};

}  // namespace ramify
