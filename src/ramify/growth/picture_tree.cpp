// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/growth/picture_tree.h"

#include <algorithm>
#include <cmath>

#include "ramify/core/error.h"
#include "ramify/graph/stipple.h"
#include "ramify/growth/endpoint_placement.h"
#include "ramify/growth/stylization.h"
#include "ramify/image/filter.h"

namespace ramify {

std::vector<OptionField> describe(PictureTreeOptions& o) {
  return {
      number("rounds", o.rounds, 1, 20, "", "Rounds of branches; 1 = trunk and limbs only."),
      number("limbs", o.limbs, 0, 10000, "", "Limbs of the first round beside the trunk."),
      number("trunk", o.trunk, 0.02, 1.0, "", "Height of the trunk, share of the canvas's."),
      number("twigs", o.twigs, 1, 1000000, "", "Ends of the second round."),
      number("branching", o.branching, 1.0, 100.0, "", "Every later round has so many times as many ends."),
      number("reach", o.reach, 0.005, 2.0, "", "How far from the tree the second round's ends lie, share of the canvas's height."),
      number("shrink", o.shrink, 0.05, 1.0, "", "Every later round's reach is so many times the one before."),
      number("roughness", o.roughness, 0.0, 1e6, "", "Random share of weights; small is straight, large erratic."),
      number("gnarl", o.gnarl, 0.0, 1e6, "", "Weight of a path's dearest step against 1 for its sum; large twigs wind."),
      number("hidden", o.hidden, 0.0, 1.0, "", "Share of the canvas, from the right, in which twigs follow the picture."),
      number("hops", o.hops, 1, 1000000, "", "The picture's twigs end at most so many steps from the tree."),
      number("random-share", o.random_share, 0.0, 10.0, "", "Random ends where the picture rules, relative to the picture's."),
      number("thin", o.thin, 0.05, 1000.0, "px", "Radius of the last twigs."),
      number("thick", o.thick, 0.05, 1000.0, "px", "Radius of the trunk."),
      choice("thickness", o.thickness, {"rounds", "distance", "importance", "endpoints"}, "What makes a branch thick."),
  };
}

namespace {

constexpr double kDearest = 1000.0;  // whole weights, as in stylization
constexpr double kBare = 0.45;       // share of the trunk below its lowest limb

class TreeGrower {
 public:
  TreeGrower(const ScalarImage& importance, Size size, Vec2 root, const PictureTreeOptions& options, Rng rng, const Monitor& monitor)
      : importance_(importance), size_(size), options_(options), rng_(rng), monitor_(monitor) {
    lattice_ = random_lattice(0);
    root_ = node_at(lattice_, {root.x(), root.y(), 0.0});
    structure_.forest = make_path_forest(lattice_.count());
  }

  PictureTree run(const PictureTree* trunk) {
    if (trunk) keep_trunk(*trunk);
    else grow_trunk();
    double count = options_.twigs, reach = options_.reach * size_.height;
    for (int round = 1; round < options_.rounds; ++round, count *= options_.branching, reach *= options_.shrink) {
      monitor_.report(static_cast<double>(round) / options_.rounds);
      lattice_ = importance_.empty() ? random_lattice(round) : guided_lattice(round);
      draw(later_ends(round, static_cast<int>(std::min(1e6, count)), reach), round);
    }
    PictureTree out{lattice_, std::move(structure_), Skeleton()};
    out.skeleton = thickened(out);
    return out;
  }

 private:
  int x_of(int node) const { return node % size_.width; }
  int y_of(int node) const { return node / size_.width; }
  bool drawn(int node) const { return structure_.forest.index_of[static_cast<std::size_t>(node)] != kNone; }

  std::vector<int> sources() const { return structure_.forest.nodes.empty() ? std::vector<int>{root_} : structure_.forest.nodes; }

  Lattice random_lattice(int round) {
    Lattice out;
    out.width = size_.width;
    out.height = size_.height;
    out.weights = HashedWeights{rng_.child("lattice", static_cast<std::uint64_t>(round)).next(), 1.0, options_.roughness, false};
    return out;
  }

  // The picture's costs where it rules, fading into chance towards the left: "we increase the random contribution to the
  // edge weights towards the left side of the image".
  Lattice guided_lattice(int round) {
    const std::uint64_t seed = rng_.child("lattice", static_cast<std::uint64_t>(round)).next();
    const double border = size_.width * (1.0 - options_.hidden), fade = 0.15 * size_.width;
    Lattice out;
    out.width = size_.width;
    out.height = size_.height;
    WholeWeights weights(static_cast<std::size_t>(out.count()));
    for (int node = 0; node < out.count(); ++node) {
      const double chance = std::clamp((border - x_of(node)) / fade + 0.5, 0.02, 1.0);
      const double important = importance_.pixels()[static_cast<std::size_t>(node)];
      const double cost = 0.02 + (1.0 - chance) * (1.0 - important) + chance * hash01(seed, static_cast<std::uint64_t>(node));
      weights[static_cast<std::size_t>(node)] = static_cast<std::uint16_t>(std::clamp(std::round(kDearest / 1.02 * cost), 1.0, kDearest));
    }
    out.weights = std::move(weights);
    return out;
  }

  void draw(const std::vector<int>& ends, int round) {
    if (ends.empty()) return;
    PlanOptions plan;
    plan.endpoints = ends;
    if (round > 0) {
      plan.metric.metric = Metric::Mix;
      plan.metric.peak_share = options_.gnarl;
    }
    draw_paths(structure_, plan_paths(lattice_, sources(), plan, monitor_), lattice_, ends, round);
  }

  // The first round comes first in a forest, so the trunk is the start of every list.
  void keep_trunk(const PictureTree& tree) {
    const PathForest& forest = tree.structure.forest;
    const auto of_trunk = [&](int path) { return tree.structure.rounds[static_cast<std::size_t>(path)] == 0; };
    PathForest& own = structure_.forest;
    for (std::size_t i = 0; i < forest.nodes.size() && of_trunk(forest.paths[i]); ++i) {
      own.index_of[static_cast<std::size_t>(forest.nodes[i])] = static_cast<int>(i);
      own.nodes.push_back(forest.nodes[i]);
      own.parents.push_back(forest.parents[i]);
      own.paths.push_back(forest.paths[i]);
    }
    for (const int round : tree.structure.rounds) {
      if (round == 0) structure_.rounds.push_back(0);
    }
    own.path_count = static_cast<int>(structure_.rounds.size());
    for (const int end : tree.structure.endpoints) {
      if (end < static_cast<int>(own.nodes.size())) structure_.endpoints.push_back(end);
    }
  }

  // The trunk straight up from the root, then limbs that leave its upper part.
  void grow_trunk() {
    const double top = std::max(0.04 * size_.height, y_of(root_) - options_.trunk * size_.height);
    draw({lattice_.node(x_of(root_), static_cast<int>(top))}, 0);
    std::vector<int> upper;
    for (const int node : structure_.forest.nodes) {
      if (y_of(node) < y_of(root_) - kBare * (y_of(root_) - top)) upper.push_back(node);
    }
    const std::vector<int> ends = limb_ends(top);
    PlanOptions plan;
    plan.endpoints = ends;
    if (!ends.empty() && !upper.empty()) draw_paths(structure_, plan_paths(lattice_, upper, plan, monitor_), lattice_, ends, 0);
  }

  // Around the top of the trunk, more to the sides than above.
  std::vector<int> limb_ends(double top) {
    Rng rng = rng_.child("limbs");
    std::vector<int> out;
    SpacedPoints taken(size_, 0.1 * size_.height);
    for (int tries = 0; tries < 100 * options_.limbs && static_cast<int>(out.size()) < options_.limbs; ++tries) {
      const double angle = rng.uniform(-0.97 * kPi, -0.03 * kPi), far = size_.height * rng.uniform(0.15, 0.4);
      const int x = static_cast<int>(std::lround(x_of(root_) + 1.1 * far * std::cos(angle)));
      const int y = static_cast<int>(std::lround(top + 0.08 * size_.height + far * std::sin(angle)));
      if (lattice_.contains(x, y) && taken.add(x, y)) out.push_back(lattice_.node(x, y));
    }
    return out;
  }

  // Twigs keep off the lower half of the trunk. Without a picture they keep within an ellipse too: a crown, not the canvas.
  bool in_crown(int node) const {
    const double lowest = y_of(root_) - 0.5 * options_.trunk * size_.height;
    if (!importance_.empty()) return y_of(node) < lowest;
    const double dx = (x_of(node) - 0.5 * size_.width) / (0.49 * size_.width), dy = (y_of(node) - 0.5 * lowest) / (0.5 * lowest);
    return dx * dx + dy * dy < 1.0;
  }

  std::vector<int> later_ends(int round, int count, double reach) {
    const Rng rng = rng_.child("ends", static_cast<std::uint64_t>(round));
    if (importance_.empty()) return random_ends(count, reach, 0.0, size_.width, rng.child("all"));
    const int border = static_cast<int>(std::lround(size_.width * (1.0 - options_.hidden)));
    std::vector<int> out = picture_ends(count, border, round, rng.child("picture"));
    const auto hidden = static_cast<double>(out.size());
    const std::vector<int> left = random_ends(static_cast<int>(0.5 * hidden * border / std::max(1, size_.width - border)), reach, 0.0, border, rng.child("left"));
    const std::vector<int> right = random_ends(static_cast<int>(options_.random_share * hidden), reach, border, size_.width, rng.child("right"));
    out.insert(out.end(), left.begin(), left.end());
    out.insert(out.end(), right.begin(), right.end());
    return out;
  }

  // Ends by stippling the importance, every node of the tree being a source; too far ones only keep others away.
  std::vector<int> picture_ends(int count, int border, int round, Rng rng) {
    StippleOptions stipples;
    stipples.seed = rng.next();
    const Stipples found = stipple_count(importance_, {}, sources(), count, stipples, monitor_);
    const double hops = options_.hops * std::pow(options_.shrink, round - 1);
    std::vector<int> out;
    for (std::size_t i = 0; i < found.pixels.size(); ++i) {
      if (found.hops[i] <= hops && x_of(found.pixels[i]) >= border && in_crown(found.pixels[i])) out.push_back(found.pixels[i]);
    }
    return out;
  }

  std::vector<int> random_ends(int count, double reach, double left, double right, Rng rng) const {
    Mask tree(size_.width, size_.height, 0);
    for (const int node : structure_.forest.nodes) tree.pixels()[static_cast<std::size_t>(node)] = 255;
    const ScalarImage distance = distance_to(tree);
    std::vector<int> candidates;
    for (int node = 0; node < lattice_.count(); ++node) {
      const double far = distance.pixels()[static_cast<std::size_t>(node)];
      if (far >= 0.25 * reach && far <= reach && x_of(node) >= left && x_of(node) < right && in_crown(node)) candidates.push_back(node);
    }
    return choose_spaced(std::move(candidates), size_, count, 0.15 * reach, rng);
  }

  Skeleton thickened(const PictureTree& tree) const {
    const PathForest& forest = tree.structure.forest;
    const std::vector<int> above = endpoints_above(tree.structure);
    std::vector<Vec3> positions;
    std::vector<double> radii;
    std::vector<double> way(forest.nodes.size(), 0.0);  // nodes from the trunk's structure
    double farthest = 1.0, most = 1.0;
    for (std::size_t i = 0; i < forest.nodes.size(); ++i) {
      const bool trunk = tree.structure.rounds[static_cast<std::size_t>(forest.paths[i])] == 0;
      if (!trunk && forest.parents[i] != kNone) way[i] = way[static_cast<std::size_t>(forest.parents[i])] + 1.0;
      farthest = std::max(farthest, way[i]);
      most = std::max<double>(most, above[i]);
      positions.push_back(Vec3(x_of(forest.nodes[i]), y_of(forest.nodes[i]), 0.0));
    }
    for (std::size_t i = 0; i < forest.nodes.size(); ++i) {
      const int round = tree.structure.rounds[static_cast<std::size_t>(forest.paths[i])];
      double share = options_.rounds > 1 ? 1.0 - static_cast<double>(round) / (options_.rounds - 1) : 1.0;
      if (options_.thickness == TreeThickness::Distance) share = 1.0 - std::sqrt(way[i] / farthest);
      // Ends carry mass as area: a limb of a quarter of the ends is half as thick as the trunk.
      if (options_.thickness == TreeThickness::Endpoints) share = std::sqrt((above[i] - 1.0) / std::max(1.0, most - 1.0));
      radii.push_back(options_.thin + (options_.thick - options_.thin) * std::clamp(share, 0.0, 1.0));
    }
    Skeleton out = skeleton_from_structure(tree.structure, positions, radii, size_, 2);
    if (options_.thickness == TreeThickness::Importance && !importance_.empty()) out = emphasize(out, importance_, {options_.thin, options_.thick, 15});
    return out;
  }

  const ScalarImage& importance_;
  Size size_;
  PictureTreeOptions options_;
  Rng rng_;
  Monitor monitor_;
  Lattice lattice_;
  int root_ = 0;
  Structure structure_;
};

}  // namespace

PictureTree grow_picture_tree(const ScalarImage& importance, Size size, std::optional<Vec2> root, const PictureTree* trunk,
                              const PictureTreeOptions& options, Rng rng, const Monitor& monitor) {
  PictureTreeOptions checked = options;
  check_options(describe(checked));
  const Size canvas = importance.empty() ? size : importance.size();
  if (canvas.width < 16 || canvas.height < 16) throw InputError("the canvas", "is smaller than 16x16 px; a tree needs room");
  const Vec2 start = root ? *root : Vec2(canvas.width / 2, canvas.height - 1);
  return TreeGrower(importance, canvas, start, options, rng, monitor).run(trunk);
}

}  // namespace ramify
