// SPDX-License-Identifier: GPL-3.0-or-later
// Growth that follows what is painted or drawn: density maps, guides, masks (PICTURES 9; paper 002, section 4.5).
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "ramify/geometry/polyline.h"
#include "ramify/growth/course.h"
#include "ramify/growth/grow.h"
#include "ramify/growth/mask_strokes.h"
#include "ramify/skeleton/branches.h"
#include "support/growth_inputs.h"
#include "support/skeleton_checks.h"

using namespace ramify;
using test::canvas;
using test::dense_tree;
using test::style_of;

namespace {

struct DensityFigures {
  int black_nodes = 0;
  double bright_length = 0.0;     // share of the length where the map is above one half
  double rank_correlation = 0.0;  // of map and length over 64 px cells
  double white_reached = 0.0;     // share of the white within 2 rho of a branch
};

std::vector<double> ranks_of(const std::vector<double>& values) {
  std::vector<double> ranks;
  for (const double v : values) {
    double below = 0.0, equal = 0.0;
    for (const double w : values) below += w < v, equal += w == v;
    ranks.push_back(below + 0.5 * equal);
  }
  return ranks;
}

double correlation(const std::vector<double>& a, const std::vector<double>& b) {
  double ma = 0, mb = 0, ab = 0, aa = 0, bb = 0;
  for (std::size_t i = 0; i < a.size(); ++i) ma += a[i] / a.size(), mb += b[i] / b.size();
  for (std::size_t i = 0; i < a.size(); ++i) {
    ab += (a[i] - ma) * (b[i] - mb);
    aa += (a[i] - ma) * (a[i] - ma);
    bb += (b[i] - mb) * (b[i] - mb);
  }
  return ab / std::sqrt(aa * bb);
}

// The figures of PICTURES 9, from the skeleton and the map alone.
DensityFigures density_figures(const Skeleton& s, const ScalarImage& map, double two_rho) {
  DensityFigures figures;
  const int columns = map.width() / 64, rows = map.height() / 64;
  std::vector<double> length(columns * rows, 0.0), mean(columns * rows, 0.0);
  for (int y = 0; y < rows * 64; ++y) {
    for (int x = 0; x < columns * 64; ++x) mean[y / 64 * columns + x / 64] += map(x, y);
  }
  double all = 0.0, bright = 0.0;
  for (const Node& node : s.nodes()) {
    const int x = static_cast<int>(std::lround(node.position.x())),
              y = static_cast<int>(std::lround(node.position.y()));
    figures.black_nodes += map.contains(x, y) && map(x, y) <= 8.0f / 255.0f;
    if (node.parent == kNone) continue;
    const double edge = (node.xy() - s[node.parent].xy()).norm();
    all += edge;
    bright += map.clamped(x, y) > 0.5f ? edge : 0.0;
    if (x >= 0 && y >= 0 && x / 64 < columns && y / 64 < rows) length[y / 64 * columns + x / 64] += edge;
  }
  figures.bright_length = bright / all;
  figures.rank_correlation = correlation(ranks_of(mean), ranks_of(length));
  double white = 0.0, reached = 0.0;
  for (int y = 0; y < map.height(); y += 3) {
    for (int x = 0; x < map.width(); x += 3) {
      if (map(x, y) <= 0.5f) continue;
      white += 1.0;
      for (const Node& node : s.nodes()) {
        if ((node.xy() - Vec2(x, y)).norm() - node.radius <= two_rho) {
          reached += 1.0;
          break;
        }
      }
    }
  }
  figures.white_reached = reached / white;
  return figures;
}

bool in_box(int x, int y, int x0, int y0, int x1, int y1) {
  return x >= x0 && x < x1 && y >= y0 && y < y1;
}

// A letter R, 500 px high, of bars and a bow.
ScalarImage letter_r() {
  ScalarImage map(576, 640, 0.0f);
  for (int y = 0; y < 640; ++y) {
    for (int x = 0; x < 576; ++x) {
      const double bow = std::hypot((x - 300) / 1.25, y - 200.0);
      const bool stem = in_box(x, y, 110, 70, 210, 570);
      const bool curve = x >= 200 && bow > 55 && bow < 130;
      const bool leg = y >= 310 && y < 570 && std::abs(x - (260 + 0.6 * (y - 310))) < 60;
      map(x, y) = stem || curve || leg ? 1.0f : 0.0f;
    }
  }
  return map;
}

}  // namespace

TEST_CASE("a painted letter is filled and nothing else") {
  const Style style = style_of({}, 11);
  GrowthTarget target = canvas(576, 640);
  target.density = letter_r();
  for (std::uint64_t seed = 0; seed < 3; ++seed) {
    const Skeleton grown = grow_from_style(style, target, GrowOptions{}, Rng(seed), Monitor{});
    const DensityFigures figures = density_figures(grown, target.density, 2.0 * style.hierarchy.spacing);
    CHECK(figures.black_nodes == 0);
    CHECK(figures.bright_length >= 0.9);
    CHECK(figures.rank_correlation >= 0.9);
    CHECK(figures.white_reached >= 0.9);
    CHECK(test::crossing_pairs(grown) == 0);
  }
}

TEST_CASE("a soft map is followed in rank") {
  const Style style = style_of({}, 12);
  GrowthTarget target = canvas(704, 512);
  target.density = ScalarImage(704, 512);
  for (int y = 0; y < 512; ++y) {
    for (int x = 0; x < 704; ++x)
      target.density(x, y) = static_cast<float>(x / 704.0 * (0.6 + 0.4 * std::sin(y / 90.0)));
  }
  for (std::uint64_t seed = 0; seed < 3; ++seed) {
    const Skeleton grown = grow_from_style(style, target, GrowOptions{}, Rng(seed), Monitor{});
    const DensityFigures figures = density_figures(grown, target.density, 2.0 * style.hierarchy.spacing);
    CHECK(figures.black_nodes == 0);
    CHECK(figures.rank_correlation >= 0.75);
  }
}

TEST_CASE("an island of white gets a root of its own") {
  GrowthTarget target = canvas(640, 300);
  target.density = ScalarImage(640, 300, 0.0f);
  for (int y = 40; y < 260; ++y) {
    for (int x = 0; x < 640; ++x) target.density(x, y) = x < 280 || x > 360 ? 1.0f : 0.0f;
  }
  const Skeleton grown = grow_from_style(style_of(dense_tree(), 13), target, GrowOptions{}, Rng(1), Monitor{});
  double left = 0.0, right = 0.0;
  for (const Node& node : grown.nodes()) (node.position.x() < 320 ? left : right) += 1.0;
  CHECK(left > 50);
  CHECK(right > 0.4 * left);
}

TEST_CASE("a guided main branch stays in its valley") {
  test::WavyTree tree;
  tree.wave = 0.35;
  const Style style = style_of(tree, 14);
  GrowthTarget target = canvas(600, 500);
  target.guide_paths.resize(1);
  for (int i = 0; i <= 100; ++i) target.guide_paths.back().emplace_back(20 + 5.4 * i, 250 + 140 * std::sin(i * 0.06));
  GrowOptions options;
  options.guide_width = 25.0;
  options.levels = 1;
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    const Skeleton grown = grow_from_style(style, target, options, Rng(seed), Monitor{});
    int beyond = 0;
    double farthest_x = 0.0;
    for (const Node& node : grown.nodes()) {
      double nearest = 1e300;
      for (const Vec2& p : target.guide_paths[0]) nearest = std::min(nearest, (p - node.xy()).norm());
      beyond += nearest > 2.0 * options.guide_width;
      farthest_x = std::max(farthest_x, node.position.x());
    }
    CHECK(beyond <= 0.05 * grown.count());
    CHECK(farthest_x > 480.0);
  }
}

TEST_CASE("a guided main branch keeps the exemplar's bends") {
  test::WavyTree tree;
  tree.wave = 0.35;
  const Style style = style_of(tree, 14);
  // R.m.s. turn between chords over half a feature, rad: of what makes a line look bent.
  const auto bends = [&](const std::vector<Skeleton>& skeletons) {
    const auto half = static_cast<std::size_t>(style.bending.extension / 2);
    double squares = 0.0, count = 0.0;
    for (const Skeleton& skeleton : skeletons) {
      const Branch main = branch_tree(skeleton).branches.front();
      std::vector<Vec2> points;
      for (std::size_t i = 0; i < main.nodes.size(); i += half) points.push_back(skeleton[main.nodes[i]].xy());
      for (const double turn : turning_angles(points)) squares += turn * turn, count += 1.0;
    }
    return std::sqrt(squares / count);
  };
  const Vec2 start(30, 150), end(660, 330), across = perpendicular(end - start).normalized();
  std::vector<Skeleton> guided, free;
  double far = 0.0, nodes = 0.0;
  GrowOptions options;
  options.levels = 1;
  for (std::uint64_t seed = 0; seed < 6; ++seed) {
    GrowthTarget target = canvas(700, 500);
    free.push_back(grow_from_style(style, target, options, Rng(seed), Monitor{}));
    target.guide_paths = {{start, end}};
    guided.push_back(grow_from_style(style, target, options, Rng(seed), Monitor{}));
    for (const Node& node : guided.back().nodes()) far += std::abs((node.xy() - start).dot(across)), nodes += 1.0;
  }
  INFO("guided " << bends(guided) << " rad, free " << bends(free) << " rad; " << far / nodes << " px off");
  CHECK(bends(guided) > 0.8 * bends(free));
  CHECK(far / nodes < 2.0 * bend_amplitude(style.bending));
}

TEST_CASE("a thick main branch whose guide ends in the open comes to a point") {
  test::WavyTree tree = dense_tree();
  tree.radius = 12.0;
  tree.size = {400, 400};  // the main branch leaves it while it is thick
  const Style style = style_of(tree, 11);
  const double there = 0.66 * tree.radius;  // px, the exemplar's main as far along
  GrowOptions options;
  options.levels = 1;
  for (std::uint64_t seed = 0; seed < 3; ++seed) {
    GrowthTarget target = canvas(700, 500);
    target.guide_paths = {{Vec2(0, 250), Vec2(250, 255)}};
    const Skeleton grown = grow_from_style(style, target, options, Rng(seed), Monitor{});
    const Polyline line = branch_polyline(grown, branch_tree(grown).branches.front());
    double way = 0.0;  // px from the tip
    for (std::size_t i = line.points.size() - 1; i-- > 0;) {
      way += (line.points[i + 1] - line.points[i]).norm();
      CAPTURE(seed, way / there, line.radii[i] / there);
      if (way < 4.0 * there) CHECK(line.radii[i] < 0.25 * there);
      if (way < 8.0 * there) CHECK(line.radii[i] < 0.5 * there);
    }
    CHECK(line.radii.back() < 0.25 * there);
    CHECK(line.points.back().x() > 200.0);
  }
}

TEST_CASE("a ring painted in a mask is one line all the way round") {
  const Vec2 center(150, 140);
  ScalarImage map(300, 280, 0.0f);
  for (int y = 0; y < map.height(); ++y) {
    for (int x = 0; x < map.width(); ++x) {
      const double r = (Vec2(x, y) - center).norm();
      map(x, y) = std::abs(r - 90.0) < 6.0 ? 1.0f : 0.0f;
    }
  }
  for (int x = 60; x < 64; ++x) map(x, 140) = 0.0f;  // a speck within the stroke
  const std::vector<std::vector<Vec2>> lines = mask_strokes(map);
  REQUIRE(lines.size() == 1);
  double turned = 0.0;
  for (std::size_t i = 1; i < lines[0].size(); ++i) {
    CHECK(std::abs((lines[0][i] - center).norm() - 90.0) < 6.0);  // within the stroke
    turned += wrap_angle(angle_of(lines[0][i] - center) - angle_of(lines[0][i - 1] - center));
  }
  CHECK(std::abs(turned) > 2.0 * kPi * 0.93);
}
