// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/graph/point_graph.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>

#include "ramify/core/options.h"
#include "ramify/core/parallel.h"
#include "ramify/graph/lattice_hash.h"

namespace ramify {
namespace {

// Points in cells of a regular grid, so that those near a place are found by walking few cells.
class PointGrid {
 public:
  PointGrid(const std::vector<Vec3>& points, double cell) : points_(points) {
    for (const Vec3& p : points) {
      low_ = low_.cwiseMin(p);
      high_ = high_.cwiseMax(p);
    }
    const Vec3 extent = points.empty() ? Vec3::Zero() : Vec3(high_ - low_);
    cell_ = std::max(cell, std::cbrt(std::max(extent.x(), 1e-9) * std::max(extent.y(), 1e-9) * std::max(extent.z(), 1e-9) / 3e7));
    cell_ = std::max(cell_, extent.maxCoeff() / 1e6);
    for (int a = 0; a < 3; ++a) cells_[a] = 1 + static_cast<int>(extent[a] / cell_);
    std::vector<std::pair<std::int64_t, int>> keyed;
    for (int i = 0; i < static_cast<int>(points.size()); ++i) keyed.push_back({key(place(points[i])), i});
    std::sort(keyed.begin(), keyed.end());
    for (const auto& [k, i] : keyed) {
      keys_.push_back(k);
      order_.push_back(i);
    }
  }

  using Place = std::array<int, 3>;
  Place place(const Vec3& p) const {
    Place out{};
    for (int a = 0; a < 3; ++a) out[a] = std::clamp(static_cast<int>((p[a] - low_[a]) / cell_), 0, cells_[a] - 1);
    return out;
  }
  double cell() const { return cell_; }
  int widest() const { return std::max({cells_[0], cells_[1], cells_[2]}); }

  // f(index) for all points in the cells whose largest offset from `at` along an axis is exactly `ring`.
  template <class F>
  void visit_ring(const Place& at, int ring, F&& f) const {
    for (int z = std::max(0, at[2] - ring); z <= std::min(cells_[2] - 1, at[2] + ring); ++z) {
      for (int y = std::max(0, at[1] - ring); y <= std::min(cells_[1] - 1, at[1] + ring); ++y) {
        const bool face = std::abs(z - at[2]) == ring || std::abs(y - at[1]) == ring;
        const int step = face || ring == 0 ? 1 : 2 * ring;
        for (int x = at[0] - ring; x <= at[0] + ring; x += step) {
          if (x >= 0 && x < cells_[0]) visit_cell({x, y, z}, f);
        }
      }
    }
  }

 private:
  std::int64_t key(const Place& p) const { return p[0] + static_cast<std::int64_t>(cells_[0]) * (p[1] + static_cast<std::int64_t>(cells_[1]) * p[2]); }
  template <class F>
  void visit_cell(const Place& p, F&& f) const {
    const std::int64_t k = key(p);
    for (auto it = std::lower_bound(keys_.begin(), keys_.end(), k); it != keys_.end() && *it == k; ++it) f(order_[it - keys_.begin()]);
  }

  const std::vector<Vec3>& points_;
  Vec3 low_ = Vec3::Constant(std::numeric_limits<double>::infinity()), high_ = -low_;
  double cell_ = 1.0;
  int cells_[3] = {1, 1, 1};
  std::vector<std::int64_t> keys_;
  std::vector<int> order_;
};

void check_points(const std::vector<Vec3>& points, double reach) {
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!points[i].allFinite()) throw InputError("", "point " + std::to_string(i) + " has a coordinate that is not a finite number");
  }
  if (!(reach > 0.0)) throw OptionError("reach", number_text(reach), "must be above 0");
}

// Which sector (plane) or octant (space) a direction lies in.
int sector_of(const Vec3& d, int sectors, bool plane) {
  if (!plane) return (d.x() < 0) + 2 * (d.y() < 0) + 4 * (d.z() < 0);
  const double turn = std::atan2(d.y(), d.x()) / (2.0 * kPi);
  return static_cast<int>(std::floor((turn < 0.0 ? turn + 1.0 : turn) * sectors)) % sectors;
}

// A cell that holds about one point.
double cell_for(const std::vector<Vec3>& points, bool plane) {
  if (points.empty()) return 1.0;
  Vec3 low = points.front(), high = points.front();
  for (const Vec3& p : points) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  const Vec3 e = (high - low).cwiseMax(1e-9);
  const double n = static_cast<double>(points.size());
  return plane ? std::sqrt(e.x() * e.y() / n) : std::cbrt(e.prod() / n);
}

std::vector<int> yao_neighbors(const PointGrid& grid, const std::vector<Vec3>& points, int i, int sectors, bool plane, double reach) {
  std::vector<int> best(static_cast<std::size_t>(sectors), kNone);
  std::vector<double> away(best.size(), reach);
  const auto at = grid.place(points[i]);
  for (int ring = 0; ring <= grid.widest(); ++ring) {
    // Whatever lies in this ring is at least this far; done when no sector can get anything nearer.
    const double nearest = (ring - 1) * grid.cell();
    if (ring > 0 && nearest > *std::max_element(away.begin(), away.end())) break;
    grid.visit_ring(at, ring, [&](int j) {
      const Vec3 d = points[j] - points[i];
      const double length = d.norm();
      if (j == i || length > reach) return;
      const int s = sector_of(d, sectors, plane);
      if (length < away[s] || (length == away[s] && (best[s] == kNone || j < best[s]))) {
        away[s] = length;
        best[s] = j;
      }
    });
  }
  std::erase(best, kNone);
  return best;
}

}  // namespace

PointGraph graph_from_pairs(const std::vector<Vec3>& points, std::vector<std::pair<int, int>> pairs) {
  const std::size_t given = pairs.size();
  for (std::size_t i = 0; i < given; ++i) pairs.push_back({pairs[i].second, pairs[i].first});
  std::erase_if(pairs, [](const auto& p) { return p.first == p.second; });
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  PointGraph graph;
  graph.points = points;
  graph.first.assign(points.size() + 1, 0);
  for (const auto& [from, to] : pairs) {
    ++graph.first[from + 1];
    graph.neighbor.push_back(to);
    graph.cost.push_back(std::max(static_cast<float>((points[to] - points[from]).norm()), 1e-6f));  // coinciding points
  }
  for (std::size_t i = 0; i < points.size(); ++i) graph.first[i + 1] += graph.first[i];
  return graph;
}

PointGraph yao_graph(const std::vector<Vec3>& points, int sectors, double reach) {
  check_points(points, reach);
  const bool plane = std::all_of(points.begin(), points.end(), [&](const Vec3& p) { return p.z() == points.front().z(); });
  if (sectors < 3) throw OptionError("sectors", std::to_string(sectors), "must be 3 or more");
  if (!plane && sectors != 8) throw OptionError("sectors", std::to_string(sectors), "must be 8, the octants, for points in space");
  const PointGrid grid(points, cell_for(points, plane));
  std::vector<std::vector<int>> chosen(points.size());
  parallel_for(static_cast<int>(points.size()), [&](int i) { chosen[i] = yao_neighbors(grid, points, i, sectors, plane, reach); }, 256);
  std::vector<std::pair<int, int>> pairs;
  for (int i = 0; i < static_cast<int>(points.size()); ++i) {
    for (const int j : chosen[i]) pairs.push_back({i, j});
  }
  return graph_from_pairs(points, std::move(pairs));
}

PointGraph threshold_graph(const std::vector<Vec3>& points, double reach) {
  check_points(points, reach);
  const PointGrid grid(points, reach);
  std::vector<std::vector<int>> near(points.size());
  parallel_for(static_cast<int>(points.size()), [&](int i) {
    const auto at = grid.place(points[i]);
    for (int ring = 0; ring <= 1; ++ring) {
      grid.visit_ring(at, ring, [&](int j) {
        if (j > i && (points[j] - points[i]).norm() <= reach) near[i].push_back(j);
      });
    }
  }, 256);
  std::vector<std::pair<int, int>> pairs;
  for (int i = 0; i < static_cast<int>(points.size()); ++i) {
    for (const int j : near[i]) pairs.push_back({i, j});
  }
  return graph_from_pairs(points, std::move(pairs));
}

PointGraph voronoi_graph(const std::vector<Vec3>& points, const std::vector<int>& label, int width, int height, int depth) {
  const std::size_t row = static_cast<std::size_t>(width), layer = row * height;
  if (label.size() != layer * depth) throw InputError("", "the labels do not have one entry for each pixel of the grid");
  std::vector<std::pair<int, int>> pairs;
  const auto touch = [&](std::size_t a, std::size_t b) {
    if (label[a] == label[b] || label[a] == kNone || label[b] == kNone) return;
    const std::pair<int, int> pair = std::minmax(label[a], label[b]);
    if (pairs.empty() || pairs.back() != pair) pairs.push_back(pair);
  };
  for (std::size_t i = 0; i < label.size(); ++i) {
    if (label[i] < kNone || label[i] >= static_cast<int>(points.size())) throw InputError("", "label " + std::to_string(label[i]) + " names no point");
    if ((i + 1) % row != 0) touch(i, i + 1);
    if (i % layer + row < layer) touch(i, i + row);
    if (i + layer < label.size()) touch(i, i + layer);
  }
  return graph_from_pairs(points, std::move(pairs));
}

PointGraph with_hashed_costs(PointGraph graph, std::uint64_t seed, double base, double spread) {
  if (!(base > 0.0 && spread >= 0.0)) throw OptionError("weight-base", number_text(base), "must be above 0, and the spread not below 0");
  for (int i = 0; i < graph.count(); ++i) {
    for (int e = graph.first[i]; e < graph.first[i + 1]; ++e) {
      const int j = graph.neighbor[e];
      const double length = std::max((graph.points[j] - graph.points[i]).norm(), 1e-6);
      graph.cost[e] = static_cast<float>(length * (base + spread * edge_hash01(seed, i, j)));
    }
  }
  return graph;
}

}  // namespace ramify
