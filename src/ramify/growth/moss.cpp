// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/growth/moss.h"

#include <algorithm>
#include <cmath>

#include "ramify/core/error.h"
#include "ramify/core/parallel.h"
#include "ramify/growth/dendrite.h"

namespace ramify {

std::vector<OptionField> describe(MossOptions& o) {
  return {
      number("height", o.height, 2.0, 1000.0, "px", "Of the longest hairs."),
      number("rows", o.rows, 1.0, 1000.0, "px", "From one row of hairs to the next."),
      number("hairs", o.density, 0.001, 2.0, "1/px", "Hairs on every px of a row."),
      number("roughness", o.roughness, 0.0, 1e6, "", "Random share of the lattice's weights: small is straight, large curly."),
      number("shadow", o.shadow, 0.0, 10.0, "", "How much each hair above takes of the light: kappa of exp(-kappa n)."),
      number("hair-radius", o.thickness, 0.05, 100.0, "px", "Where a hair stands; its tip has half of it."),
  };
}

int moss_headroom(const MossOptions& options) { return static_cast<int>(std::ceil(options.height)) + 1; }

namespace {

// exp(-kappa n) for every node, n = hairs that pass above it, in its own column and, half as much, those beside.
ScalarImage light_in(const Lattice& lattice, const PathForest& forest, double kappa) {
  ScalarImage above(lattice.width, lattice.height, 0.0f);
  for (const int node : forest.nodes) {
    const int x = node % lattice.width, y = node / lattice.width + 1;
    if (y >= lattice.height) continue;
    for (int side = -1; side <= 1; ++side) {
      if (above.contains(x + side, y)) above(x + side, y) += side == 0 ? 0.5f : 0.25f;
    }
  }
  for (int y = 1; y < lattice.height; ++y) {
    for (int x = 0; x < lattice.width; ++x) above(x, y) += above(x, y - 1);
  }
  for (float& value : above.pixels()) value = std::exp(static_cast<float>(-kappa) * value);
  return above;
}

std::vector<MossHair> grow_row(const ColorImage& picture, int ground, const MossOptions& options, Rng rng) {
  const int height = moss_headroom(options);
  DendriteTarget target;
  target.lattice.width = picture.width();
  target.lattice.height = height;
  target.lattice.weights = HashedWeights{rng.child("lattice").next(), 1.0, options.roughness, false};
  for (int x = 0; x < picture.width(); ++x) target.generators.push_back(target.lattice.node(x, height - 1));
  DendriteOptions grow;
  grow.placement = EndpointPlacement::Moss;
  grow.endpoints = std::max(1, static_cast<int>(std::lround(options.density * picture.width())));
  grow.distance = options.height;
  grow.spacing = 0.5;
  const Dendrite dendrite = grow_dendrite(std::move(target), grow, rng.child("hairs"), {});
  const PathForest& forest = dendrite.structure.forest;
  const ScalarImage light = light_in(dendrite.lattice, forest, options.shadow);
  std::vector<MossHair> hairs(static_cast<std::size_t>(forest.path_count));
  std::vector<int> root(forest.nodes.size());
  for (std::size_t i = 0; i < forest.nodes.size(); ++i) {
    const int parent = forest.parents[i];
    root[i] = parent == kNone ? forest.nodes[i] % picture.width() : root[static_cast<std::size_t>(parent)];
    MossHair& hair = hairs[static_cast<std::size_t>(forest.paths[i])];
    const auto append = [&](int node) {
      const int x = node % picture.width(), y = node / picture.width();
      hair.points.emplace_back(x, y + ground + 1);
      hair.light.push_back(light(x, y));
    };
    if (hair.points.empty() && parent != kNone) append(forest.nodes[static_cast<std::size_t>(parent)]);
    append(forest.nodes[i]);
    hair.color = picture(root[i], ground);
  }
  for (MossHair& hair : hairs) {
    const double last = std::max<double>(1.0, static_cast<double>(hair.points.size()) - 1.0);
    for (std::size_t i = 0; i < hair.points.size(); ++i) hair.radii.push_back(options.thickness * (1.0 - 0.5 * static_cast<double>(i) / last));
  }
  return hairs;
}

}  // namespace

std::vector<MossHair> grow_moss(const ColorImage& picture, const MossOptions& options, const Rng& rng, const Monitor& monitor) {
  if (picture.empty()) throw InputError("the picture", "is empty");
  MossOptions checked = options;
  check_options(describe(checked));
  const int rows = std::max(1, static_cast<int>(std::ceil(picture.height() / options.rows)));
  std::vector<std::vector<MossHair>> grown(static_cast<std::size_t>(rows));
  parallel_for(rows, [&](int row) {
    monitor.check();
    const int ground = std::min(picture.height() - 1, static_cast<int>((row + 0.5) * options.rows));
    grown[static_cast<std::size_t>(row)] = grow_row(picture, ground, options, rng.child("row", static_cast<std::uint64_t>(row)));
  });
  std::vector<MossHair> out;
  for (std::vector<MossHair>& row : grown) {
    for (MossHair& hair : row) out.push_back(std::move(hair));
  }
  return out;
}

}  // namespace ramify
