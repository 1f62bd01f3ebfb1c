// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/growth/dendrite.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>

#include "ramify/core/error.h"
#include "ramify/graph/second_nearest.h"
#include "ramify/growth/endpoint_placement.h"
#include "ramify/growth/far_walker.h"
#include "ramify/growth/path_refinement.h"
#include "ramify/skeleton/edit.h"

namespace ramify {

std::vector<OptionField> describe(DendriteOptions& o) {
  std::vector<OptionField> out = describe(o.metric);
  const std::vector<OptionField> own{
      choice("placement", o.placement, {"scatter", "lightning", "moss", "aggregate"},
             "Where endpoints lie: scattered, at the bottom and below the strokes, above the generator, or first where "
             "walkers from far away come within the distance."),
      number("count-endpoints", o.endpoints, 1, 10000000, "", "Endpoints of the first round: m of the paper."),
      number("distance", o.distance, 0.0, 1e6, "nodes",
             "How far from the structure the first round's endpoints lie; 0 = anywhere."),
      number("attenuation", o.attenuation, 1.01, 100.0, "", "The distance is divided by it every round: alpha."),
      number("branching", o.branching, 1.0, 100.0, "",
             "The number of endpoints is multiplied by it every round: beta."),
      number("rounds", o.rounds, 1, 1000, "", "At most so many rounds; more than one makes it fractal."),
      number("smallest", o.smallest, 0.5, 1e6, "nodes", "No round places endpoints nearer than this: epsilon."),
      number("spacing", o.spacing, 0.0, 10.0, "", "Endpoints of a round keep this share of its distance between them."),
      number("refine", o.refine, 1, 64, "", "Plan again among n x n nodes for every node of the dendrite; 1 = not."),
      flag("refine-each", o.refine_each,
           "Refine every path by itself, as the paper does: paths part and meet more often; where two would cross, "
           "they join."),
  };
  out.insert(out.end(), own.begin(), own.end());
  return out;
}

std::vector<OptionField> describe(DendriteThickness& o) {
  return {
      number("tip-radius", o.tip, 0.05, 1000.0, "px", "Radius where a path ends."),
      number("taper", o.taper, 0.0, 2.0, "", "Radius grows with the endpoints above to this power; 0 = the same everywhere."),
      number("largest-radius", o.largest, 0.05, 10000.0, "px", "No branch gets thicker."),
      number("smooth", o.smooth, 0.0, 1000.0, "px", "Smooth along the branches; takes the lattice's steps out."),
  };
}

// Paths find the cheap nodes: measured on 512 x 512 nodes of random weights, they pay 0.26 of the spread where nodes have
// eight neighbours, and walk corners where they have four.
double cost_per_node(const Lattice& lattice) {
  const double share = 0.26, corners = lattice.connectivity == Connectivity::Plane4 ? 1.2 : 1.0;
  if (const auto* hashed = std::get_if<HashedWeights>(&lattice.weights)) return corners * (hashed->base + share * hashed->spread);
  double sum = 0.0;
  int count = 0;
  for (int node = 0; node < lattice.count(); ++node) {
    if (!is_allowed(lattice, node)) continue;
    sum += node_weight(lattice, node);
    ++count;
  }
  return corners * 0.6 * sum / std::max(1, count);
}

namespace {

constexpr double kBatch =
    0.03;  // of the endpoints there are: so many walkers come before distances are brought up to date
constexpr double kSight = 3.0;  // distances from the structure within which walkers know how far it is

class DendriteGrower {
 public:
  DendriteGrower(DendriteTarget target, const DendriteOptions& options, Rng rng, const Monitor& monitor)
      : target_(std::move(target)), options_(options), rng_(rng), monitor_(monitor),
        cost_per_node_(cost_per_node(target_.lattice)) {
    std::vector<int> generator = connected_generators(target_.lattice, target_.generators);
    if (*std::max_element(generator.begin(), generator.end()) == 0) generator.clear();  // one: nobody to keep apart from
    structure_.forest = make_path_forest(target_.lattice.count(), std::move(generator));
  }

  Dendrite run() {
    const double half = 0.5 * std::min(target_.lattice.width, target_.lattice.height);
    double distance = options_.distance > 0.0 ? options_.distance : half;
    double count = options_.endpoints;
    plan_distances(reach(0, distance));
    for (int round = 0; round < options_.rounds && (round == 0 || distance >= options_.smallest); ++round) {
      monitor_.report(static_cast<double>(round) / options_.rounds);
      const std::size_t before = structure_.forest.nodes.size();
      if (round == 0 && walked())
        rounds_.push_back(connect_from_afar(distance));
      else
        rounds_.push_back(connect(choose(round, static_cast<int>(std::lround(count)), distance), round));
      count = std::min(1e7, (walked() ? rounds_.back() : count) * options_.branching);
      distance /= options_.attenuation;
      if (!target_.endpoints.empty() || round + 1 == options_.rounds || distance < options_.smallest) break;
      look_anew(nodes_from(before), reach(round + 1, distance));
    }
    return {std::move(target_.lattice), std::move(structure_), 1, rounds_};
  }

 private:
  // How dear a node may be that still matters in a round.
  double reach(int round, double distance) const {
    if (walked()) return (round == 0 ? kSight : 1.0) * distance * cost_per_node_;
    const bool anywhere = options_.placement != EndpointPlacement::Scatter || !target_.endpoints.empty() || (round == 0 && options_.distance <= 0.0);
    return anywhere ? std::numeric_limits<double>::infinity() : distance * cost_per_node_;
  }

  void plan_distances(double max_cost) {
    PlanOptions plan;
    plan.max_cost = max_cost;
    near_ = plan_paths(target_.lattice, target_.generators, plan, monitor_);
  }

  void look_anew(const std::vector<int>& nodes, double max_cost) {
    near_ = reseeded(std::move(near_), target_.lattice, nodes, max_cost, monitor_);
  }

  bool walked() const { return options_.placement == EndpointPlacement::Aggregate && target_.endpoints.empty(); }

  std::vector<int> nodes_from(std::size_t first) const {
    const std::vector<int>& nodes = structure_.forest.nodes;
    return {nodes.begin() + static_cast<std::ptrdiff_t>(first), nodes.end()};
  }

  // Everything that paths may end in.
  std::vector<int> sources() const {
    std::vector<int> out = nodes_from(0);
    out.insert(out.end(), target_.generators.begin(), target_.generators.end());
    return out;
  }

  bool drawn(int node) const { return structure_.forest.index_of[static_cast<std::size_t>(node)] != kNone; }

  std::vector<int> choose(int round, int count, double distance) {
    if (!target_.endpoints.empty()) return target_.endpoints;
    Rng rng = rng_.child("endpoints", static_cast<std::uint64_t>(round));
    const Size canvas{target_.lattice.width, target_.lattice.height};
    const double spacing = options_.spacing * distance;
    if (options_.placement == EndpointPlacement::Moss) return choose_above(sources(), usable(), count, distance, options_.spacing, rng);
    if (options_.placement == EndpointPlacement::Lightning && round > 0) {
      return choose_below(sources(), usable(), count, 0.3 * distance, 0.04 * distance, rng);
    }
    if (options_.placement == EndpointPlacement::Lightning) {
      return choose_spaced(reached([&](int node) { return node / canvas.width >= 0.97 * canvas.height; }), canvas, count, 0.5 * canvas.width / count, rng);
    }
    if (round == 0 && options_.distance <= 0.0) {
      const std::vector<int> nodes = reached([](int) { return true; });
      return choose_spaced(nodes, canvas, count, 2.0 * options_.spacing * std::sqrt(static_cast<double>(nodes.size()) / count), rng);
    }
    const double nearest = 0.6 * distance * cost_per_node_, farthest = distance * cost_per_node_;
    return choose_spaced(reached([&](int node) { const double cost = path_sum(near_, node); return cost >= nearest && cost <= farthest; }),
                         canvas, count, spacing, rng);
  }

  template <class Wanted>
  std::vector<int> reached(const Wanted& wanted) const {
    std::vector<int> out;
    for (int node = 0; node < target_.lattice.count(); ++node) {
      if (is_reached(near_, node) && !drawn(node) && wanted(node)) out.push_back(node);
    }
    return out;
  }

  Mask usable() const {
    Mask out(target_.lattice.width, target_.lattice.height, 0);
    for (int node = 0; node < target_.lattice.count(); ++node) {
      if (is_reached(near_, node) && !drawn(node)) out.pixels()[static_cast<std::size_t>(node)] = 255;
    }
    return out;
  }

  int connect(const std::vector<int>& endpoints, int round) {
    if (endpoints.empty()) return 0;
    if (options_.metric.metric == Metric::Sum) return add_paths(near_, endpoints, round);
    PlanOptions plan;
    plan.metric = options_.metric;
    plan.endpoints = endpoints;
    return add_paths(plan_paths(target_.lattice, sources(), plan, monitor_), endpoints, round);
  }

  Vec2 place_of(int node) const { return {node % target_.lattice.width, node / target_.lattice.width}; }

  // Walkers from far away, a few at a time: each ends where it first comes within the distance of what is there, so the
  // structure grows at its tips, and its fjords are screened. Ends at the canvas's edge.
  int connect_from_afar(double distance) {
    Rng rng = rng_.child("walkers");
    FarWalk walk;
    for (const int node : target_.generators)
      walk.middle += place_of(node) / static_cast<double>(target_.generators.size());
    walk.near = distance;
    double extent = 0.0;
    bool at_edge = false;
    const auto take_in = [&](const std::vector<int>& nodes) {
      for (const int node : nodes) {
        const Vec2 place = place_of(node);
        extent = std::max(extent, (place - walk.middle).norm());
        at_edge = at_edge || std::min(place.x(), place.y()) < distance ||
                  place.x() >= target_.lattice.width - distance || place.y() >= target_.lattice.height - distance;
      }
      walk.radius = extent + 2.0 * distance;
    };
    take_in(target_.generators);
    const auto free_way = [&](const Vec2& place) {
      const int x = static_cast<int>(std::lround(place.x())), y = static_cast<int>(std::lround(place.y()));
      if (!target_.lattice.contains(x, y)) return std::max(2.0 * distance, (place - walk.middle).norm() - extent);
      const int node = target_.lattice.node(x, y);
      return is_reached(near_, node) ? path_sum(near_, node) / cost_per_node_ : kSight * distance;
    };
    int placed = 0;
    at_edge = false;
    while (placed < options_.endpoints && !at_edge) {
      monitor_.report(static_cast<double>(placed) / options_.endpoints);
      std::vector<int> endpoints;
      for (int left = std::min(options_.endpoints - placed, 1 + static_cast<int>(kBatch * placed)); left > 0; --left) {
        monitor_.check();
        const std::optional<Vec2> place = walk_from_far(walk, free_way, rng);
        if (place) endpoints.push_back(node_at(target_.lattice, Vec3(place->x(), place->y(), 0.0)));
      }
      const std::size_t before = structure_.forest.nodes.size();
      const int added = connect(endpoints, 0);
      if (added == 0) break;
      placed += added;
      const std::vector<int> grown = nodes_from(before);
      take_in(grown);
      look_anew(grown, kSight * distance * cost_per_node_);
    }
    if (at_edge)
      monitor_.note("the structure reached the canvas's edge after " + std::to_string(placed) + " of " +
                    std::to_string(options_.endpoints) + " endpoints");
    return placed;
  }

  int add_paths(const Plan& plan, const std::vector<int>& endpoints, int round) {
    const int placed = draw_paths(structure_, plan, target_.lattice, endpoints, round);
    const auto lost = endpoints.size() - static_cast<std::size_t>(placed);
    if (lost > 0) monitor_.note(std::to_string(lost) + " of " + std::to_string(endpoints.size()) + " endpoints cannot be reached from the generators");
    return placed;
  }

  DendriteTarget target_;
  DendriteOptions options_;
  Rng rng_;
  Monitor monitor_;
  double cost_per_node_;
  Structure structure_;
  Plan near_;                // sums from the structure, for distances
  std::vector<int> rounds_;
};

}  // namespace

Dendrite grow_dendrite(DendriteTarget target, DendriteOptions options, Rng rng, const Monitor& monitor) {
  check_options(describe(options));
  check_lattice(target.lattice);
  if (target.lattice.depth != 1) throw InputError("the lattice", "has " + std::to_string(target.lattice.depth) + " layers; dendrites here grow in the plane");
  Dendrite out = DendriteGrower(std::move(target), options, rng, monitor.stage("paths", 0.0, options.refine > 1 ? 0.4 : 1.0)).run();
  if (std::accumulate(out.rounds.begin(), out.rounds.end(), 0) == 0) {
    throw InputError("the endpoints", "none can be reached from the generators; give others, or a mask that joins them (--debug-dir keeps a picture of what can be reached: cost.tiff)");
  }
  if (options.refine > 1) refine_dendrite(out, options, rng.child("refine"), monitor.stage("refine", 0.4, 1.0));
  return out;
}

Skeleton dendrite_skeleton(const Dendrite& dendrite, double pitch, const DendriteThickness& thickness) {
  const std::vector<int> above = endpoints_above(dendrite.structure);
  const std::vector<int>& nodes = dendrite.structure.forest.nodes;
  std::vector<Vec3> positions;
  std::vector<double> radii;
  // Node centres: cell (0, 0) covers `pitch` px from the canvas's corner at (-0.5, -0.5).
  const double step = pitch / dendrite.refine;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const Vec3 place = node_position(dendrite.lattice, nodes[i]);
    positions.push_back(Vec3((place.x() + 0.5) * step - 0.5, (place.y() + 0.5) * step - 0.5, 0.0));
    radii.push_back(std::min(thickness.largest, thickness.tip * std::pow(std::max(1, above[i]), thickness.taper)));
  }
  const Size canvas{static_cast<int>(std::lround(dendrite.lattice.width * step)), static_cast<int>(std::lround(dendrite.lattice.height * step))};
  const Skeleton skeleton = skeleton_from_structure(dendrite.structure, positions, radii, canvas, 2);
  return thickness.smooth > 0.0 ? smooth_skeleton(skeleton, thickness.smooth) : skeleton;
}

}  // namespace ramify
