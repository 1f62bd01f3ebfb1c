// SPDX-License-Identifier: GPL-3.0-or-later
// print_plan METRIC POWER PEAK_SHARE < lattice: plans on a lattice given as text and prints what each node costs, for
// compare_plan.py. The text: width height depth neighbours(4|8|6|26) mean|target geometric|none whole|real|hashed, then the
// weights (hashed: seed base spread, and the weights are printed first), then the number of sources and the sources.
#include <cstdio>
#include <iostream>
#include <string>

#include "ramify/graph/plan.h"

using namespace ramify;

namespace {

Lattice read_lattice() {
  Lattice lattice;
  int neighbors = 0;
  std::string edge, diagonal, kind;
  std::cin >> lattice.width >> lattice.height >> lattice.depth >> neighbors >> edge >> diagonal >> kind;
  lattice.connectivity = neighbors == 4   ? Connectivity::Plane4
                         : neighbors == 8 ? Connectivity::Plane8
                         : neighbors == 6 ? Connectivity::Volume6
                                          : Connectivity::Volume26;
  lattice.edge_cost = edge == "mean" ? EdgeCost::Mean : EdgeCost::Target;
  lattice.diagonal = diagonal == "geometric" ? DiagonalLength::Geometric : DiagonalLength::None;
  if (kind == "hashed") {
    HashedWeights weights;
    std::cin >> weights.seed >> weights.base >> weights.spread;
    lattice.weights = weights;
    for (int i = 0; i < lattice.count(); ++i) std::printf("%.17g\n", node_weight(lattice, i));
    return lattice;
  }
  RealWeights real(static_cast<std::size_t>(lattice.count()));
  for (float& w : real) std::cin >> w;
  if (kind == "whole") {
    lattice.weights = WholeWeights(real.begin(), real.end());
  } else {
    lattice.weights = real;
  }
  return lattice;
}

}  // namespace

int main(int, char** argv) {
  PlanOptions options;
  for (OptionField& field : describe(options.metric)) {
    if (field.name == "metric") set_text(field, argv[1]);
    if (field.name == "power") set_text(field, argv[2]);
    if (field.name == "peak-share") set_text(field, argv[3]);
  }
  const Lattice lattice = read_lattice();
  int count = 0;
  std::cin >> count;
  std::vector<int> sources(static_cast<std::size_t>(count));
  for (int& s : sources) std::cin >> s;
  const Plan plan = plan_paths(lattice, sources, options);
  for (int i = 0; i < lattice.count(); ++i) std::printf("%.17g\n", path_cost(plan, i));
}
