// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/growth/stylization.h"

#include <algorithm>
#include <cmath>

#include "ramify/core/error.h"
#include "ramify/graph/stipple.h"
#include "ramify/skeleton/branches.h"

namespace ramify {

std::vector<OptionField> describe(StylizeOptions& o) {
  std::vector<OptionField> out = describe(o.metric);
  const std::vector<OptionField> own{
      number("count-endpoints", o.endpoints, 1, 10000000, "", "How many endpoints: more of them tell more of the picture."),
      number("constant", o.constant, 0.001, 100.0, "", "Cost that every pixel has beside what its importance takes off."),
      number("noise", o.noise, 0.0, 100.0, "", "Random cost of pixels: every seed has its own lines, winding ones on flat ground; the paper uses 0.02."),
      number("least-importance", o.least, 0.0, 1.0, "", "No endpoint where importance is below: light ground stays empty."),
      number("upward", o.upward, 0.01, 100.0, "", "Steps up cost so many times as much; 4 for lightning."),
      number("sideways", o.sideways, 0.01, 100.0, "", "Steps to the side cost so many times as much; 2 for lightning."),
  };
  out.insert(out.end(), own.begin(), own.end());
  return out;
}

std::vector<OptionField> describe(ImportanceThickness& o) {
  return {
      number("thin", o.thin, 0.05, 1000.0, "px", "Radius where nothing is important."),
      number("thick", o.thick, 0.05, 1000.0, "px", "Radius where everything is."),
      number("window", o.window, 0, 100000, "nodes", "Nodes on either side whose importance is averaged."),
  };
}

namespace {

// Costs as whole numbers: the dearest node gets this, so that a queue of buckets can be used.
constexpr double kDearest = 1000.0;

}  // namespace

std::vector<double> growth_direction_factors(Connectivity connectivity, double upward, double sideways) {
  if (upward == 1.0 && sideways == 1.0) return {};
  std::vector<double> out;
  for (const LatticeStep& step : lattice_steps(connectivity)) out.push_back(step.dy < 0 ? upward : step.dy == 0 ? sideways : 1.0);
  return out;
}

Lattice importance_lattice(const ScalarImage& importance, const Mask& allowed, const StylizeOptions& options, Rng rng) {
  Lattice lattice;
  lattice.width = importance.width();
  lattice.height = importance.height();
  lattice.connectivity = Connectivity::Plane8;
  lattice.direction_factor = growth_direction_factors(lattice.connectivity, options.upward, options.sideways);
  if (!allowed.empty()) lattice.allowed = allowed.pixels();
  const std::uint64_t seed = rng.next();
  const double scale = kDearest / (options.constant + 1.0 + options.noise);
  WholeWeights weights(importance.pixels().size());
  for (std::size_t i = 0; i < weights.size(); ++i) {
    const double important = std::clamp(static_cast<double>(importance.pixels()[i]), 0.0, 1.0);
    const double cost = options.constant + (1.0 - important) + options.noise * hash01(seed, i);
    weights[i] = static_cast<std::uint16_t>(std::max(1.0, std::round(scale * cost)));
  }
  lattice.weights = std::move(weights);
  return lattice;
}

Stylization stylize(const ScalarImage& importance, const Mask& allowed, std::optional<Vec2> root, const StylizeOptions& options,
                    Rng rng, const Monitor& monitor) {
  if (importance.empty()) throw InputError("the picture", "is empty");
  const Vec2 seed = root ? *root : Vec2(importance.width() / 2, importance.height() / 2);
  DendriteTarget target;
  target.lattice = importance_lattice(importance, allowed, options, rng.child("weights"));
  const int start = node_at(target.lattice, {seed.x(), seed.y(), 0.0});
  if (!is_allowed(target.lattice, start)) throw InputError("the root", "lies where the mask forbids paths; place it elsewhere");
  target.generators = {start};
  StippleOptions stipples;
  stipples.seed = rng.child("stipples").next();
  target.endpoints = stipple_count(importance, allowed, target.generators, options.endpoints, stipples, monitor.stage("endpoints", 0.0, 0.7)).pixels;
  std::erase_if(target.endpoints, [&](int node) { return importance.pixels()[static_cast<std::size_t>(node)] < options.least; });
  if (target.endpoints.empty()) throw InputError("the picture", "has no room for a single endpoint; lower --least-importance");
  Stylization out;
  out.endpoints = target.endpoints;
  DendriteOptions plan;
  plan.metric = options.metric;
  out.dendrite = grow_dendrite(std::move(target), plan, rng.child("paths"), monitor.stage("paths", 0.7, 1.0));
  return out;
}

Skeleton emphasize(const Skeleton& skeleton, const ScalarImage& importance, const ImportanceThickness& options) {
  Skeleton out = skeleton;
  const auto important = [&](int node) {
    const Vec2 at = skeleton[node].xy();
    return static_cast<double>(importance.clamped(static_cast<int>(std::lround(at.x())), static_cast<int>(std::lround(at.y()))));
  };
  const int window = options.window;
  for (const Branch& branch : branch_tree(skeleton).branches) {
    // Importance along the way: up to `window` nodes of the ancestors, the branch, then nothing.
    std::vector<double> sums{0.0};
    std::vector<int> ancestors;
    for (int node = branch.parent_node; node != kNone && static_cast<int>(ancestors.size()) < window; node = skeleton[node].parent) ancestors.push_back(node);
    for (auto node = ancestors.rbegin(); node != ancestors.rend(); ++node) sums.push_back(sums.back() + important(*node));
    for (const int node : branch.nodes) sums.push_back(sums.back() + important(node));
    const int before = static_cast<int>(ancestors.size()), last = static_cast<int>(sums.size()) - 1;
    for (std::size_t i = 0; i < branch.nodes.size(); ++i) {
      const int from = std::max(0, before + static_cast<int>(i) - window), to = std::min(last, before + static_cast<int>(i) + window + 1);
      const int missing = window - (before + static_cast<int>(i) - from);  // at a root there is nothing to run into
      const double mean = (sums[static_cast<std::size_t>(to)] - sums[static_cast<std::size_t>(from)]) / (2 * window + 1 - missing);
      out.set_radius(branch.nodes[i], options.thin + (options.thick - options.thin) * std::clamp(mean, 0.0, 1.0));
    }
  }
  return out;
}

}  // namespace ramify
