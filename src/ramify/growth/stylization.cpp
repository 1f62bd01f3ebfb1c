// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/growth/stylization.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "ramify/core/error.h"
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

// The share of all nodes that must hang together to be the picture's main lines. Cheap nodes come together to one large
// piece all of a sudden (percolation), so the share is of little consequence.
constexpr double kMainShare = 0.1;

// Pieces of nodes that hang together, as trees of parents.
class Pieces {
 public:
  explicit Pieces(int count) : parent_(static_cast<std::size_t>(count)), size_(static_cast<std::size_t>(count), 1) {
    std::iota(parent_.begin(), parent_.end(), 0);
  }
  int of(int node) {
    while (parent_[static_cast<std::size_t>(node)] != node) {
      int& up = parent_[static_cast<std::size_t>(node)];
      up = parent_[static_cast<std::size_t>(up)];
      node = up;
    }
    return node;
  }
  int size_of(int node) { return size_[static_cast<std::size_t>(of(node))]; }
  void join(int a, int b) {
    a = of(a), b = of(b);
    if (a == b) return;
    if (size_[static_cast<std::size_t>(a)] < size_[static_cast<std::size_t>(b)]) std::swap(a, b);
    parent_[static_cast<std::size_t>(b)] = a;
    size_[static_cast<std::size_t>(a)] += size_[static_cast<std::size_t>(b)];
  }

 private:
  std::vector<int> parent_, size_;
};

// Nodes in rising order of weight; only allowed ones.
std::vector<int> cheapest_first(const Lattice& lattice) {
  const WholeWeights& weights = std::get<WholeWeights>(lattice.weights);
  std::vector<int> out;
  for (int node = 0; node < lattice.count(); ++node) {
    if (is_allowed(lattice, node)) out.push_back(node);
  }
  std::stable_sort(out.begin(), out.end(), [&](int a, int b) { return weights[static_cast<std::size_t>(a)] < weights[static_cast<std::size_t>(b)]; });
  return out;
}

}  // namespace

int main_line_node(const Lattice& lattice, const Vec2& near) {
  const std::vector<int> order = cheapest_first(lattice);
  if (order.empty()) throw InputError("the mask", "leaves no pixel that paths may use");
  const int wanted = std::max(1, static_cast<int>(kMainShare * static_cast<double>(order.size())));
  Pieces pieces(lattice.count());
  std::vector<std::uint8_t> in(static_cast<std::size_t>(lattice.count()), 0);
  int largest = order.front();
  for (const int node : order) {
    in[static_cast<std::size_t>(node)] = 1;
    const int x = node % lattice.width, y = node / lattice.width;
    for (const LatticeStep& step : lattice_steps(lattice.connectivity)) {
      if (!lattice.contains(x + step.dx, y + step.dy)) continue;
      const int next = lattice.node(x + step.dx, y + step.dy);
      if (in[static_cast<std::size_t>(next)]) pieces.join(node, next);
    }
    if (pieces.size_of(node) > pieces.size_of(largest)) largest = node;
    if (pieces.size_of(largest) >= wanted) break;
  }
  int best = largest;
  double least = std::numeric_limits<double>::infinity();
  for (const int node : order) {
    if (!in[static_cast<std::size_t>(node)] || pieces.of(node) != pieces.of(largest)) continue;
    const double distance = (Vec2(node % lattice.width, node / lattice.width) - near).squaredNorm();
    if (distance < least || (distance == least && node < best)) least = distance, best = node;
  }
  return best;
}

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
  Lattice lattice = importance_lattice(importance, allowed, options, rng.child("weights"));
  const Vec2 middle(importance.width() / 2, options.upward > 1.0 ? 0 : importance.height() / 2);
  const int start = root ? node_at(lattice, {root->x(), root->y(), 0.0}) : main_line_node(lattice, middle);
  if (!is_allowed(lattice, start)) throw InputError("the root", "lies where the mask forbids paths; place it elsewhere");
  Stylization out;
  out.stipples.seed = rng.child("stipples").next();
  Stipples stipples = stipple_count(importance, allowed, {start}, options.endpoints, out.stipples, monitor.stage("endpoints", 0.0, 0.7));
  out.threshold = stipples.threshold;
  out.endpoints = std::move(stipples.pixels);
  std::erase_if(out.endpoints, [&](int node) { return importance.pixels()[static_cast<std::size_t>(node)] < options.least; });
  if (out.endpoints.empty()) throw InputError("the picture", "has no room for a single endpoint; lower --least-importance");
  PlanOptions plan;
  plan.metric = options.metric;
  plan.endpoints = out.endpoints;
  const Plan paths = plan_paths(lattice, std::vector<int>{start}, plan, monitor.stage("paths", 0.7, 1.0));
  Structure structure;
  structure.forest = make_path_forest(lattice.count());
  const int placed = draw_paths(structure, paths, lattice, out.endpoints, 0);
  if (placed == 0) throw InputError("the endpoints", "none can be reached from the root; give another --root, or a mask that joins them");
  out.dendrite = {std::move(lattice), std::move(structure), 1, {placed}};
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
