// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/growth/aggregation.h"

#include <Eigen/Dense>
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <set>

#include "ramify/core/error.h"
#include "ramify/growth/far_walker.h"
#include "ramify/recipe/planning.h"
#include "ramify/skeleton/statistics.h"

using namespace ramify;

namespace {

std::vector<Vec2> places(const Aggregate& aggregate) {
  std::vector<Vec2> out;
  for (const int node : aggregate.nodes) out.emplace_back(node % aggregate.size.width, node / aggregate.size.width);
  return out;
}

// What random walks on the square lattice from infinity meet of a finite set: h = A^-1 1 / (1' A^-1 1) with the
// potential kernel a(x - y) (Spitzer, Principles of Random Walk, section 14): a(n, n) = 4/pi (1 + 1/3 + ... + 1/(2n -
// 1)), and harmonic but at the origin.
double potential_kernel(int x, int y) {
  x = std::abs(x), y = std::abs(y);
  if (x < y) std::swap(x, y);
  if (x == y) {
    double sum = 0.0;
    for (int k = 1; k <= x; ++k) sum += 1.0 / (2 * k - 1);
    return 4.0 / kPi * sum;
  }
  if (x == 1) return 1.0;  // (1, 0)
  // 4 a(x-1, y) is the sum of its four neighbours; a(x, y) is one of them, beside the diagonal two.
  if (y == x - 1) return 2.0 * potential_kernel(y, y) - potential_kernel(y, y - 1);
  return 4.0 * potential_kernel(x - 1, y) - potential_kernel(x - 2, y) - potential_kernel(x - 1, y + 1) -
         potential_kernel(x - 1, y - 1);
}

}  // namespace

TEST_CASE("aggregate: every walker stays beside an earlier one, and nowhere twice") {
  for (const WalkerLaunch launch : {WalkerLaunch::AnyNode, WalkerLaunch::Circle}) {
    AggregationOptions options;
    options.walkers = 900;
    options.launch = launch;
    const Aggregate grown = grow_aggregate({121, 101}, options, Rng(3), {});
    CHECK(grown.nodes.size() <= 900);
    CHECK(grown.nodes.size() > 500);
    CHECK(grown.nodes.front() == 50 * 121 + 60);
    const std::vector<Vec2> at = places(grown);
    CHECK(std::set<int>(grown.nodes.begin(), grown.nodes.end()).size() == grown.nodes.size());
    for (std::size_t i = 1; i < at.size(); ++i) {
      REQUIRE(grown.parents[i] >= 0);
      REQUIRE(grown.parents[i] < static_cast<int>(i));
      CHECK((at[i] - at[static_cast<std::size_t>(grown.parents[i])]).norm() == 1.0);
    }
    aggregate_skeleton(grown, 0.5).check();
  }
}

TEST_CASE("aggregate: a full canvas by any node; a circle ends at the canvas's edge") {
  AggregationOptions options;
  options.walkers = 1000;
  options.launch = WalkerLaunch::AnyNode;
  CHECK(grow_aggregate({9, 7}, options, Rng(1), {}).nodes.size() == 63);
  options.launch = WalkerLaunch::Circle;
  const Aggregate small = grow_aggregate({21, 21}, options, Rng(1), {});
  const int last = small.nodes.back(), x = last % 21, y = last / 21;
  CHECK((x == 0 || y == 0 || x == 20 || y == 20));
  CHECK_THROWS_AS(grow_aggregate({2, 9}, options, Rng(1), {}), InputError);
}

TEST_CASE("aggregate: walkers from the circle meet what random walks from infinity meet") {
  // Beside two nodes there are six: two at the ends, four along the sides. The third walker stays on one of these.
  const int at[6][2] = {{-1, 0}, {2, 0}, {0, 1}, {1, 1}, {0, -1}, {1, -1}};
  Eigen::Matrix<double, 6, 6> kernel;
  for (int i = 0; i < 6; ++i) {
    for (int j = 0; j < 6; ++j) kernel(i, j) = potential_kernel(at[i][0] - at[j][0], at[i][1] - at[j][1]);
  }
  const Eigen::Matrix<double, 6, 1> met = kernel.fullPivLu().solve(Eigen::Matrix<double, 6, 1>::Ones());
  const double ends = (met[0] + met[1]) / met.sum();
  CHECK(ends > 2.0 / 6.0);  // tips are met more often than sides
  AggregationOptions options;
  options.walkers = 3;
  const int runs = 20000;
  int at_ends = 0;
  for (int seed = 0; seed < runs; ++seed) {
    const std::vector<Vec2> place =
        places(grow_aggregate({41, 41}, options, Rng(static_cast<std::uint64_t>(seed)), {}));
    const Vec2 first = place[1] - place[0], third = place[2] - place[0];
    if (std::abs(first.x() * third.y() - first.y() * third.x()) < 0.5) ++at_ends;  // on the line of the two
  }
  CHECK(static_cast<double>(at_ends) / runs == Approx(ends).margin(4.0 * std::sqrt(ends * (1.0 - ends) / runs)));
}

TEST_CASE("aggregate: grows to the fractal dimension of diffusion-limited aggregation, 1.71") {
  AggregationOptions options;
  options.walkers = 16000;
  std::vector<double> found;
  double mean = 0.0, square = 0.0;
  for (int seed = 0; seed < 6; ++seed) {
    const Aggregate grown = grow_aggregate({801, 801}, options, Rng(static_cast<std::uint64_t>(seed)), {});
    REQUIRE(grown.nodes.size() == 16000);
    found.push_back(mass_radius_dimension(places(grown), {400, 400}));
    mean += found.back() / 6;
  }
  for (const double d : found) square += (d - mean) * (d - mean) / 5;
  // Student's t with 5 degrees of freedom is beyond 4.03 in one of a hundred samples of the published mean.
  CHECK(std::abs(mean - 1.71) <= 4.03 * std::sqrt(square / 6));
  CHECK(std::sqrt(square) < 0.1);
}

TEST_CASE("far walkers: come back to the circle as Poisson's kernel says") {
  Rng rng(2);
  const int draws = 40000;
  for (const double rho : {1.05, 1.5, 4.0}) {
    const double start = 0.7;
    std::array<Vec2, 3> moments{Vec2::Zero(), Vec2::Zero(), Vec2::Zero()};
    for (int i = 0; i < draws; ++i) {
      const Vec2 back = return_to_circle(50.0 * rho * Vec2(std::cos(start), std::sin(start)), 50.0, rng);
      REQUIRE(back.norm() == Approx(50.0));
      const double angle = std::atan2(back.y(), back.x()) - start;
      for (std::size_t k = 0; k < 3; ++k)
        moments[k] += Vec2(std::cos((k + 1.0) * angle), std::sin((k + 1.0) * angle)) / draws;
    }
    for (std::size_t k = 0; k < 3; ++k) {
      CHECK(moments[k].x() == Approx(std::pow(rho, -(k + 1.0))).margin(4.0 / std::sqrt(2.0 * draws)));
      CHECK(moments[k].y() == Approx(0.0).margin(4.0 / std::sqrt(2.0 * draws)));
    }
  }
}

TEST_CASE("far walkers: meet a needle by the arcsine law, its tips most") {
  const double half = 200.0;
  FarWalk walk;
  walk.middle = {30.0, -20.0};
  walk.radius = 1.2 * half;
  walk.near = 1.0;
  const auto free_way = [&](const Vec2& place) {
    const Vec2 at = place - walk.middle;
    return std::hypot(std::max(0.0, std::abs(at.x()) - half), at.y());
  };
  Rng rng(5);
  std::vector<double> share;  // of the law, at every place met
  for (int i = 0; i < 4000; ++i) {
    const std::optional<Vec2> place = walk_from_far(walk, free_way, rng);
    REQUIRE(place);
    CHECK(free_way(*place) <= walk.near);
    share.push_back(0.5 + std::asin(std::clamp((place->x() - walk.middle.x()) / half, -1.0, 1.0)) / kPi);
  }
  std::sort(share.begin(), share.end());
  double farthest = 0.0;
  for (std::size_t i = 0; i < share.size(); ++i)
    farthest =
        std::max(farthest, std::abs(share[i] - (static_cast<double>(i) + 0.5) / static_cast<double>(share.size())));
  // Kolmogorov's bound for one in a hundred, and what meeting it 1 px before the needle may shift at the tips: 2 asin.
  CHECK(farthest < 1.63 / std::sqrt(4000.0) + std::acos(1.0 - walk.near / half) / kPi);
}

TEST_CASE("far walkers: nothing to meet ends the walk") {
  Rng rng(1);
  FarWalk walk;
  walk.radius = 10.0;
  walk.most_leaps = 100;
  CHECK_FALSE(walk_from_far(
      walk, [](const Vec2&) { return 5.0; }, rng));
}

TEST_CASE("dendrite: aggregating endpoints make the dimensions of walkers, and screen what is inside") {
  DendriteRequest request;
  request.size = "500x500";
  request.roots = "250,250";
  apply_preset(*find_preset(dendrite_presets(), "dla"), describe(request));
  double mass = 0.0, boxes = 0.0;
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    const Dendrite grown = grow_dendrite(load_dendrite(request, seed, {}), request.grow, Rng(seed), {});
    REQUIRE(grown.rounds.size() == 2);
    CHECK(grown.rounds[0] < request.grow.endpoints);  // the edge came first
    const Skeleton skeleton = dendrite_skeleton(grown, 1.0, {});
    std::vector<Vec2> points;
    double extent = 0.0, late = 0.0;
    for (const Node& node : skeleton.nodes()) {
      points.push_back(node.xy());
      extent = std::max(extent, (points.back() - Vec2(250, 250)).norm());
    }
    mass += mass_radius_dimension(points, {250, 250}) / 6;
    boxes += box_dimension(skeleton) / 6;
    const int first = grown.rounds[0];
    for (int k = first - first / 10; k < first; ++k) {
      const int node = grown.structure.forest
                           .nodes[static_cast<std::size_t>(grown.structure.endpoints[static_cast<std::size_t>(k)])];
      late += std::hypot(node % 500 - 250, node / 500 - 250) / (first / 10);
    }
    CHECK(late > 0.5 * extent);  // an endpoint anywhere along the structure lies nearer
  }
  const double walked =
      box_dimension(aggregate_skeleton(grow_aggregate({1001, 1001}, {25000, WalkerLaunch::Circle}, Rng(1), {}), 0.5));
  CHECK(mass == Approx(1.71).margin(0.05));
  CHECK(boxes == Approx(walked).margin(0.05));
}

TEST_CASE("mass-radius dimension: 2 for a disc, 1 for a line") {
  std::vector<Vec2> disc, line;
  for (int y = -100; y <= 100; ++y) {
    for (int x = -100; x <= 100; ++x) {
      if (std::hypot(x, y) <= 100) disc.emplace_back(x, y);
    }
  }
  for (int x = -400; x <= 400; ++x) line.emplace_back(x, 7);
  CHECK(mass_radius_dimension(disc, {0, 0}) == Approx(2.0).margin(0.03));
  CHECK(mass_radius_dimension(line, {0, 7}) == Approx(1.0).margin(0.03));
  CHECK(mass_radius_dimension(std::vector<Vec2>(5, Vec2(1, 1)), {0, 0}) == 0.0);
}
