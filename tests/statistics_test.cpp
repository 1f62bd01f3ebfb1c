// SPDX-License-Identifier: GPL-3.0-or-later
#include <catch2/catch.hpp>
#include <cmath>

#include "ramify/geometry/segment.h"
#include "ramify/skeleton/distribution.h"
#include "ramify/skeleton/statistics.h"
#include "support/random_skeleton.h"

using namespace ramify;

TEST_CASE("crossings agree with brute force") {
  for (int seed = 0; seed < 60; ++seed) {
    // Coordinates rounded to whole pixels make many touching and overlapping edges.
    Skeleton s = random_skeleton(Rng(seed), {120, 90}, 20, 20, seed % 2 ? 3.0 : 11.0);
    if (seed % 3 == 0) {
      for (int i = 0; i < s.count(); ++i) s.set_position(i, s[i].position.array().round().matrix());
    }
    std::vector<std::pair<int, int>> expected;
    for (int i = 0; i < s.count(); ++i) {
      for (int k = i + 1; k < s.count(); ++k) {
        const int p = s[i].parent, q = s[k].parent;
        if (p == kNone || q == kNone || p == q || p == k || q == i) continue;
        if (segment_relation(s[i].xy(), s[p].xy(), s[k].xy(), s[q].xy()) == SegmentRelation::Crossing) expected.emplace_back(i, k);
      }
    }
    CHECK(find_crossings(s) == expected);
  }
}

TEST_CASE("a circle bends as a circle does") {
  Skeleton s({300, 300});
  const double radius = 100;
  for (int i = 0; i <= 600; ++i) {
    const Vec2 p = Vec2(150, 150) + radius * direction_of(0.008 * i);
    s.append({Vec3(p.x(), p.y(), 0), 2.5, i - 1});
  }
  const SkeletonStatistics stats = measure_statistics(s);
  CHECK(stats.bends.step == 10.0);
  const auto angles = pooled(stats.bends.angles);
  CHECK(quantile(angles, 0.5) == Approx(0.1).epsilon(0.02));  // an arc of 10 px
  CHECK(quantile(pooled(stats.bends.radii), 0.5) == Approx(2.5));
  CHECK(stats.bends.angles.front().size() == 4);
  CHECK(stats.total_length == Approx(480).epsilon(1e-3));
  CHECK(stats.box_dimension == Approx(1.0).margin(0.1));
  CHECK(stats.tips == 1);
  CHECK(stats.furcations == 0);
  CHECK(stats.tortuosity[0] == Approx(480 / (200 * std::sin(2.4))).epsilon(1e-3));
}

TEST_CASE("a comb has the gaps furcations and orders it was built with") {
  Skeleton s({400, 100});
  for (int x = 0; x <= 300; x += 2) s.append({Vec3(x, 50, 0), 3.0, x == 0 ? kNone : x / 2 - 1});
  for (const int x : {50, 100, 200}) {
    int parent = x / 2;
    for (int k = 1; k <= 15; ++k) parent = s.append({Vec3(x, 50 + 2 * k, 0), 1.5, parent, 1});
  }
  const SkeletonStatistics stats = measure_statistics(s);
  CHECK(stats.gaps == std::vector<double>{50, 100});
  CHECK(stats.furcations == 3);
  CHECK(stats.branches == 4);
  CHECK(stats.tips == 4);
  CHECK(stats.order_lengths == std::vector<double>{300, 90});
  CHECK(stats.strahler_streams == std::vector<int>{4, 1});
  CHECK(stats.order_headings[0].strength == Approx(1.0));
  CHECK(stats.order_headings[1].direction == Approx(kPi / 2));
  CHECK(stats.heading.strength == Approx(std::hypot(300, 90) / 390));
  CHECK(stats.crossings == 0);
  REQUIRE(stats.fork_angles.size() == 3);
  for (const double a : stats.fork_angles) CHECK(a == Approx(kPi / 2).margin(0.02));
  for (const double r : stats.fork_ratios) CHECK(r == Approx(0.5));
}

TEST_CASE("a filled square has box dimension two") {
  Skeleton s({512, 512});
  for (int y = 0; y < 512; ++y) {
    s.append({Vec3(0, y, 0), 0.5});
    s.append({Vec3(511, y, 0), 0.5, s.count() - 1});
  }
  CHECK(box_dimension(s) == Approx(2.0).margin(0.02));
}

TEST_CASE("Koch's curve and Sierpinski's triangle have their box dimensions") {
  std::vector<Vec2> line{{60.0, 300.0}, {60.0 + 729.0, 300.0}};
  for (int level = 0; level < 5; ++level) {
    std::vector<Vec2> finer;
    for (std::size_t i = 0; i + 1 < line.size(); ++i) {
      const Vec2 a = line[i], third = (line[i + 1] - a) / 3.0, up(third.y(), -third.x());
      finer.insert(finer.end(), {a, a + third, a + 1.5 * third + std::sqrt(0.75) * up, a + 2.0 * third});
    }
    finer.push_back(line.back());
    line = finer;
  }
  Skeleton koch({850, 350});
  for (std::size_t i = 0; i < line.size(); ++i)
    koch.append({Vec3(line[i].x(), line[i].y(), 0), 1.0, static_cast<int>(i) - 1});
  CHECK(box_dimension(koch) == Approx(std::log(4.0) / std::log(3.0)).margin(0.04));

  Skeleton sierpinski({512, 512});  // Pascal's triangle modulo 2
  for (int y = 0; y < 512; ++y) {
    for (int x = 0; x < 512; ++x) {
      if ((x & y) == 0) sierpinski.append({Vec3(x, y, 0), 0.5});
    }
  }
  CHECK(box_dimension(sierpinski) == Approx(std::log(3.0) / std::log(2.0)).margin(0.02));
}

TEST_CASE("distances between distributions have their closed forms") {
  std::vector<double> a, b;
  for (int i = 0; i < 1000; ++i) a.push_back(i / 1000.0), b.push_back(i / 1000.0 + 0.25);
  CHECK(earth_movers_distance(a, b) == Approx(0.25));
  const HistogramPair same = make_histograms(a, a), moved = make_histograms(a, b);
  CHECK(total_variation(same.first, same.second) == 0.0);
  CHECK(jensen_shannon(same.first, same.second) == 0.0);
  CHECK(total_variation(moved.first, moved.second) == Approx(0.25).margin(0.01));
  const ShareHistogram left = make_histogram(std::vector<double>{0.1}, 0, 1), right = make_histogram(std::vector<double>{0.9}, 0, 1);
  CHECK(jensen_shannon(left, right) == Approx(1.0));
  CHECK(total_variation(left, right) == Approx(1.0));
}

TEST_CASE("the noise floor is what independent samples of one law differ by") {
  Rng rng(6);
  std::vector<std::vector<double>> runs;
  for (int k = 0; k < 400; ++k) {
    runs.emplace_back();
    for (int i = 0; i < 5; ++i) runs.back().push_back(rng.normal());
  }
  const NoiseFloor floor = noise_floor(runs, Rng(1));
  // ALGORITHMS 7.1: E[JS] is about (B - 1)(1/n1 + 1/n2) / (8 ln 2); empty end bins make it a little less.
  const double expected = 15.0 * (2.0 / 1000.0) / (8.0 * std::log(2.0));
  CHECK(floor.jensen_shannon > 0.3 * expected);
  CHECK(floor.jensen_shannon < 1.5 * expected);
  CHECK(noise_floor(runs, Rng(1)).total_variation == floor.total_variation);
  CHECK(noise_floor({{1.0, 2.0}}, Rng(1)).total_variation == 0.0);
}
