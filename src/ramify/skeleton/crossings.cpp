// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <cstdint>

#include "ramify/geometry/segment.h"
#include "ramify/skeleton/statistics.h"

namespace ramify {
namespace {

constexpr int kMostCellsASide = 4096;

struct Entry {
  std::int64_t cell;
  int edge;  // child node
  friend bool operator<(const Entry& a, const Entry& b) { return a.cell != b.cell ? a.cell < b.cell : a.edge < b.edge; }
};

}  // namespace

std::vector<std::pair<int, int>> find_crossings(const Skeleton& skeleton) {
  std::vector<std::pair<int, int>> found;
  Vec2 low = Vec2::Constant(1e300), high = -low;
  double length = 0.0;
  int edges = 0;
  for (const Node& node : skeleton.nodes()) {
    low = low.cwiseMin(node.xy()), high = high.cwiseMax(node.xy());
    if (node.parent == kNone) continue;
    length += (node.xy() - skeleton[node.parent].xy()).norm();
    ++edges;
  }
  if (edges < 2) return found;
  const double extent = (high - low).maxCoeff();
  const double cell = std::max({2.0 * length / edges, extent / kMostCellsASide, 1e-12});
  const auto column = [&](double v, double origin) { return static_cast<std::int64_t>(std::floor((v - origin) / cell)); };
  std::vector<Entry> entries;
  for (int i = 0; i < skeleton.count(); ++i) {
    if (skeleton[i].parent == kNone) continue;
    const Vec2 a = skeleton[i].xy(), b = skeleton[skeleton[i].parent].xy();
    const Vec2 from = a.cwiseMin(b), to = a.cwiseMax(b);
    for (auto y = column(from.y(), low.y()); y <= column(to.y(), low.y()); ++y) {
      for (auto x = column(from.x(), low.x()); x <= column(to.x(), low.x()); ++x) {
        // Cells of the bounding box that the edge passes by are left out.
        const Vec2 centre = low + cell * Vec2(static_cast<double>(x) + 0.5, static_cast<double>(y) + 0.5);
        if (nearest_on_segment(centre, a, b).distance <= 0.7072 * cell) entries.push_back({y * (kMostCellsASide + 2) + x, i});
      }
    }
  }
  std::sort(entries.begin(), entries.end());
  for (std::size_t start = 0, end = 0; start < entries.size(); start = end) {
    while (end < entries.size() && entries[end].cell == entries[start].cell) ++end;
    for (std::size_t p = start; p < end; ++p) {
      for (std::size_t q = p + 1; q < end; ++q) {
        const int i = entries[p].edge, k = entries[q].edge, pi = skeleton[i].parent, pk = skeleton[k].parent;
        if (pi == pk || pi == k || i == pk) continue;
        if (segment_relation(skeleton[i].xy(), skeleton[pi].xy(), skeleton[k].xy(), skeleton[pk].xy()) == SegmentRelation::Crossing) {
          found.emplace_back(i, k);
        }
      }
    }
  }
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
  return found;
}

}  // namespace ramify
