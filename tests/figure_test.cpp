// SPDX-License-Identifier: GPL-3.0-or-later
#include <catch2/catch.hpp>

#include <algorithm>
#include <deque>
#include <set>

#include "ramify/core/error.h"
#include "ramify/growth/figure.h"
#include "ramify/growth/figure_cells.h"
#include "ramify/image/filter.h"
#include "ramify/image/nearest_seed.h"
#include "ramify/paint/paint.h"
#include "ramify/skeleton/draw.h"

using namespace ramify;

namespace {

// Rooms joined by corridors one pixel wide, with holes, rings and diagonal staircases.
Mask maze(std::uint64_t seed) {
  Rng rng = Rng(seed).child("maze");
  Mask mask(40 + rng.below(60), 40 + rng.below(60));
  const auto put = [&](int x, int y) {
    if (mask.contains(x, y)) mask(x, y) = 255;
  };
  const auto spot = [&] { return std::pair{rng.below(mask.width()), rng.below(mask.height())}; };
  for (int room = 2 + rng.below(5); room > 0; --room) {
    const auto [cx, cy] = spot();
    const double a = rng.uniform(3, 14), b = rng.uniform(3, 14), hole = rng.uniform() < 0.4 ? rng.uniform(0.2, 0.7) : 0.0;
    for (int y = 0; y < mask.height(); ++y) {
      for (int x = 0; x < mask.width(); ++x) {
        const double d = std::hypot((x - cx) / a, (y - cy) / b);
        if (d <= 1.0 && d >= hole) put(x, y);
      }
    }
  }
  for (int corridor = 3 + rng.below(8); corridor > 0; --corridor) {
    auto [x, y] = spot();
    const auto [tx, ty] = spot();
    while (x != tx || y != ty) {
      put(x, y);
      if (x != tx && (y == ty || rng.uniform() < 0.5)) x += x < tx ? 1 : -1;
      else y += y < ty ? 1 : -1;
    }
  }
  return mask;
}

// The shape and all pixels that touch it, by side or corner: what lies within 1 px of it.
Mask with_rim(const Mask& shape) {
  Mask out(shape.size());
  for (int y = 0; y < shape.height(); ++y) {
    for (int x = 0; x < shape.width(); ++x) {
      for (int dy = -1; dy <= 1; ++dy) {
        for (int dx = -1; dx <= 1; ++dx) {
          if (shape.contains(x + dx, y + dy) && shape(x + dx, y + dy)) out(x, y) = 255;
        }
      }
    }
  }
  return out;
}

Mask ring(int size) {
  Mask mask(size, size);
  for (int y = 0; y < size; ++y) {
    for (int x = 0; x < size; ++x) {
      const double d = std::hypot(x - size / 2.0, y - size / 2.0);
      if (d < 0.48 * size && d > 0.2 * size) mask(x, y) = 255;
    }
  }
  return mask;
}

int painted_outside(const Mask& allowed, const Mask& painted, int above) {
  int count = 0;
  for (std::size_t i = 0; i < painted.pixels().size(); ++i) count += painted.pixels()[i] > above && !allowed.pixels()[i];
  return count;
}

}  // namespace

TEST_CASE("every cell of 200 mazes is reached and nothing is drawn outside") {
  PaintOptions ink;
  ink.stroke.smoothing = 0.0;
  ink.stroke.flow = 0.0;
  int straightened = 0;
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    INFO("maze " << seed);
    FigureOptions options;
    options.lines = seed % 5 == 0 ? FigureLines::Straight : FigureLines::Curved;
    options.tree = static_cast<FigureTree>(seed % 4);
    const FilledFigure figure = grow_figure(maze(seed), options, Rng(seed), Monitor());
    CHECK(figure.reached == static_cast<int>(figure.sites.size()));
    const Mask allowed = with_rim(figure.region);
    CHECK(painted_outside(allowed, draw_branch_mask(figure.skeleton, figure.region.size()), 0) == 0);
    const PaintScene scene = prepare_painting(figure.skeleton, ink, Rng(1), Monitor());
    const Raster raster = rasterize(draw_painting(scene, 1.0, Monitor()), {figure.region.size()}, Monitor());
    CHECK(painted_outside(allowed, raster.alpha, 3) == 0);
    straightened += figure.straightened;
  }
  CHECK(straightened > 0);  // the mazes are narrow enough to need it
}

TEST_CASE("one tree grows in every part and roots stand where they were asked for") {
  Mask mask(120, 60);
  for (int y = 10; y < 50; ++y) {
    for (int x = 0; x < 120; ++x) mask(x, y) = (x > 5 && x < 50) || (x > 70 && x < 115) ? 255 : 0;
  }
  for (const char* start : {"bottom", "top"}) {
    FigureOptions options;
    options.start = start;
    const FilledFigure figure = grow_figure(mask, options, Rng(2), Monitor());
    CHECK(figure.islands == 2);
    int roots = 0;
    for (const Node& node : figure.skeleton.nodes()) {
      if (node.parent != kNone) continue;
      ++roots;
      CHECK((std::string(start) == "top" ? node.xy().y() < 22 : node.xy().y() > 38));
    }
    CHECK(roots == 2);
  }
  FigureOptions joined;
  joined.join = FigureJoin::Bridges;
  const FilledFigure figure = grow_figure(mask, joined, Rng(2), Monitor());
  CHECK(figure.islands == 1);
  CHECK(figure.reached == static_cast<int>(figure.sites.size()));
  int count = 0;
  label_components(figure.region, false, count);
  CHECK(count == 1);
}

TEST_CASE("the steps tree has the fewest steps and every tree spans") {
  for (const FigureTree kind : {FigureTree::Steps, FigureTree::Shortest, FigureTree::Random, FigureTree::Minimal}) {
    FigureOptions options;
    options.tree = kind;
    options.points = 300;
    const FilledFigure figure = grow_figure(ring(160), options, Rng(4), Monitor());
    const int n = static_cast<int>(figure.sites.size());
    std::vector<std::set<int>> neighbours(static_cast<std::size_t>(n));
    for (int y = 0; y < 160; ++y) {
      for (int x = 0; x < 160; ++x) {
        for (const auto& [dx, dy] : {std::pair{1, 0}, {0, 1}}) {
          if (!figure.cell.contains(x + dx, y + dy)) continue;
          const int a = figure.cell(x, y), b = figure.cell(x + dx, y + dy);
          if (a != b && a != kNone && b != kNone) neighbours[a].insert(b), neighbours[b].insert(a);
        }
      }
    }
    std::vector<int> steps(static_cast<std::size_t>(n), -1);
    std::deque<int> open;
    for (int i = 0; i < n; ++i) {
      if (figure.parents[i] == kNone) steps[i] = 0, open.push_back(i);
      else CHECK(neighbours[i].count(figure.parents[i]) == 1);
    }
    CHECK(open.size() == 1);
    for (; !open.empty(); open.pop_front()) {
      for (const int j : neighbours[open.front()]) {
        if (steps[j] < 0) steps[j] = steps[open.front()] + 1, open.push_back(j);
      }
    }
    for (int i = 0; i < n; ++i) {
      int own = 0;
      for (int at = i; figure.parents[at] != kNone; at = figure.parents[at]) REQUIRE(++own < n);
      CHECK(own >= steps[i]);
      if (kind == FigureTree::Steps) CHECK(own == steps[i]);
    }
  }
}

TEST_CASE("lines hardly swell away from the root and add up where they meet") {
  FigureOptions options;
  options.points = 400;
  const FilledFigure figure = grow_figure(ring(240), options, Rng(1), Monitor());
  double root = 0.0, twig = 1e9;
  for (const Node& node : figure.skeleton.nodes()) {
    if (node.parent == kNone) root = node.radius;
    else CHECK(node.radius <= figure.skeleton[node.parent].radius + 0.031 * (node.xy() - figure.skeleton[node.parent].xy()).norm());
    twig = std::min(twig, node.radius);
  }
  CHECK(root > 4.0 * twig);
}

TEST_CASE("Lloyd spreads the points evenly") {
  const auto spread = [](int evenness) {
    FigureOptions options;
    options.points = 200;
    options.evenness = evenness;
    const FilledFigure figure = grow_figure(ring(200), options, Rng(3), Monitor());
    std::vector<int> area(figure.sites.size(), 0);
    for (const std::int32_t cell : figure.cell.pixels()) {
      if (cell != kNone) ++area[cell];
    }
    double sum = 0, square = 0;
    for (const int a : area) sum += a, square += static_cast<double>(a) * a;
    const double mean = sum / static_cast<double>(area.size());
    return std::sqrt(square / static_cast<double>(area.size()) - mean * mean) / mean;
  };
  const double ragged = spread(0), even = spread(5), more = spread(20);
  CHECK(even < 0.6 * ragged);
  CHECK(more <= even + 0.02);
}

TEST_CASE("the paper's cells fill a wide shape too") {
  FigureOptions options;
  options.cells = FigureCellKind::Euclidean;
  options.points = 250;
  const FilledFigure figure = grow_figure(ring(200), options, Rng(5), Monitor());
  CHECK(figure.reached == static_cast<int>(figure.sites.size()));
  int inside = 0;  // of the lines' middles: nothing holds their width back here
  for (const Node& node : figure.skeleton.nodes()) {
    inside += figure.region.clamped(static_cast<int>(std::lround(node.xy().x())), static_cast<int>(std::lround(node.xy().y()))) != 0;
  }
  CHECK(inside > 0.97 * figure.skeleton.count());
}

TEST_CASE("nearest seeds are those of brute force, the first of equally near ones") {
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    Rng rng = Rng(seed).child("seeds");
    const Size size{1 + rng.below(170), 1 + rng.below(150)};
    // Far apart, crowded, twice in a pixel, and on a grid, where nearly all pixels on borders are ties.
    const int grid = 1 + rng.below(12);
    std::vector<std::pair<int, int>> seeds;
    for (int i = 1 + rng.below(seed % 2 ? 12 : 400); i > 0; --i) {
      seeds.emplace_back(rng.below(size.width) / grid * grid, rng.below(size.height) / grid * grid);
    }
    const LabelImage label = nearest_seeds(seeds, size);
    int wrong = 0;
    for (int y = 0; y < size.height; ++y) {
      for (int x = 0; x < size.width; ++x) {
        const auto squared = [&](const std::pair<int, int>& s) {
          return (s.first - x) * (s.first - x) + (s.second - y) * (s.second - y);
        };
        const auto best = std::min_element(seeds.begin(), seeds.end(),
                                           [&](const auto& a, const auto& b) { return squared(a) < squared(b); });
        wrong += label(x, y) != best - seeds.begin();
      }
    }
    CHECK(wrong == 0);
  }
  CHECK(nearest_seeds({}, {4, 3}) == LabelImage(4, 3, kNone));
}

TEST_CASE("shapes without room are refused or filled as far as they go") {
  CHECK_THROWS_AS(grow_figure(Mask(20, 20), {}, Rng(1), Monitor()), InputError);
  Mask dot(9, 9);
  dot(4, 4) = 255;
  CHECK_THROWS_AS(grow_figure(dot, {}, Rng(1), Monitor()), InputError);
  Mask many(300, 200);
  int islands = 0;
  for (int y = 2; y + 6 < 200; y += 8) {
    for (int x = 2; x + 6 < 300; x += 12) {
      const int side = islands++ % 3 == 0 ? 1 : 4;  // a third are single pixels
      for (int k = 0; k < side * side; ++k) many(x + k % side, y + k / side) = 255;
    }
  }
  const Monitor monitor([](double, const std::string&) {});
  const FilledFigure figure = grow_figure(many, {}, Rng(1), monitor);
  CHECK(figure.islands == islands - (islands + 2) / 3);
  CHECK(figure.reached == static_cast<int>(figure.sites.size()));
  REQUIRE(monitor.notes().size() == 1);
  CHECK(monitor.notes().front().find(std::to_string((islands + 2) / 3) + " parts") == 0);
  FigureOptions bad;
  bad.start = "sideways";
  CHECK_THROWS_AS(grow_figure(many, bad, Rng(1), Monitor()), OptionError);
}

TEST_CASE("the same seed gives the same tree") {
  const FilledFigure a = grow_figure(ring(100), {}, Rng(1), Monitor()), b = grow_figure(ring(100), {}, Rng(1), Monitor()),
               c = grow_figure(ring(100), {}, Rng(2), Monitor());
  REQUIRE(a.skeleton.count() == b.skeleton.count());
  bool same = true;
  for (int i = 0; i < a.skeleton.count(); ++i) same = same && a.skeleton[i].position == b.skeleton[i].position;
  CHECK(same);
  CHECK(a.parents != c.parents);
}
