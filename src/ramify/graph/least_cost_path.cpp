// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/graph/least_cost_path.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "ramify/graph/labels.h"

namespace ramify {
namespace {

constexpr int kDx[8] = {1, 1, 0, -1, -1, -1, 0, 1};
constexpr int kDy[8] = {0, 1, 1, 1, 0, -1, -1, -1};
constexpr std::uint8_t kNoStep = 255;

std::uint32_t step_cost(const LatticeCosts& costs, int x, int y, int k) {
  const int u = x + kDx[k], v = y + kDy[k];
  const double length = k % 2 == 0 ? 1.0 : std::sqrt(2.0);
  double cost = 0.5 * length * (costs.cost(x, y) + costs.cost(u, v));
  if (!costs.tangent.empty()) {
    const Eigen::Vector2f t = costs.tangent(u, v);
    const double along = std::abs(t.x() * kDx[k] + t.y() * kDy[k]) / length;
    cost *= 1.0 + costs.turn_weight * (1.0 - std::min(along, 1.0));
  }
  return std::max<std::uint32_t>(1, static_cast<std::uint32_t>(std::lround(cost)));
}

PixelBox clipped(PixelBox box, Size size) {
  return {std::max(box.left, 0), std::max(box.top, 0), std::min(box.right, size.width - 1),
          std::min(box.bottom, size.height - 1)};
}

bool inside(const PixelBox& box, int x, int y) {
  return x >= box.left && x <= box.right && y >= box.top && y <= box.bottom;
}

// The part of the picture inside the box as the search sees it; links are the step that led to a node.
class BoxView {
 public:
  using Link = std::uint8_t;
  static constexpr bool kCostlyEdges = true;
  BoxView(const LatticeCosts& costs, const PixelBox& box) : costs_(costs), box_(box), width_(box.right - box.left + 1) {}

  template <class Test, class Take>
  void visit(std::uint32_t node, const Test& test, const Take& take) const {
    const int x = static_cast<int>(node) % width_ + box_.left, y = static_cast<int>(node) / width_ + box_.top;
    for (int k = 0; k < 8; ++k) {
      if (!inside(box_, x + kDx[k], y + kDy[k])) continue;
      const auto edge = [&] {
        const std::uint32_t cost = step_cost(costs_, x, y, k);
        return Edge{cost, cost};
      };
      const std::uint32_t to = node + kDx[k] + kDy[k] * width_;
      if (test(to, edge)) take(to, static_cast<Link>(k), edge());
    }
  }
  std::uint32_t parent(std::uint32_t node, Link k) const { return node - kDx[k] - kDy[k] * width_; }
  std::uint32_t lead(std::uint32_t) const { return 0; }
  void prefetch(const SumLabels&, std::uint32_t) const {}

 private:
  const LatticeCosts& costs_;
  PixelBox box_;
  int width_;
};

// Ends when a target is settled; of several at the same cost the one with the lowest index.
struct StopAtAnyTarget {
  const Mask& wanted;
  std::uint32_t found = kFar;
  void settled(std::uint32_t node) {
    if (wanted.pixels()[node]) found = std::min(found, node);
  }
  bool done(const BoxView&, const SumLabels&, std::uint64_t) const { return found != kFar; }
};

CheapestPath walk_back(const Image<std::uint8_t>& came, const PixelBox& box, Pixel at, Size size) {
  CheapestPath path;
  for (;;) {
    path.pixels.push_back(at);
    path.touches_rim = path.touches_rim || (at.x == box.left && box.left > 0) || (at.y == box.top && box.top > 0) ||
                       (at.x == box.right && box.right < size.width - 1) ||
                       (at.y == box.bottom && box.bottom < size.height - 1);
    const int k = came(at.x - box.left, at.y - box.top);
    if (k == kNoStep) break;
    at = {at.x - kDx[k], at.y - kDy[k]};
  }
  std::reverse(path.pixels.begin(), path.pixels.end());
  return path;
}

}  // namespace

std::optional<CheapestPath> cheapest_path(const LatticeCosts& costs, Pixel start, const std::vector<Pixel>& targets,
                                          PixelBox box, const Monitor& monitor) {
  box = clipped(box, costs.cost.size());
  const int width = box.right - box.left + 1, height = box.bottom - box.top + 1;
  Mask wanted(std::max(width, 0), std::max(height, 0));
  bool any = false;
  for (const Pixel& t : targets) {
    if (!inside(box, t.x, t.y)) continue;
    wanted(t.x - box.left, t.y - box.top) = 255;
    any = true;
  }
  if (!inside(box, start.x, start.y) || !any) throw std::invalid_argument("cheapest_path: start or target outside");

  Image<std::uint32_t> best(width, height, kFar);
  Image<std::uint8_t> came(width, height, kNoStep);
  std::uint16_t dearest = 1;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const std::uint16_t cost = costs.cost(x + box.left, y + box.top);
      dearest = std::max(dearest, cost);
      if (cost == 0) best(x, y) = 0;  // forbidden: no offer is below
    }
  }
  BucketQueue queue(1, static_cast<std::uint32_t>(std::ceil(1.5 * dearest * (1.0 + costs.turn_weight))) + 2);
  const std::uint32_t source = static_cast<std::uint32_t>((start.y - box.top) * width + start.x - box.left);
  SumLabels labels{best.pixels().data()};
  labels.set(source, 0);
  queue.push(0, source);
  StopAtAnyTarget stop{wanted};
  if (search(BoxView(costs, box), labels, came.pixels().data(), queue, stop, kFar - 1, monitor) != SearchEnd::Stopped) return std::nullopt;
  const int found = static_cast<int>(stop.found);
  CheapestPath path = walk_back(came, box, {found % width + box.left, found / width + box.top}, costs.cost.size());
  path.cost = best.pixels()[stop.found];
  return path;
}

}  // namespace ramify
