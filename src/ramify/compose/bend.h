// SPDX-License-Identifier: GPL-3.0-or-later
// The map from a target disc to the photo that makes the source's branch run exactly where the target's does.
#pragma once

#include "ramify/compose/candidate.h"

namespace ramify {

// Rigid map plus a thin plate through three rows (centre line and both edges, so that widths match too), held by eight
// anchors around the disc and damped where it would fold (PICTURES 12.1-5, ALGORITHMS 5.5); or as the options say.
WarpGrid bend_fragment(const Fragment& source, const Fragment& target, const SourceCandidate& candidate,
                       const PlacementOptions& options);

}  // namespace ramify
