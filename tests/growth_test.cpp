// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "ramify/core/parallel.h"
#include "ramify/growth/grow.h"
#include "ramify/growth/joining.h"
#include "ramify/growth/occupancy.h"
#include "ramify/skeleton/branches.h"
#include "support/growth_inputs.h"
#include "support/skeleton_checks.h"

using namespace ramify;
using test::canvas;
using test::dense_tree;
using test::style_of;

namespace {

Extension extension_of(std::vector<Vec2> points, double radius) {
  Extension extension;
  extension.radii.assign(points.size(), radius);
  extension.turns.assign(points.size(), 0.0);
  extension.copied.assign(points.size(), 0);
  extension.points = std::move(points);
  return extension;
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
      CHECK(test::crossing_pairs(grown) == 0);
    }
  }
}

TEST_CASE("a branch that ends on another does not turn back over its own end") {
  const GrowthTarget target = canvas(200, 200);
  const Ground ground(target);
  Occupancy occupancy(ground, 8.0, {}, 4.0);
  GrowingBranch wall, tip;
  for (int i = 0; i < 20; ++i) {
    wall.points.emplace_back(100.0, 20.0 + 4.0 * i);
    wall.radii.push_back(7.0);
  }
  tip.points = {{73.0, 60.0}, {77.0, 60.0}, {81.0, 60.0}, {85.0, 60.0}, {89.0, 59.0}};
  tip.radii.assign(tip.points.size(), 6.0);
  for (int i = 1; i < wall.count(); ++i) occupancy.add_edge(wall, 0, i);
  for (int i = 1; i < tip.count(); ++i) occupancy.add_edge(tip, 1, i);
  const std::vector<GrowingBranch> branches{wall, tip};
  const Capsule ahead{wall.points[9], wall.points[10], 7.0, 7.0, 0, 9};
  const Capsule behind{{70.0, 40.0}, {70.0, 80.0}, 7.0, 7.0, 2, 9};  // wide as well: met, though it lies at the back
  Extension extension = extension_of({{92.0, 57.0}, {95.0, 56.0}}, 6.0);
  REQUIRE(end_on(ahead, 1, occupancy, ground, branches, 1, extension));
  CHECK(extension.stop == GrowthStop::Join);
  CHECK(100.0 - extension.points.back().x() == Approx(0.6 * 7.0).margin(0.3));  // inside the rim, short of the axis
  for (const int at : {0, 1}) {
    Extension turned = extension_of({{92.0, 57.0}, {95.0, 56.0}}, 6.0);
    CHECK_FALSE(end_on(behind, at, occupancy, ground, branches, 1, turned));
    CHECK(turned.stop == GrowthStop::None);
  }
}

TEST_CASE("a child on a thick parent cannot turn back across the link it hangs on") {
  const GrowthTarget target = canvas(200, 200);
  const Ground ground(target);
  Occupancy occupancy(ground, 30.0, {}, 4.0);
  GrowingBranch parent, child;
  for (int i = 0; i < 40; ++i) {
    parent.points.emplace_back(20.0 + 4.0 * i, 60.0);
    parent.radii.push_back(30.0);
  }
  child.parent = 0;
  child.parent_node = 20;
  child.points = {{100.0, 90.5}};
  child.radii = {3.0};
  for (int i = 1; i < parent.count(); ++i) occupancy.add_edge(parent, 0, i);
  occupancy.add_link(parent.points[20], child.points.front(), 1);
  const std::vector<GrowingBranch> branches{parent, child};
  CHECK_FALSE(occupancy.meet(branches, 1, extension_of({{102.0, 94.0}, {104.0, 97.5}, {106.0, 101.0}}, 3.0)).blocked);
  CHECK(occupancy.meet(branches, 1, extension_of({{103.0, 88.0}, {103.0, 84.0}, {98.0, 84.0}}, 3.0)).blocked);
}

TEST_CASE("as much length grows per area as the exemplar has") {
  const test::WavyTree tree;
  const Style style = style_of(tree, 1);
  for (const double wanted : {1.0, 0.5}) {
    for (std::uint64_t seed = 0; seed < 5; ++seed) {
      GrowOptions options;
      options.length = wanted;
      const Skeleton grown =
          grow_from_style(style, canvas(tree.size.width, tree.size.height), options, Rng(seed), Monitor{});
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

TEST_CASE("grown radii are spread as the exemplar's") {
  test::WavyTree tree = dense_tree();
  const Style style = style_of(tree, 21);
  const Skeleton grown = grow_from_style(style, canvas(600, 400), GrowOptions{}, Rng(4), Monitor{});
  std::vector<double> own = style.bending.radius, radii;
  for (const Node& node : grown.nodes()) radii.push_back(node.radius);
  std::sort(own.begin(), own.end());
  std::sort(radii.begin(), radii.end());
  for (const double share : {0.1, 0.25, 0.5, 0.75, 0.9}) {
    const auto at = [&](const std::vector<double>& values) {
      return values[static_cast<std::size_t>(share * (values.size() - 1.0))];
    };
    INFO("share " << share);
    CHECK(at(radii) == Approx(at(own)).epsilon(0.1));
  }
}

TEST_CASE("a thick branch that ends in the open fades to the exemplar's thinnest") {
  test::WavyTree tree;
  tree.radius = 12.0;  // the main's own tip is six times as thick as the thinnest twig: a trace cut short
  const Style style = style_of(tree, 22);
  int judged = 0;
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    const Skeleton grown = grow_from_style(style, canvas(700, 400), GrowOptions{}, Rng(seed), Monitor{});
    for (const Branch& branch : branch_tree(grown).branches) {
      const Node& tip = grown[branch.nodes.back()];
      const double rim = std::min({tip.position.x(), tip.position.y(), 699 - tip.position.x(), 399 - tip.position.y()});
      if (branch.order > 0 || rim < 30.0) continue;
      CHECK(tip.radius <= 3.0 * style.hierarchy.least_radius);
      ++judged;
    }
  }
  CHECK(judged > 0);
}

TEST_CASE("grown statistics are the exemplar's") {
  const Style style = style_of({}, 15);
  double forks = 0.0, length = 0.0;
  Vec2 heading = Vec2::Zero();
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    const Skeleton grown = grow_from_style(style, canvas(600, 400), GrowOptions{}, Rng(seed), Monitor{});
    for (const Branch& branch : branch_tree(grown).branches) {
      forks += branch.parent != kNone;
      length += branch.length;
      if (branch.order == 0) heading += grown[branch.nodes.back()].xy() - grown[branch.nodes.front()].xy();
    }
    CHECK(test::median_verbatim_run(grown) <= 3 * style.bending.extension);
  }
  const double children = static_cast<double>(style.hierarchy.branches.size()) - 1.0;
  CHECK(forks / length == Approx(children / style.hierarchy.total_length).epsilon(0.25));
  CHECK(std::abs(angle_of(heading)) < 25.0 * kPi / 180.0);
}

namespace {

// The most that a curve winds within `lag` edges, rad: from its points alone.
double most_winding(const std::vector<Vec2>& points, int lag) {
  std::vector<double> headings;  // unwrapped
  for (std::size_t i = 1; i < points.size(); ++i) {
    const double angle = angle_of(points[i] - points[i - 1]);
    headings.push_back(headings.empty() ? angle : headings.back() + wrap_angle(angle - headings.back()));
  }
  double most = 0.0;
  for (std::size_t i = 0; i < headings.size(); ++i) {
    for (std::size_t j = i + 1; j < headings.size() && j <= i + static_cast<std::size_t>(lag); ++j)
      most = std::max(most, std::abs(headings[j] - headings[i]));
  }
  return most;
}

void append_line(Skeleton& skeleton, int parent, Vec2 from, const Vec2& to, double radius) {
  const int steps = static_cast<int>((to - from).norm() / 2.0);
  for (int i = parent == kNone ? 0 : 1; i <= steps; ++i) {
    const Vec2 p =
        from + (to - from) * (static_cast<double>(i) / steps) + Vec2(0.4 * std::sin(i * 1.3), 0.4 * std::cos(i * 1.7));
    Node node;
    node.position = Vec3(p.x(), p.y(), 0.0);
    node.radius = radius;
    node.parent = parent;
    parent = skeleton.append(node);
  }
}

}  // namespace

TEST_CASE("no branch winds more than the exemplar's do") {
  test::WavyTree tree;
  tree.wave = 1.1;
  tree.wavelength = 90.0;
  tree.radius = 2.0;
  const Style style = style_of(tree, 31);
  const BendingModel& bending = style.bending;
  REQUIRE(style.hierarchy.lags.size() >= 2);
  for (const int lag : style.hierarchy.lags) {
    double allowed = 0.0;
    for (int b = 0; b < bending.branch_count(); ++b) {
      allowed = std::max(
          allowed,
          most_winding({bending.point.begin() + bending.first[b], bending.point.begin() + bending.first[b + 1]}, lag));
    }
    for (std::uint64_t seed = 0; seed < 8; ++seed) {
      const Skeleton grown = grow_from_style(style, canvas(600, 400), GrowOptions{}, Rng(seed), Monitor{});
      for (const Branch& branch : branch_tree(grown).branches) {
        std::vector<Vec2> points;
        for (const int node : branch.nodes) points.push_back(grown[node].xy());
        if (branch.parent != kNone) points.erase(points.begin());  // on the parent's axis
        INFO("lag " << lag << " seed " << seed);
        CHECK(most_winding(points, lag) <= allowed + 1e-6);
      }
    }
  }
}

TEST_CASE("in a net branches run on until they meet another") {
  Skeleton bricks(Size{500, 500});
  for (int row = 0; row < 8; ++row) {
    const double y = 30.0 + 60.0 * row;
    const int first = bricks.count();
    append_line(bricks, kNone, {0.0, y}, {499.0, y}, 2.0);
    for (int brick = 0; brick < 15 && row < 7; ++brick) {
      const double x = 24.0 + 30.0 * brick + 15.0 * (row % 2);
      append_line(bricks, first + static_cast<int>(x / 2.0), {x, y}, {x, y + 56.0}, 2.0);
    }
  }
  const Style style = learn_style(bricks, LearnStyleOptions{}, Monitor{});
  int ends = 0, met = 0;
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const Skeleton grown = grow_from_style(style, canvas(500, 500), GrowOptions{}, Rng(seed), Monitor{});
    CHECK(test::crossing_pairs(grown) == 0);
    const BranchTree tree = branch_tree(grown);
    std::vector<int> owner(static_cast<std::size_t>(grown.count()), kNone);
    for (std::size_t b = 0; b < tree.branches.size(); ++b) {
      for (const int node : tree.branches[b].nodes) owner[static_cast<std::size_t>(node)] = static_cast<int>(b);
    }
    for (std::size_t b = 0; b < tree.branches.size(); ++b) {
      const Vec2 tip = grown[tree.branches[b].nodes.back()].xy();
      if (std::min({tip.x(), tip.y(), 499 - tip.x(), 499 - tip.y()}) < 4.0) continue;
      double nearest = 1e9;
      for (int i = 0; i < grown.count(); ++i) {
        const int other = owner[static_cast<std::size_t>(i)];
        if (other == static_cast<int>(b) || other == tree.branches[b].parent) continue;
        nearest = std::min(nearest, (grown[i].xy() - tip).norm() - grown[i].radius);
      }
      ++ends;
      met += nearest < 2.0 + style.step;
    }
  }
  INFO(met << " of " << ends);
  REQUIRE(ends > 50);
  CHECK(met >= 0.8 * ends);  // short spurs may end in the open
}

TEST_CASE("a stroke reaches the ground where the exemplar's does") {
  test::WavyTree tree;
  tree.size = {400, 500};
  tree.root = {200.0, 60.0};
  tree.direction = 0.5 * kPi;
  tree.length = 640.0;  // beyond the frame below
  tree.wave = 0.9;
  Skeleton whole = test::wavy_tree(tree, 7), exemplar(tree.size);
  std::vector<int> kept(static_cast<std::size_t>(whole.count()), kNone);
  for (int i = 0; i < whole.count(); ++i) {
    Node node = whole[i];
    const bool inside =
        node.position.x() >= 0 && node.position.x() <= 399 && node.position.y() >= 0 && node.position.y() <= 499;
    if (!inside || (node.parent != kNone && kept[static_cast<std::size_t>(node.parent)] == kNone)) continue;
    if (node.parent != kNone) node.parent = kept[static_cast<std::size_t>(node.parent)];
    kept[static_cast<std::size_t>(i)] = exemplar.append(node);
  }
  const Style style = learn_style(exemplar, LearnStyleOptions{}, Monitor{});
  REQUIRE(style.hierarchy.branches.front().end == BranchEnd::Frame);
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    for (const int asked : {0, 1, 3}) {
      GrowthTarget target = canvas(400, 1500);  // three times as far as the exemplar's own way
      for (int i = 0; i < asked; ++i) target.roots.push_back({Vec2(100.0 + 100.0 * i, 60.0), {}, {}});
      const Skeleton grown = grow_from_style(style, target, GrowOptions{}, Rng(seed), Monitor{});
      bool reached = false;
      for (const Branch& branch : branch_tree(grown).branches) {
        if (branch.order > 0) continue;
        const Vec2 end = grown[branch.nodes.back()].xy();
        reached = reached || std::min({end.x(), end.y(), 399 - end.x(), 1499 - end.y()}) < 1.0;
      }
      INFO("seed " << seed << ", " << asked << " roots asked for");
      CHECK(reached);
    }
  }
}

TEST_CASE("roots that start from one place stay roots there") {
  Skeleton disc(Size{500, 500});
  for (int spoke = 0; spoke < 5; ++spoke) {
    const Vec2 along = direction_of(2.0 * kPi * spoke / 5.0 + 0.2);
    for (int i = 0; i < 60; ++i) {
      const Vec2 p =
          Vec2(250, 250) + along * (4.0 + 3.0 * i) + perpendicular(along) * (4.0 * std::sin(0.2 * i + spoke));
      Node node;
      node.position = Vec3(p.x(), p.y(), 0.0);
      node.radius = 3.0 - 0.03 * i;
      node.parent = i > 0 ? disc.count() - 1 : kNone;
      disc.append(node);
    }
  }
  const Style style = learn_style(disc, LearnStyleOptions{}, Monitor{});
  REQUIRE(style.hierarchy.branches.size() == 5);
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    const Skeleton grown = grow_from_style(style, canvas(500, 500), GrowOptions{}, Rng(seed), Monitor{});
    std::vector<Vec2> starts;
    for (const Node& node : grown.nodes()) {
      if (node.parent == kNone) starts.push_back(node.xy());
    }
    CHECK(starts.size() == 5);
    for (const Vec2& start : starts) CHECK((start - starts.front()).norm() < 25.0);
    CHECK(test::crossing_pairs(grown) == 0);
  }
}

TEST_CASE("every flag back to the paper changes the growth") {
  const Style style = style_of({}, 16);
  const Skeleton plain = grow_from_style(style, canvas(600, 400), GrowOptions{}, Rng(3), Monitor{});
  for (bool GrowOptions::*flag : {&GrowOptions::raw_distance, &GrowOptions::radius_histogram,
                                  &GrowOptions::raster_density, &GrowOptions::parent_first, &GrowOptions::copy_stem,
                                  &GrowOptions::free_direction, &GrowOptions::free_radius, &GrowOptions::paper_exact}) {
    GrowOptions options;
    options.*flag = true;
    const Skeleton grown = grow_from_style(style, canvas(600, 400), options, Rng(3), Monitor{});
    CHECK(grown.count() > 50);
    CHECK_FALSE(same(grown, plain));
  }
}

TEST_CASE("a style without furcations grows its branch alone") {
  test::WavyTree tree;
  tree.orders = 1;
  const Skeleton grown = grow_from_style(style_of(tree, 17), canvas(600, 400), GrowOptions{}, Rng(1), Monitor{});
  CHECK(branch_tree(grown).branches.size() == 1);
}

TEST_CASE("a given root keeps its place and radius") {
  GrowthTarget target = canvas(600, 400);
  target.roots = {{Vec2(300, 200), 1.0, 3.0}};
  const Skeleton grown = grow_from_style(style_of({}, 18), target, GrowOptions{}, Rng(1), Monitor{});
  CHECK(grown[0].xy() == Vec2(300, 200));
  CHECK(grown[0].radius == Approx(3.0));
  CHECK(std::abs(wrap_angle(angle_of(grown[1].xy() - grown[0].xy()) - 1.0)) < 0.1);
  target.roots = {{Vec2(900, 200), {}, {}}};
  CHECK_THROWS_AS(grow_from_style(style_of({}, 18), target, GrowOptions{}, Rng(1), Monitor{}), InputError);
}

TEST_CASE("a root on a landmark stays where the kept ground has it") {
  const Skeleton tree = test::wavy_tree({}, 3);
  std::vector<NodePlace> places(static_cast<std::size_t>(tree.count()), NodePlace::Ground);
  places.front() = NodePlace::Landmark;
  const Style style = learn_style(tree, LearnStyleOptions{}, Monitor{}, places);
  GrowthTarget target = canvas(tree.size.width, tree.size.height);
  target.kept = KeptGround{1.05, Vec2(7.0, -3.0)};
  const Vec2 wanted = 1.05 * style.bending.point.front() + Vec2(7.0, -3.0);
  for (int seed = 1; seed <= 4; ++seed) {
    const Skeleton grown =
        grow_from_style(style, target, GrowOptions{}, Rng(static_cast<std::uint64_t>(seed)), Monitor{});
    double nearest = 1e9;
    for (const Node& node : grown.nodes()) nearest = std::min(nearest, (node.xy() - wanted).norm());
    CHECK(nearest < 1e-6);
  }
}

namespace {

// Mean number of vertices copied in one piece into one long main branch.
double mean_run(int extension, int history, int candidates) {
  test::WavyTree tree;
  tree.orders = 1;
  tree.size = {1400, 400};
  tree.length = 1300.0;
  LearnStyleOptions learn;
  learn.feature_size = 2.0 * extension;  // so that the step is 2 px in every setting
  learn.extension = extension;
  learn.history = history;
  learn.mirror = false;
  const Style style = learn_style(test::wavy_tree(tree, 5), learn, Monitor{});
  GrowOptions grow;
  grow.paper_exact = true;
  grow.candidates = candidates;
  grow.histogram_weight = 0.0;
  grow.levels = 1;
  int runs = 0, copied = 0;
  for (std::uint64_t seed = 0; seed < 4; ++seed) {
    const Skeleton grown = grow_from_style(style, canvas(1400, 1400), grow, Rng(seed), Monitor{});
    for (const Node& node : grown.nodes()) {
      if (node.tag == 0) continue;
      ++copied;
      runs += node.parent == kNone || grown[node.parent].tag + 1 != node.tag;
    }
  }
  REQUIRE(copied > 400);
  return static_cast<double>(copied) / std::max(1, runs);
}

}  // namespace

// Paper 002, figure 3: one candidate and a long history copy the exemplar; two candidates deviate from it now and then; a
// short history and short pieces keep little of it.
TEST_CASE("history extension and candidates act as in the paper's parameter study") {
  const double exact = mean_run(8, 48, 1), deviating = mean_run(8, 48, 2), unlike = mean_run(2, 2, 2);
  INFO("mean runs " << exact << ' ' << deviating << ' ' << unlike);
  CHECK(exact > 3.0 * deviating);
  CHECK(deviating > 2.0 * unlike);
}
