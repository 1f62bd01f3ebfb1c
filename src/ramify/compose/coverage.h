// SPDX-License-Identifier: GPL-3.0-or-later
// Do the placed fragments show branch wherever there is one? A fork of two thick branches has no like in many photos:
// what was cut around a creek's fork is mostly ground, however it is turned, and would tear the river.
#pragma once

#include <vector>

#include "ramify/compose/placement.h"

namespace ramify {

// Share of the target's own branches within its disc, 1 px off their edges, that the placement does not show as branch:
// it shows ground there, or the photo has nothing to copy. 0 … 1.
double measure_torn_share(const FragmentLibrary& library, const PlacementPlan& plan, const Placement& placement);

// More targets, for what no placement shows: discs along the branch, or between its banks where it is wide. Empty when
// all branches are shown. wide_radius as in FragmentOptions.
std::vector<Fragment> cover_bare_places(const FragmentLibrary& library, const PlacementPlan& plan,
                                        const FragmentOptions& options);

}  // namespace ramify
