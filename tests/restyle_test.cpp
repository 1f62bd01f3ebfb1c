// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "ramify/geometry/polyline.h"
#include "ramify/growth/bent_path.h"
#include "ramify/growth/dendrite.h"
#include "ramify/growth/restyle.h"
#include "ramify/skeleton/branches.h"
#include "ramify/skeleton/distribution.h"
#include "ramify/skeleton/statistics.h"
#include "support/skeleton_checks.h"
#include "support/wavy_tree.h"

using namespace ramify;

namespace {

Style style_of(double wave, double wavelength, std::uint64_t seed) {
  test::WavyTree tree;
  tree.wave = wave;
  tree.wavelength = wavelength;
  return learn_style(test::wavy_tree(tree, seed), LearnStyleOptions{}, Monitor{});
}

// Paths planned through random weights, as `dendrite` does.
Skeleton plan(std::uint64_t seed, Size size, int endpoints) {
  Rng rng(seed);
  DendriteTarget target;
  target.lattice.width = size.width;
  target.lattice.height = size.height;
  target.lattice.connectivity = Connectivity::Plane8;
  target.lattice.weights = HashedWeights{seed, 1.0, 10.0, false};
  target.generators = {rng.below(size.width * size.height)};
  DendriteOptions options;
  options.endpoints = endpoints;
  return dendrite_skeleton(grow_dendrite(std::move(target), options, rng.child("grow"), Monitor{}), 3.0, {});
}

// The node of `after` at every node of `before`: both have the same branches, `after` with more nodes on them.
std::vector<std::pair<Vec2, Vec2>> ends(const Skeleton& before, const Skeleton& after) {
  const BranchTree a = branch_tree(before), b = branch_tree(after);
  REQUIRE(a.branches.size() == b.branches.size());
  std::vector<std::pair<Vec2, Vec2>> pairs;
  for (std::size_t i = 0; i < a.branches.size(); ++i) {
    REQUIRE(a.branches[i].parent == b.branches[i].parent);
    pairs.emplace_back(before[a.branches[i].nodes.back()].xy(), after[b.branches[i].nodes.back()].xy());
    if (a.branches[i].parent == kNone)
      pairs.emplace_back(before[a.branches[i].nodes.front()].xy(), after[b.branches[i].nodes.front()].xy());
  }
  return pairs;
}

}  // namespace

TEST_CASE("a chain ends where and as it shall, its turns hardly changed") {
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    Rng rng(seed);
    std::vector<Vec2> points{Vec2(rng.uniform(-50, 50), rng.uniform(-50, 50))};
    double direction = rng.uniform(-kPi, kPi);
    const double first = direction;
    for (int i = 0; i < 20 + rng.below(100); ++i)
      points.push_back(points.back() + 2.5 * direction_of(direction += 0.2 * rng.normal()));
    const Vec2 start = points.front(), end = points.back() + Vec2(rng.uniform(-4, 4), rng.uniform(-4, 4));
    const double wanted = wrap_angle(direction + rng.uniform(-0.3, 0.3));
    const std::vector<double> before = turning_angles(points);
    const std::size_t count = points.size();
    const double most = close_chain(points, end, wanted, {0.2, 0.3, 0.05});
    INFO("seed " << seed << " turned " << wrap_angle(direction - first));
    REQUIRE(most < 0.35);
    REQUIRE(points.size() == count);
    CHECK(points.front() == start);
    CHECK(points.back() == end);
    CHECK(std::abs(wrap_angle(angle_of(points[count - 1] - points[count - 2]) - wanted)) < 0.02);
    const std::vector<double> after = turning_angles(points);
    for (std::size_t i = 1; i + 1 < count; ++i) CHECK(std::abs(wrap_angle(after[i] - before[i])) < most + 0.02);
  }
  std::vector<Vec2> straight{{0, 0}, {1, 0}, {2, 0}, {3, 0}};
  const std::vector<Vec2> kept = straight;
  CHECK(close_chain(straight, {9, 0}, 0.0, {0.2, 0.3, 0.01}) > 1e6);  // three times as long: not by small changes
  CHECK(straight == kept);
}

TEST_CASE("a bent line starts and ends where the line did") {
  const Style style = style_of(0.6, 50.0, 3);
  PathBender bender(style);
  int bent = 0;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    Rng rng(seed);
    const double length = rng.uniform(60, 500), arch = rng.uniform(-0.5, 0.5) * length;
    std::vector<Vec2> points;
    for (int i = 0; i <= 40; ++i) points.emplace_back(length * i / 40, arch * std::sin(kPi * i / 40));
    const std::vector<double> radii(points.size(), 2.0);
    const std::vector<Vec2> out = bender.bend(points, radii, Rng(seed));
    if (out.empty()) continue;
    ++bent;
    CHECK((out.front() - points.front()).norm() <= 1e-6);
    CHECK((out.back() - points.back()).norm() <= 1e-6);
    double farthest = 0.0;
    for (const Vec2& p : out) {
      double nearest = 1e9;
      for (const Vec2& q : refine_polyline(points, 2.0)) nearest = std::min(nearest, (p - q).norm());
      farthest = std::max(farthest, nearest);
    }
    CHECK(farthest < 4.0 * bender.valley());
    CHECK(farthest > 0.5);
  }
  CHECK(bent >= 54);
}

TEST_CASE("restyled plans keep roots and tips and cross nowhere") {
  const std::vector<Style> styles{style_of(0.3, 40.0, 1), style_of(0.8, 60.0, 2), style_of(0.6, 120.0, 3)};
  double moved = 0.0;
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    const Skeleton before = plan(seed, {90, 70}, 6 + static_cast<int>(seed % 40));
    REQUIRE(test::crossing_pairs(before) == 0);
    const double strength = seed % 4 == 0 ? 0.4 : 1.0;
    const Skeleton after = restyle_skeleton(before, styles[seed % styles.size()], strength, Rng(seed), Monitor{});
    INFO("plan " << seed);
    after.check();
    CHECK(find_crossings(after).empty());
    if (seed % 10 == 0) CHECK(test::crossing_pairs(after) == 0);  // by brute force
    for (const auto& [a, b] : ends(before, after)) CHECK((a - b).norm() <= 1e-6);
    for (const Node& node : after.nodes()) {
      double nearest = 1e9;
      for (const Node& old : before.nodes()) nearest = std::min(nearest, (old.xy() - node.xy()).norm());
      moved = std::max(moved, nearest);
    }
  }
  CHECK(moved > 3.0);
}

TEST_CASE("the more a skeleton is restyled, the more its angles are the exemplar's") {
  for (const double wave : {0.25, 0.7}) {
    test::WavyTree source;
    source.wave = wave;
    source.wavelength = 50.0;
    const Skeleton exemplar = test::wavy_tree(source, 7);
    const Style style = learn_style(exemplar, LearnStyleOptions{}, Monitor{});
    const double step = comparison_step(exemplar);
    const std::vector<double> wanted = pooled(measure_bends(exemplar, step).angles);
    double before = 1e9, first = 0.0;
    for (const double strength : {0.0, 0.25, 0.5, 0.75, 1.0}) {
      std::vector<double> angles;
      for (std::uint64_t seed = 1; seed <= 12; ++seed) {
        test::WavyTree straight;
        straight.wave = 0.0;
        straight.children = 4;
        const std::vector<double> own =
            pooled(measure_bends(
                       restyle_skeleton(test::wavy_tree(straight, seed), style, strength, Rng(seed), Monitor{}), step)
                       .angles);
        angles.insert(angles.end(), own.begin(), own.end());
      }
      const double distance = earth_movers_distance(wanted, angles);
      INFO("wave " << wave << " strength " << strength << " distance " << distance);
      CHECK(distance < before);
      if (strength == 0.0) first = distance;
      if (strength == 1.0) CHECK(distance < 0.45 * first);
      before = distance;
    }
  }
}

TEST_CASE("restyling by nothing changes nothing; the same seed bends alike") {
  const Skeleton before = plan(4, {90, 70}, 20);
  const Style style = style_of(0.5, 50.0, 1);
  const auto same = [](const Skeleton& a, const Skeleton& b) {
    if (a.count() != b.count()) return false;
    for (int i = 0; i < a.count(); ++i) {
      if (a[i].position != b[i].position || a[i].radius != b[i].radius || a[i].parent != b[i].parent) return false;
    }
    return true;
  };
  CHECK(same(restyle_skeleton(before, style, 0.0, Rng(1), Monitor{}), before));
  const Skeleton once = restyle_skeleton(before, style, 1.0, Rng(1), Monitor{});
  CHECK(same(once, restyle_skeleton(before, style, 1.0, Rng(1), Monitor{})));
  CHECK_FALSE(same(once, restyle_skeleton(before, style, 1.0, Rng(2), Monitor{})));
  CHECK_THROWS_AS(restyle_skeleton(before, style, 1.5, Rng(1), Monitor{}), std::invalid_argument);
  CHECK_THROWS_AS(restyle_skeleton(before, style, std::nan(""), Rng(1), Monitor{}), std::invalid_argument);
  CHECK(restyle_skeleton(Skeleton(Size{5, 5}), style, 1.0, Rng(1), Monitor{}).empty());
}

TEST_CASE("what crosses already may stay, ends of loop links do not move") {
  Skeleton cross(Size{300, 300});
  for (int i = 0; i <= 50; ++i) cross.append({Vec3(20.0 + 5 * i, 30.0 + 4.6 * i, 0), 2.0, i - 1});
  for (int i = 0; i <= 50; ++i) cross.append({Vec3(20.0 + 5 * i, 270.0 - 4.6 * i, 0), 2.0, i == 0 ? kNone : 50 + i});
  cross.loop_links = {{10, 61}};
  const std::size_t crossings = find_crossings(cross).size();
  REQUIRE(crossings >= 1);
  const Skeleton after = restyle_skeleton(cross, style_of(0.7, 50.0, 2), 1.0, Rng(3), Monitor{});
  REQUIRE(after.loop_links.size() == 1);
  CHECK((after[after.loop_links[0].first].xy() - cross[10].xy()).norm() == 0.0);
  CHECK((after[after.loop_links[0].second].xy() - cross[61].xy()).norm() == 0.0);
  CHECK(find_crossings(after).size() <= crossings);
}
