// SPDX-License-Identifier: GPL-3.0-or-later
// What a traced annotation is freed of before it is handed out: stubs, jumps of the radius, needless points.
#pragma once

#include "ramify/exemplar/annotation.h"

namespace ramify {

// Without tips hardly longer than they are wide: knots of a glowing branch, and the other strand where two lie side by
// side. No side branch is thicker than its parent while it is short for its width: there the probe met the parent's
// banks.
Annotation without_stubs(const Annotation& full);

// Single wide readings beside junctions and knots are not the branch's width: radii may leave the median of their
// neighbourhood by a third only.
void calm_radii(Annotation& annotation);

// Points about half a radius apart; junctions, links and ends stay.
Annotation thinned_out(const Annotation& full);

}  // namespace ramify
