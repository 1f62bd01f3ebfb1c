// SPDX-License-Identifier: GPL-3.0-or-later
#include <catch2/catch.hpp>
#include <cmath>

#include "ramify/core/parallel.h"
#include "ramify/growth/grow.h"
#include "ramify/skeleton/branches.h"
#include "support/wavy_tree.h"

using namespace ramify;

namespace {

Style style_of(const test::WavyTree& tree, std::uint64_t seed) {
  return learn_style(test::wavy_tree(tree, seed), LearnStyleOptions{}, Monitor{});
}

GrowthTarget canvas(int width, int height) {
  GrowthTarget target;
  target.size = {width, height};
  return target;
}

double sign_of_area(const Vec2& a, const Vec2& b, const Vec2& c) { return cross(b - a, c - a); }

// Pairs of edges without a common node whose segments cross: every pair is looked at.
int crossing_pairs(const Skeleton& s) {
  int crossings = 0;
  for (int i = 0; i < s.count(); ++i) {
    if (s[i].parent == kNone) continue;
    const Vec2 a = s[i].xy(), b = s[s[i].parent].xy();
    for (int j = i + 1; j < s.count(); ++j) {
      if (s[j].parent == kNone || s[j].parent == i || s[i].parent == s[j].parent || s[i].parent == j) continue;
      const Vec2 c = s[j].xy(), d = s[s[j].parent].xy();
      if (std::max(a.x(), b.x()) < std::min(c.x(), d.x()) || std::max(c.x(), d.x()) < std::min(a.x(), b.x())) continue;
      crossings += sign_of_area(a, b, c) * sign_of_area(a, b, d) <= 0 && sign_of_area(c, d, a) * sign_of_area(c, d, b) <= 0;
    }
  }
  return crossings;
}

double length_of(const Skeleton& s) {
  double length = 0.0;
  for (const Node& node : s.nodes()) {
    if (node.parent != kNone) length += (node.xy() - s[node.parent].xy()).norm();
  }
  return length;
}

bool same(const Skeleton& a, const Skeleton& b) {
  if (a.count() != b.count()) return false;
  for (int i = 0; i < a.count(); ++i) {
    const Node &x = a[i], &y = b[i];
    if (x.position != y.position || x.radius != y.radius || x.parent != y.parent || x.tag != y.tag) return false;
  }
  return true;
}

}  // namespace

TEST_CASE("grown branches never cross") {
  for (std::uint64_t kind = 0; kind < 12; ++kind) {
    test::WavyTree tree;
    Rng rng(kind);
    tree.wave = rng.uniform(0.1, 0.9);
    tree.wavelength = rng.uniform(25.0, 120.0);
    tree.radius = rng.uniform(1.0, 12.0);
    tree.children = 3 + rng.below(9);
    tree.direction = rng.uniform(-0.4, 0.4);
    const Style style = style_of(tree, kind);
    for (std::uint64_t seed = 0; seed < 8; ++seed) {
      const Skeleton grown = grow_from_style(style, canvas(500, 350), GrowOptions{}, Rng(seed), Monitor{});
      grown.check();
      INFO("kind " << kind << " seed " << seed);
      CHECK(crossing_pairs(grown) == 0);
    }
  }
}

TEST_CASE("as much length grows per area as the exemplar has") {
  const test::WavyTree tree;
  const Style style = style_of(tree, 1);
  for (const double wanted : {1.0, 0.5}) {
    for (std::uint64_t seed = 0; seed < 5; ++seed) {
      GrowOptions options;
      options.length = wanted;
      const Skeleton grown = grow_from_style(style, canvas(tree.size.width, tree.size.height), options, Rng(seed), Monitor{});
      CHECK(length_of(grown) == Approx(wanted * style.hierarchy.total_length).epsilon(0.15));
    }
  }
}

TEST_CASE("levels stop the growth of higher orders") {
  const Style style = style_of({}, 2);
  for (const int levels : {1, 2}) {
    GrowOptions options;
    options.levels = levels;
    const Skeleton grown = grow_from_style(style, canvas(600, 400), options, Rng(1), Monitor{});
    int highest = 0;
    for (const Branch& branch : branch_tree(grown).branches) highest = std::max(highest, branch.order);
    CHECK(highest == levels - 1);
  }
}

TEST_CASE("the same seed grows the same skeleton with any number of threads") {
  std::vector<Skeleton> grown;
  for (const int threads : {1, 2, 8}) {
    set_thread_count(threads);
    grown.push_back(grow_from_style(style_of({}, 3), canvas(600, 400), GrowOptions{}, Rng(7), Monitor{}));
  }
  set_thread_count(0);
  CHECK(same(grown[0], grown[1]));
  CHECK(same(grown[0], grown[2]));
  CHECK_FALSE(same(grown[0], grow_from_style(style_of({}, 3), canvas(600, 400), GrowOptions{}, Rng(8), Monitor{})));
}

TEST_CASE("nothing grows on obstacles and growth ends at outside regions") {
  const Style style = style_of({}, 4);
  GrowthTarget target = canvas(600, 400);
  target.obstacles = Mask(600, 400, 0);
  target.outside = Mask(600, 400, 0);
  for (int y = 0; y < 400; ++y) {
    for (int x = 0; x < 600; ++x) {
      if (std::hypot(x - 300, y - 260) < 60) target.obstacles(x, y) = 255;
      if (y < 80) target.outside(x, y) = 255;
    }
  }
  for (std::uint64_t seed = 0; seed < 6; ++seed) {
    const Skeleton grown = grow_from_style(style, target, GrowOptions{}, Rng(seed), Monitor{});
    for (int i = 0; i < grown.count(); ++i) {
      const Vec2 p = grown[i].xy();
      CHECK(std::hypot(p.x() - 300, p.y() - 260) > 59.0);
      if (grown[i].parent != kNone) CHECK((p.y() > 78 || grown[grown[i].parent].xy().y() > 78));
    }
  }
}

TEST_CASE("maps of another size than the canvas are refused") {
  GrowthTarget target = canvas(100, 80);
  target.density = ScalarImage(50, 40, 1.0f);
  CHECK_THROWS_AS(grow_from_style(style_of({}, 5), target, GrowOptions{}, Rng(1), Monitor{}), InputError);
  target.density = ScalarImage(100, 80, 0.0f);
  CHECK_THROWS_AS(grow_from_style(style_of({}, 5), target, GrowOptions{}, Rng(1), Monitor{}), InputError);
}

TEST_CASE("a cancelled growth stops") {
  Monitor monitor{Monitor::Progress{}};
  const Style style = style_of({}, 6);
  monitor.cancel();
  CHECK_THROWS_AS(grow_from_style(style, canvas(600, 400), GrowOptions{}, Rng(1), monitor), Cancelled);
}
