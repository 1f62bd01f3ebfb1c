// SPDX-License-Identifier: GPL-3.0-or-later
// Grows many skeletons in every style and prints how their statistics lie to the exemplar's, beside the targets:
//
//   growth_statistics [--seeds N] [--save FOLDER] EXEMPLAR…
//
// (NAME.ramify.json or builtin:KIND; photos are found by RAMIFY_PHOTOS; --save keeps the skeletons as SWC.)
// One line per exemplar, "mean (worst)" over the seeds; ! marks what misses its target.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <string>
#include <vector>

#include "ramify/core/parallel.h"
#include "ramify/recipe/pipeline.h"
#include "ramify/skeleton/branches.h"
#include "ramify/skeleton/distribution.h"
#include "ramify/skeleton/skeleton_io.h"
#include "ramify/skeleton/statistics.h"
#include "support/skeleton_checks.h"

namespace {

using namespace ramify;

constexpr double kMostRateError = 0.2;  // furcations per length, of the exemplar's
constexpr double kMostSpreads = 2.0;    // histogram distance, in the exemplar's own spread
constexpr double kMostTurn = 25.0;      // deg, per order, of the seeds' mean
constexpr double kHeadingCounts = 0.3;  // strength from which an order has a direction (PICTURES 1)
constexpr double kRayleigh = 3.0;       // n R^2 beyond which a direction is no chance, p < 0.05 (Rayleigh's test)
constexpr int kLongEnough = 30;         // m: exemplars with fewer nodes must repeat themselves

// Branches that leave others per px: two that leave one node are two, as where a leaf's laterals face each other.
double branching_rate(const Skeleton& skeleton, const SkeletonStatistics& statistics) {
  std::vector<int> children(static_cast<std::size_t>(skeleton.count()), 0);
  for (const Node& node : skeleton.nodes()) {
    if (node.parent != kNone) ++children[static_cast<std::size_t>(node.parent)];
  }
  int leaving = 0;
  for (const int count : children) leaving += std::max(0, count - 1);
  return leaving / std::max(1.0, statistics.bends.length);
}

// Distances of one grown skeleton, as ratios to what is allowed.
struct OneSeed {
  double rate = 0.0;    // furcations per length over the exemplar's
  double length = 0.0;  // over the exemplar's
  double angle = 0.0;   // total variation over the exemplar's spread
  double radius = 0.0;
  double run = 0.0;  // vertices, median verbatim run
  int crossings = 0;
  std::vector<Vec2> orders;  // px, sum of the edges of each order
};

struct Row {
  std::string name;
  std::vector<OneSeed> seeds;
  double least_run = 0.0;  // 3 m
  bool long_enough = false;
  std::vector<std::pair<int, double>> turns;  // order, deg between the exemplar's mean direction and the seeds'
};

std::vector<Vec2> order_sums(const Skeleton& skeleton) {
  std::vector<Vec2> sums;
  for (const Node& node : skeleton.nodes()) {
    if (node.parent == kNone) continue;
    if (node.order >= static_cast<int>(sums.size()))
      sums.resize(static_cast<std::size_t>(node.order) + 1, Vec2::Zero());
    sums[static_cast<std::size_t>(node.order)] += node.xy() - skeleton[node.parent].xy();
  }
  return sums;
}

// Whether the exemplar's branches of an order have a direction in common. Roots stand where the exemplar's do, so
// theirs always counts; of the others there must be enough: n = (sum of lengths)^2 / sum of squared lengths branches as
// they count.
bool has_direction(const Skeleton& exemplar, const SkeletonStatistics& own, int order) {
  const double strength = own.order_headings[static_cast<std::size_t>(order)].strength;
  double lengths = 0.0, squares = 0.0;
  for (const Branch& branch : branch_tree(exemplar).branches) {
    if (branch.order != order) continue;
    lengths += branch.length;
    squares += branch.length * branch.length;
  }
  if (strength < kHeadingCounts || !(squares > 0.0)) return false;
  return order == 0 || lengths * lengths / squares * strength * strength > kRayleigh;
}

double spreads(const std::vector<std::vector<double>>& exemplar, const std::vector<std::vector<double>>& grown,
               double spread) {
  const HistogramPair pair = make_histograms(pooled(exemplar), pooled(grown));
  return total_variation(pair.first, pair.second) / std::max(1e-9, spread);
}

Row measure(const std::string& name, int seeds, const std::string& folder) {
  PictureRequest request;
  request.verb = "grow";
  request.exemplar.argument = name;
  const LoadedRequest loaded = load_request(request, Monitor{});
  const Skeleton& exemplar = loaded.source.exemplar.skeleton;
  const double step = comparison_step(exemplar);
  const SkeletonStatistics own = measure_statistics(exemplar, step);
  const double angle_spread = noise_floor(own.bends.angles, Rng(1).child("angle")).total_variation;
  const double radius_spread = noise_floor(own.bends.radii, Rng(1).child("radius")).total_variation;
  Row row;
  row.name = name.substr(name.find_last_of('/') + 1);
  row.name = row.name.substr(0, row.name.find(".ramify"));
  std::replace(row.name.begin(), row.name.end(), ':', '_');
  row.least_run = 3.0 * loaded.style.bending.extension;
  row.long_enough = loaded.style.bending.vertex_count() >= kLongEnough * loaded.style.bending.extension;
  row.seeds.resize(static_cast<std::size_t>(seeds));
  const auto save = [&](const Skeleton& skeleton, int number) {
    if (!folder.empty()) save_skeleton(skeleton, folder + "/" + row.name + "_" + std::to_string(number) + ".swc");
  };
  save(exemplar, 0);
  parallel_for(seeds, [&](int s) {
    const Skeleton grown = make_picture(loaded, static_cast<std::uint64_t>(s + 1), Monitor{}).skeleton;
    save(grown, s + 1);
    const SkeletonStatistics statistics = measure_statistics(grown, step);
    OneSeed& one = row.seeds[static_cast<std::size_t>(s)];
    one.rate = own.furcations > 0 ? branching_rate(grown, statistics) / branching_rate(exemplar, own) : 1.0;
    one.length = statistics.total_length / own.total_length;
    one.angle = spreads(own.bends.angles, statistics.bends.angles, angle_spread);
    one.radius = spreads(own.bends.radii, statistics.bends.radii, radius_spread);
    one.run = test::median_verbatim_run(grown);
    one.crossings = test::crossing_pairs(grown);
    one.orders = order_sums(grown);
  });
  for (std::size_t o = 0; o < own.order_headings.size(); ++o) {
    if (!has_direction(exemplar, own, static_cast<int>(o))) continue;
    Vec2 sum = Vec2::Zero();
    for (const OneSeed& one : row.seeds) sum += o < one.orders.size() ? one.orders[o] : Vec2::Zero();
    const double turn = std::abs(wrap_angle(angle_of(sum) - own.order_headings[o].direction)) * 180.0 / kPi;
    row.turns.emplace_back(static_cast<int>(o), turn);
  }
  return row;
}

struct MeanAndWorst {
  double mean = 0.0, worst = 0.0;
};
// Worst: farthest from `ideal`.
MeanAndWorst over_seeds(const Row& row, double OneSeed::*figure, double ideal) {
  MeanAndWorst result{0.0, ideal};
  for (const OneSeed& one : row.seeds) {
    result.mean += one.*figure / static_cast<double>(row.seeds.size());
    if (std::abs(one.*figure - ideal) > std::abs(result.worst - ideal)) result.worst = one.*figure;
  }
  return result;
}

void print(const Row& row) {
  const auto cell = [](const MeanAndWorst& m, bool missed) {
    std::printf(" %6.2f (%5.2f)%c", m.mean, m.worst, missed ? '!' : ' ');
  };
  std::printf("%-30s", row.name.c_str());
  const MeanAndWorst rate = over_seeds(row, &OneSeed::rate, 1.0);
  cell(rate, std::abs(rate.mean - 1.0) > kMostRateError);
  for (double OneSeed::*figure : {&OneSeed::angle, &OneSeed::radius}) {
    const MeanAndWorst distance = over_seeds(row, figure, 0.0);
    cell(distance, distance.mean > kMostSpreads);
  }
  cell(over_seeds(row, &OneSeed::length, 1.0), false);
  const MeanAndWorst run = over_seeds(row, &OneSeed::run, 0.0);
  cell(run, row.long_enough && run.mean > row.least_run);
  int crossings = 0;
  std::string crossed;
  for (std::size_t s = 0; s < row.seeds.size(); ++s) {
    crossings += row.seeds[s].crossings;
    if (row.seeds[s].crossings > 0) crossed += " seed " + std::to_string(s + 1);
  }
  std::printf(" %9d%c ", crossings, crossings > 0 ? '!' : ' ');
  for (const auto& [order, turn] : row.turns) std::printf(" %d:%.0f%s", order, turn, turn > kMostTurn ? "!" : "");
  std::printf("%s\n", crossed.empty() ? "" : ("  crossed:" + crossed).c_str());
  std::fflush(stdout);
}

}  // namespace

int main(int count, char** arguments) {
  int seeds = 20;
  std::string folder;
  std::vector<std::string> names;
  for (int i = 1; i < count; ++i) {
    if (std::strcmp(arguments[i], "--seeds") == 0 && i + 1 < count) {
      seeds = std::max(1, std::atoi(arguments[++i]));
    } else if (std::strcmp(arguments[i], "--save") == 0 && i + 1 < count) {
      folder = arguments[++i];
    } else {
      names.emplace_back(arguments[i]);
    }
  }
  if (names.empty()) {
    std::fprintf(stderr, "usage: growth_statistics [--seeds N] [--save FOLDER] EXEMPLAR...\n");
    return 2;
  }
  std::printf(
      "mean (worst) of %d seeds; targets: rate within 20 %%, angle and radius at most 2 spreads, run at most 3 m, no\n"
      "crossings, mean direction per order within 25 deg\n",
      seeds);
  std::printf("%-30s %-15s %-15s %-15s %-15s %-15s %-10s %s\n", "exemplar", " furcation rate", "angle spreads",
              "radius spreads", "length", "verbatim run", "crossings", "order:deg off");
  try {
    for (const std::string& name : names) print(measure(name, seeds, folder));
  } catch (const std::exception& error) {
    std::fprintf(stderr, "growth_statistics: %s\n", error.what());
    return 3;
  }
  return 0;
}
