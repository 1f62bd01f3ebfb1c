// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/growth/path_refinement.h"

#include <algorithm>
#include <string>

#include "ramify/core/error.h"

namespace ramify {
namespace {

constexpr double kMostNodes = 2147483647.0;

int fine_node(const Lattice& fine, const Lattice& coarse, int node, int n) {
  return fine.node(node % coarse.width * n + n / 2, node / coarse.width * n + n / 2);
}

void set_block(Lattice& fine, const Lattice& coarse, int node, int n, std::uint8_t value) {
  const int left = node % coarse.width * n, top = node / coarse.width * n;
  for (int y = top; y < top + n; ++y) {
    for (int x = left; x < left + n; ++x) fine.allowed[static_cast<std::size_t>(fine.node(x, y))] = value;
  }
}

// Weights of the fine nodes: hashed anew, or those of the coarse nodes times a random factor of mean 1.
Lattice fine_lattice(const Lattice& coarse, int n, std::uint64_t seed) {
  if (static_cast<double>(coarse.count()) * n * n > kMostNodes) {
    throw LimitError("the refined lattice would have more than 2^31 nodes; refine less or plan on a smaller lattice");
  }
  Lattice fine;
  fine.width = coarse.width * n;
  fine.height = coarse.height * n;
  fine.connectivity = coarse.connectivity;
  fine.edge_cost = coarse.edge_cost;
  fine.diagonal = coarse.diagonal;
  fine.cut_corners = true;  // blocks of a diagonal step touch at a corner only; the coarse lattice saw to what lies beside
  fine.direction_factor = coarse.direction_factor;
  fine.allowed.assign(static_cast<std::size_t>(fine.count()), 0);
  if (const auto* hashed = std::get_if<HashedWeights>(&coarse.weights)) {
    HashedWeights weights = *hashed;
    weights.seed = seed;
    fine.weights = weights;
  } else {
    RealWeights weights(static_cast<std::size_t>(fine.count()));
    for (int node = 0; node < fine.count(); ++node) {
      const int parent = coarse.node(node % fine.width / n, node / fine.width / n);
      const double factor = 0.2 + 1.6 * hash01(seed, static_cast<std::uint64_t>(node));
      weights[static_cast<std::size_t>(node)] = is_allowed(coarse, parent) ? static_cast<float>(node_weight(coarse, parent) * factor) : 0.0f;
    }
    fine.weights = std::move(weights);
  }
  return fine;
}

int round_of(const Structure& structure, int index) {
  return structure.rounds[static_cast<std::size_t>(structure.forest.paths[static_cast<std::size_t>(index)])];
}

Structure plan_together(const Dendrite& coarse, Lattice& fine, const PlanOptions& plan, int n, const Monitor& monitor) {
  const PathForest& forest = coarse.structure.forest;
  std::vector<int> roots;
  for (std::size_t i = 0; i < forest.nodes.size(); ++i) {
    set_block(fine, coarse.lattice, forest.nodes[i], n, 1);
    if (forest.parents[i] == kNone) roots.push_back(fine_node(fine, coarse.lattice, forest.nodes[i], n));
  }
  Structure out;
  out.forest = make_path_forest(fine.count());
  const Plan found = plan_paths(fine, roots, plan, monitor);
  for (const int end : coarse.structure.endpoints) {
    const int node = forest.nodes[static_cast<std::size_t>(end)];
    draw_paths(out, found, fine, {fine_node(fine, coarse.lattice, node, n)}, round_of(coarse.structure, end));
  }
  return out;
}

Structure plan_each(const Dendrite& coarse, Lattice& fine, const PlanOptions& plan, int n, const Monitor& monitor) {
  const PathForest& forest = coarse.structure.forest;
  Structure out;
  out.forest = make_path_forest(fine.count());
  double done = 0.0;
  for (const int end : coarse.structure.endpoints) {
    monitor.report(done++ / static_cast<double>(coarse.structure.endpoints.size()));
    std::vector<int> path;
    for (int i = end; i != kNone; i = forest.parents[static_cast<std::size_t>(i)]) path.push_back(forest.nodes[static_cast<std::size_t>(i)]);
    for (const int node : path) set_block(fine, coarse.lattice, node, n, 1);
    const std::vector<int> root{fine_node(fine, coarse.lattice, path.back(), n)};
    PlanOptions own = plan;
    own.endpoints = {fine_node(fine, coarse.lattice, path.front(), n)};
    draw_paths(out, plan_paths(fine, root, own, monitor), fine, own.endpoints, round_of(coarse.structure, end));
    for (const int node : path) set_block(fine, coarse.lattice, node, n, 0);
  }
  return out;
}

}  // namespace

void refine_dendrite(Dendrite& dendrite, const DendriteOptions& options, Rng rng, const Monitor& monitor) {
  const int n = options.refine;
  Lattice fine = fine_lattice(dendrite.lattice, n, rng.child("weights").next());
  PlanOptions plan;
  plan.metric = options.metric;
  Structure structure = (options.refine_each ? plan_each : plan_together)(dendrite, fine, plan, n, monitor);
  dendrite.lattice = std::move(fine);
  dendrite.structure = std::move(structure);
  dendrite.refine *= n;
}

}  // namespace ramify
