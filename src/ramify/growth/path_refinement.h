// SPDX-License-Identifier: GPL-3.0-or-later
// Paths planned again on a finer lattice that covers only the nodes they used (Xu & Mould 2007, section 3.1).
#pragma once

#include "ramify/core/monitor.h"
#include "ramify/core/random.h"
#include "ramify/growth/dendrite.h"

namespace ramify {

// Replaces the dendrite by one on a lattice options.refine times as fine. All paths share one fine lattice, so what they
// shared stays shared; with options.refine_each every path is planned in its own nodes, as in the paper, and where that
// would make two cross, one turns aside and joins the other (path_forest.h). Endpoints and roots stay at the middle of their nodes.
void refine_dendrite(Dendrite& dendrite, const DendriteOptions& options, Rng rng, const Monitor& monitor);

}  // namespace ramify
