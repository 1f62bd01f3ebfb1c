// SPDX-License-Identifier: GPL-3.0-or-later
// Dendrites by path planning (Xu & Mould 2007, "Modeling dendritic shapes using path planning"): least-cost paths through
// a lattice of random weights lead from endpoints to a set of generators; their union is the dendrite. Placing more
// endpoints ever nearer to what is there makes it fractal.
#pragma once

#include <vector>

#include "ramify/core/monitor.h"
#include "ramify/core/options.h"
#include "ramify/core/random.h"
#include "ramify/graph/lattice.h"
#include "ramify/graph/plan.h"
#include "ramify/growth/planned_skeleton.h"
#include "ramify/skeleton/skeleton.h"

namespace ramify {

// Where the endpoints of a round lie.
enum class EndpointPlacement {
  Scatter,    // anywhere, or at the round's distance from the structure
  Lightning,  // first along the bottom of the canvas, then below the strokes there are
  Moss,       // above the structure
  Aggregate   // first where walkers from far away come within the distance, as in aggregation; then scattered
};

struct DendriteTarget {
  Lattice lattice;              // of the plane: its weights, its forbidden nodes
  std::vector<int> generators;  // nodes, at least one: cost nothing; where paths start
  std::vector<int> endpoints;   // nodes; empty = placed at random; given = one round with exactly these
};

struct DendriteOptions {
  MetricOptions metric;
  EndpointPlacement placement = EndpointPlacement::Scatter;
  int endpoints = 60;          // m: of the first round
  double distance = 0.0;       // d, nodes: how far from the structure the first round's endpoints lie; 0 = anywhere
  double attenuation = 1.5;    // alpha, > 1: the distance is divided by it every round
  double branching = 3.0;      // beta, >= 1: the number of endpoints is multiplied by it every round
  int rounds = 1;              // at most so many
  double smallest = 2.0;       // epsilon, nodes: no round below this distance
  double spacing = 0.3;        // endpoints of a round keep this share of its distance between them
  int refine = 1;              // n: paths are planned again among n x n nodes for every node; 1 = not
  bool refine_each = false;    // every path by itself, as the paper does; where two would cross, they join
};
std::vector<OptionField> describe(DendriteOptions& options);

struct Dendrite {
  Lattice lattice;             // the one the structure lies on: the target's, refined when asked for
  Structure structure;
  int refine = 1;
  std::vector<int> rounds;     // endpoints placed in each round
};

// What a step of one node costs in the mean along least-cost paths, so that distances can be given in nodes.
double cost_per_node(const Lattice& lattice);

// Generators that touch are one; trees of different ones never join (competition, section 4). Deterministic in (inputs,
// rng). Endpoints that cannot be reached are left out with a note. Throws InputError when nothing
// at all can be reached or a generator is forbidden, OptionError for options out of range. O(n log n) at worst in the
// lattice's nodes for the first round, then in what lies within the distance.
Dendrite grow_dendrite(DendriteTarget target, DendriteOptions options, Rng rng, const Monitor& monitor);

struct DendriteThickness {
  double tip = 0.6;            // px, radius where a path ends
  double taper = 0.35;         // radius = tip * (endpoints above)^taper; 0 = the same everywhere
  double largest = 12.0;       // px
  double smooth = 0.0;         // px, sigma of the smoothing along branches
};
std::vector<OptionField> describe(DendriteThickness& options);

// pitch: px of the canvas from node to node of the target's lattice.
Skeleton dendrite_skeleton(const Dendrite& dendrite, double pitch, const DendriteThickness& thickness);

}  // namespace ramify
