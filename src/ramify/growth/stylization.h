// SPDX-License-Identifier: GPL-3.0-or-later
// Dendritic stylization (Long & Mould 2009, "Dendritic stylization", section 4): a picture told by one dendrite whose
// paths run along what is important and end where much of it lies.
#pragma once

#include <optional>
#include <vector>

#include "ramify/core/monitor.h"
#include "ramify/core/options.h"
#include "ramify/core/random.h"
#include "ramify/graph/lattice.h"
#include "ramify/graph/metric.h"
#include "ramify/graph/stipple.h"
#include "ramify/growth/dendrite.h"
#include "ramify/image/image.h"
#include "ramify/skeleton/skeleton.h"

namespace ramify {

struct StylizeOptions {
  MetricOptions metric{Metric::Partial};
  int endpoints = 3000;
  double constant = 0.02;      // cost every node has
  double noise = 0.2;          // random cost. The paper uses very little; with more, flat ground is told by winding lines
                               // instead of straight ones along the lattice, and edges hold just as well
  double least = 0.0;          // 0..1: no endpoint where importance is below, so light ground stays empty
  double upward = 1.0;         // steps up cost so many times as much: 4 for lightning
  double sideways = 1.0;       // steps to the side: 2 for lightning
};
std::vector<OptionField> describe(StylizeOptions& options);

struct ImportanceThickness {
  double thin = 0.3;           // px, radius where nothing is important
  double thick = 2.0;          // px, radius where everything is
  int window = 15;             // nodes on either side in the rolling mean of importance; beyond a tip counts as 0
};
std::vector<OptionField> describe(ImportanceThickness& options);

// Lattice::direction_factor for growth that goes up or to the side at a price: lightning (section 4.5).
std::vector<double> growth_direction_factors(Connectivity connectivity, double upward, double sideways);

// The lattice with a node for every pixel, dear where little is important: constant + (1 - importance) + noise * u,
// with eight neighbours and edges that cost the mean of their nodes (section 4.1). allowed: empty, or 0 = forbidden.
Lattice importance_lattice(const ScalarImage& importance, const Mask& allowed, const StylizeOptions& options, Rng rng);

// The node nearest to a point (px) on the main lines: the first piece of a tenth of all nodes that hangs together when nodes
// come in by rising weight (8 neighbours). From such a root the dearest step on the way to any other place on these lines is
// as cheap as can be. From a root on dear ground every path has the same dearest step, the one that leaves that ground, and
// the partial metric is left with its sums (docs/decisions/0050). Weights must be whole. O(n log n). Throws InputError when
// nothing is allowed.
int main_line_node(const Lattice& lattice, const Vec2& near);

struct Stylization {
  Dendrite dendrite;
  std::vector<int> endpoints;  // nodes, in the order they were set
  StippleOptions stipples;     // what set them, with `threshold`
  double threshold = 0.0;
};

// root: the seed of the dendrite, px; empty = on the main lines, near the middle, or the middle of the top where upward steps
// are dear. Deterministic in (inputs, rng). Throws
// InputError when the picture is empty, the root is forbidden or no endpoint can be reached from it.
Stylization stylize(const ScalarImage& importance, const Mask& allowed, std::optional<Vec2> root, const StylizeOptions& options,
                    Rng rng, const Monitor& monitor);

// Radii by the rolling mean of importance along every branch (section 4.3): a skeleton of pixel positions keeps its shape.
// A branch's window runs on into its parent at the base and past its end at the tip.
Skeleton emphasize(const Skeleton& skeleton, const ScalarImage& importance, const ImportanceThickness& options);

}  // namespace ramify
