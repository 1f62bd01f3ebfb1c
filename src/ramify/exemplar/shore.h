// SPDX-License-Identifier: GPL-3.0-or-later
// Branches too wide for discs that hold both edges: there the two banks and the ground between them are dressed each by
// itself (PICTURES 12.1-10). Banks are the outline of all wide branches together, so where wide branches meet nothing
// special is needed.
#pragma once

#include <vector>

#include "ramify/exemplar/fragment.h"

namespace ramify {

// The outline where branches of at least `radius` px are nearest, as curves without width; the branch lies to the right.
std::vector<BranchCurve> wide_shores(const BranchField& field, double radius);

// A disc on a bank.
Fragment bank_fragment(const std::vector<BranchCurve>& shores, int shore, int vertex, double disc);

// A disc inside a wide branch, turned along it.
Fragment interior_fragment(const std::vector<BranchCurve>& curves, const BranchField& field, const Vec2& centre,
                           double disc);

}  // namespace ramify
