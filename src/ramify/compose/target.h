// SPDX-License-Identifier: GPL-3.0-or-later
// The empty discs a skeleton is covered with (paper 002, section 5.1): furcations first, then every branch between them,
// so that nothing has to be deleted again (ALGORITHMS 5.4).
#pragma once

#include <vector>

#include "ramify/exemplar/fragment.h"

namespace ramify {

struct TargetOptions {
  FragmentOptions fragment;
  double spacing = 0.6;        // lambda: next centre at spacing x (sum of the two disc radii); the paper's is 0.75
  bool parent_first = false;   // paper 002: chains start at the parent, furcations are laid over them afterwards
};

struct TargetSet {
  std::vector<Fragment> fragments;
  // Of each curve: its discs from base to tip, the furcation it starts with and those it passes included.
  // After them: the discs of each bank of wide branches, and those between the banks.
  std::vector<std::vector<int>> chains;
};

// `field` belongs to the curves. Branches of at least fragment.wide_radius are covered bank by bank.
TargetSet cover_skeleton(const std::vector<BranchCurve>& curves, const BranchField& field, const TargetOptions& options);

}  // namespace ramify
