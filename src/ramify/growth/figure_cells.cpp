// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/growth/figure_cells.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

#include "ramify/core/error.h"
#include "ramify/core/parallel.h"
#include "ramify/image/filter.h"
#include "ramify/image/nearest_seed.h"

namespace ramify {
namespace {

constexpr int kSmallestIsland = 3;  // px

// Distinct pixels of every island, drawn at random.
std::vector<Vec2> random_sites(const std::vector<FigureIsland>& islands, int width, const Rng& rng) {
  std::vector<Vec2> sites;
  for (std::size_t i = 0; i < islands.size(); ++i) {
    Rng own = rng.child("sites", i);
    std::vector<int> pixels = islands[i].pixels;
    for (int k = 0; k < islands[i].points; ++k) {
      std::swap(pixels[k], pixels[k + own.below(static_cast<int>(pixels.size()) - k)]);
      sites.emplace_back(pixels[k] % width, pixels[k] / width);
    }
  }
  return sites;
}

// The middle of every cell, from whole sums: the same in any order of adding.
struct Centroids {
  std::vector<double> x, y;
  std::vector<int> count;  // pixels
};

Centroids measure_centroids(const LabelImage& label, std::size_t cells, const Mask& shape = {}) {
  struct Sum {
    std::int64_t x = 0, y = 0;
    std::int32_t count = 0;
  };
  constexpr int kStrips = 4;
  std::vector<std::vector<Sum>> sums(kStrips, std::vector<Sum>(cells));
  parallel_for(kStrips, [&](int strip) {
    std::vector<Sum>& own = sums[static_cast<std::size_t>(strip)];
    for (int y = label.height() * strip / kStrips; y < label.height() * (strip + 1) / kStrips; ++y) {
      const std::int32_t* row = label.row(y);
      for (int x = 0, end = 0; x < label.width(); x = end) {  // cells are runs of pixels
        const auto counts = [&](int at) { return row[at] == row[x] && (shape.empty() || shape(at, y)); };
        for (end = x; end < label.width() && counts(end);) ++end;
        const std::int64_t count = end - x;
        end += count == 0;
        if (count == 0 || row[x] < 0 || row[x] >= static_cast<int>(cells)) continue;
        Sum& sum = own[static_cast<std::size_t>(row[x])];
        sum.x += count * (2 * x + count - 1) / 2;
        sum.y += count * y;
        sum.count += static_cast<std::int32_t>(count);
      }
    }
  });
  Centroids c{std::vector<double>(cells, 0.0), std::vector<double>(cells, 0.0), std::vector<int>(cells, 0)};
  for (std::size_t i = 0; i < cells; ++i) {
    Sum all;
    for (const std::vector<Sum>& part : sums) all.x += part[i].x, all.y += part[i].y, all.count += part[i].count;
    c.count[i] = all.count;
    if (all.count > 0) c.x[i] = static_cast<double>(all.x) / all.count, c.y[i] = static_cast<double>(all.y) / all.count;
  }
  return c;
}

// Every site goes to the pixel of its cell nearest to the cell's middle, so it stays in the shape.
void move_within_cells(const LabelImage& label, std::vector<Vec2>& sites) {
  const Centroids c = measure_centroids(label, sites.size());
  std::vector<double> nearest(sites.size(), 1e300);
  for (int y = 0; y < label.height(); ++y) {
    for (int x = 0; x < label.width(); ++x) {
      const int cell = label(x, y);
      if (cell == kNone) continue;
      const double dx = x - c.x[cell], dy = y - c.y[cell], distance = dx * dx + dy * dy;
      if (distance < nearest[cell]) nearest[cell] = distance, sites[cell] = Vec2(x, y);
    }
  }
}

void label_geodesically(FigureCells& cells, const Monitor& monitor) {
  std::vector<int> sources, cell_of(static_cast<std::size_t>(cells.lattice.count()), kNone);
  for (std::size_t i = 0; i < cells.sites.size(); ++i) {
    sources.push_back(cells.lattice.node(static_cast<int>(cells.sites[i].x()), static_cast<int>(cells.sites[i].y())));
    cell_of[sources.back()] = static_cast<int>(i);
  }
  cells.plan = plan_paths(cells.lattice, sources, {}, monitor);
  const std::vector<int> nearest = nearest_sources(cells.plan, cells.lattice);
  cells.label = LabelImage(Size{cells.lattice.width, cells.lattice.height}, kNone);
  for (std::size_t i = 0; i < nearest.size(); ++i) {
    if (nearest[i] != kNone) cells.label.pixels()[i] = cell_of[nearest[i]];
  }
}

// Of the shape's pixels those beside one that is not, or at the picture's edge; row by row.
std::vector<std::pair<int, int>> border_pixels(const Mask& shape) {
  std::vector<std::pair<int, int>> border;
  for (int y = 0; y < shape.height(); ++y) {
    for (int x = 0; x < shape.width(); ++x) {
      if (!shape(x, y)) continue;
      const bool inner = x > 0 && y > 0 && x + 1 < shape.width() && y + 1 < shape.height() && shape(x - 1, y) && shape(x + 1, y) &&
                         shape(x, y - 1) && shape(x, y + 1);
      if (!inner) border.emplace_back(x, y);
    }
  }
  return border;
}

std::vector<Vec2> border_sites(const Mask& shape, int count, const Rng& rng) {
  std::vector<Vec2> border;
  for (const auto& [x, y] : border_pixels(shape)) border.emplace_back(x, y);
  Rng own = rng.child("border");
  own.shuffle(border);
  // By rejection, or gaps would let cells out.
  const double apart = 0.7 * static_cast<double>(border.size()) / std::max(1, count);
  std::vector<Vec2> out;
  for (const Vec2& p : border) {
    if (static_cast<int>(out.size()) >= count) break;
    const auto near = [&](const Vec2& q) { return (p - q).squaredNorm() < apart * apart; };
    if (std::none_of(out.begin(), out.end(), near)) out.push_back(p);
  }
  return out;
}

// How many sets of cells hang together.
int parts_of(const LabelImage& label, int cells) {
  std::vector<int> leader(static_cast<std::size_t>(cells));
  std::iota(leader.begin(), leader.end(), 0);
  const auto find = [&](int a) {
    while (leader[a] != a) a = leader[a] = leader[leader[a]];
    return a;
  };
  int parts = cells;
  const auto join = [&](int a, int b) {
    if (a < 0 || b < 0 || a == b) return;
    const int la = find(a), lb = find(b);
    if (la != lb) leader[std::max(la, lb)] = std::min(la, lb), --parts;
  };
  for (int y = 0; y < label.height(); ++y) {
    for (int x = 0; x < label.width(); ++x) {
      if (x + 1 < label.width()) join(label(x, y), label(x + 1, y));
      if (y + 1 < label.height()) join(label(x, y), label(x, y + 1));
    }
  }
  return parts;
}

}  // namespace

std::vector<FigureIsland> find_islands(Mask& shape, int points, const Monitor& monitor) {
  int count = 0;
  const LabelImage label = label_components(shape, false, count);
  std::vector<FigureIsland> all(static_cast<std::size_t>(count)), kept;
  for (std::size_t i = 0; i < label.pixels().size(); ++i) {
    if (label.pixels()[i] != kNone) all[static_cast<std::size_t>(label.pixels()[i])].pixels.push_back(static_cast<int>(i));
  }
  double area = 0.0;
  int dropped = 0;
  for (FigureIsland& island : all) {
    if (island.pixels.size() < kSmallestIsland) {
      for (const int p : island.pixels) shape.pixels()[static_cast<std::size_t>(p)] = 0;
      ++dropped;
      continue;
    }
    area += static_cast<double>(island.pixels.size());
    kept.push_back(std::move(island));
  }
  if (kept.empty()) {
    throw InputError("", all.empty() ? "the shape is empty: there is nothing to fill; paint it black on white, or white on black with --invert"
                                     : "all " + std::to_string(dropped) + " parts of the shape are smaller than 3 px: there is nothing to fill");
  }
  if (dropped > 0) monitor.note(std::to_string(dropped) + " parts of the shape smaller than 3 px are left out, " + std::to_string(kept.size()) + " are filled");
  for (FigureIsland& island : kept) {
    const double size = static_cast<double>(island.pixels.size());
    const int least = size >= 12.0 ? 3 : 1;
    island.points = std::clamp(static_cast<int>(std::lround(points * size / area)), least, std::max(1, static_cast<int>(size / 2.0)));
  }
  return kept;
}

Mask bridged(const Mask& shape, double width) {
  int count = 0;
  const LabelImage component = label_components(shape, false, count);
  if (count < 2) return shape;
  const std::vector<std::pair<int, int>> seeds =
      border_pixels(shape);  // what is nearest to anything outside of its part
  const LabelImage nearest = nearest_seeds(seeds, shape.size());
  struct Gap {
    double length;
    int a, b;  // seeds
  };
  std::vector<Gap> gaps;
  const auto component_of = [&](int seed) { return component(seeds[seed].first, seeds[seed].second); };
  const auto consider = [&](int a, int b) {
    if (component_of(a) == component_of(b)) return;
    gaps.push_back({std::hypot(seeds[a].first - seeds[b].first, seeds[a].second - seeds[b].second), a, b});
  };
  for (int y = 0; y < shape.height(); ++y) {
    for (int x = 0; x < shape.width(); ++x) {
      if (x + 1 < shape.width()) consider(nearest(x, y), nearest(x + 1, y));
      if (y + 1 < shape.height()) consider(nearest(x, y), nearest(x, y + 1));
    }
  }
  std::sort(gaps.begin(), gaps.end(), [](const Gap& p, const Gap& q) { return std::tie(p.length, p.a, p.b) < std::tie(q.length, q.a, q.b); });
  std::vector<int> leader(static_cast<std::size_t>(count));
  std::iota(leader.begin(), leader.end(), 0);
  const auto find = [&](int a) {
    while (leader[a] != a) a = leader[a] = leader[leader[a]];
    return a;
  };
  Mask out = shape;
  for (const Gap& gap : gaps) {
    const int a = find(component_of(gap.a)), b = find(component_of(gap.b));
    if (a == b) continue;
    leader[std::max(a, b)] = std::min(a, b);
    const Vec2 from(seeds[gap.a].first, seeds[gap.a].second), to(seeds[gap.b].first, seeds[gap.b].second);
    const double radius = std::max(0.5, 0.5 * width);
    const int reach = static_cast<int>(std::ceil(radius));
    const int steps = static_cast<int>(std::ceil(4.0 * gap.length)) + 1;
    int px = seeds[gap.a].first, py = seeds[gap.a].second;
    for (int i = 0; i <= steps; ++i) {
      const Vec2 p = from + (to - from) * (static_cast<double>(i) / steps);
      const int cx = static_cast<int>(std::lround(p.x())), cy = static_cast<int>(std::lround(p.y()));
      if (cx != px && cy != py) out(cx, py) = 255;  // a diagonal step would not hang together
      px = cx, py = cy;
      for (int y = std::max(0, cy - reach); y <= std::min(shape.height() - 1, cy + reach); ++y) {
        for (int x = std::max(0, cx - reach); x <= std::min(shape.width() - 1, cx + reach); ++x) {
          if ((x == cx && y == cy) || (Vec2(x, y) - p).norm() <= radius - 0.25) out(x, y) = 255;
        }
      }
    }
  }
  return out;
}

FigureCells geodesic_cells(const Mask& shape, const std::vector<FigureIsland>& islands, int evenness, const Rng& rng, const Monitor& monitor) {
  FigureCells cells;
  cells.sites = random_sites(islands, shape.width(), rng);
  cells.lattice.width = shape.width();
  cells.lattice.height = shape.height();
  cells.lattice.cut_corners = false;
  cells.lattice.weights = HashedWeights{0, 1.0, 0.0, false};
  cells.lattice.allowed.assign(shape.pixels().begin(), shape.pixels().end());
  for (int i = 0; i <= evenness; ++i) {
    monitor.report(static_cast<double>(i) / (evenness + 1));
    label_geodesically(cells, monitor);
    if (i < evenness) move_within_cells(cells.label, cells.sites);
  }
  return cells;
}

LabelImage euclidean_labels(const std::vector<Vec2>& sites, const std::vector<Vec2>& fixed, Size size) {
  std::vector<std::pair<int, int>> seeds;
  for (const std::vector<Vec2>* part : {&sites, &fixed}) {
    for (const Vec2& p : *part) {
      seeds.emplace_back(std::clamp(static_cast<int>(std::lround(p.x())), 0, size.width - 1),
                         std::clamp(static_cast<int>(std::lround(p.y())), 0, size.height - 1));
    }
  }
  return nearest_seeds(seeds, size);
}

void move_to_centroids(const LabelImage& label, std::vector<Vec2>& sites, const Mask& shape) {
  const Centroids c = measure_centroids(label, sites.size(), shape);
  for (std::size_t i = 0; i < sites.size(); ++i) {
    if (c.count[i] > 0) sites[i] = Vec2(c.x[i], c.y[i]);
  }
}

FigureCells euclidean_cells(const Mask& shape, const std::vector<FigureIsland>& islands, int evenness, int border_points, const Rng& rng,
                            const Monitor& monitor) {
  const std::vector<Vec2> start = random_sites(islands, shape.width(), rng);
  for (int border = border_points;; border /= 2) {
    FigureCells cells;
    cells.sites = start;
    const std::vector<Vec2> fixed = border_sites(shape, border, rng);
    for (int i = 0; i <= evenness; ++i) {
      monitor.report(static_cast<double>(i) / (evenness + 1));
      cells.label = euclidean_labels(cells.sites, fixed, shape.size());
      if (i < evenness) move_to_centroids(cells.label, cells.sites, shape);
    }
    for (std::int32_t& label : cells.label.pixels()) {
      if (label >= static_cast<int>(cells.sites.size())) label = kNone;
    }
    const int parts = parts_of(cells.label, static_cast<int>(cells.sites.size()));
    if (parts <= static_cast<int>(islands.size()) || border == 0) return cells;
    monitor.note("with " + std::to_string(border) + " points on the border the cells fall into " + std::to_string(parts) + " parts; trying " +
                 std::to_string(border / 2));
  }
}

}  // namespace ramify
