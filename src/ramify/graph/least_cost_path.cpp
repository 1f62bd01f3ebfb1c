// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/graph/least_cost_path.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace ramify {
namespace {

constexpr int kDx[8] = {1, 1, 0, -1, -1, -1, 0, 1};
constexpr int kDy[8] = {0, 1, 1, 1, 0, -1, -1, -1};
constexpr std::uint32_t kFar = std::numeric_limits<std::uint32_t>::max();
constexpr std::uint8_t kNoStep = 255;

// Circular buckets for integer keys whose spread is below the number of buckets (Dial 1969).
class BucketQueue {
 public:
  explicit BucketQueue(std::uint32_t largest_step) : buckets_(largest_step + 1) {}
  void push(std::uint32_t key, int item) {
    buckets_[key % buckets_.size()].push_back({key, item});
    ++count_;
  }
  bool empty() const { return count_ == 0; }
  // All items of the lowest key, in the order of their index.
  std::vector<int> pop_lowest() {
    while (buckets_[key_ % buckets_.size()].empty()) ++key_;
    std::vector<int> items;
    for (const auto& [key, item] : buckets_[key_ % buckets_.size()]) items.push_back(item);
    count_ -= items.size();
    buckets_[key_ % buckets_.size()].clear();
    std::sort(items.begin(), items.end());
    return items;
  }
  std::uint32_t key() const { return key_; }

 private:
  struct Entry {
    std::uint32_t key;
    int item;
  };
  std::vector<std::vector<Entry>> buckets_;
  std::uint32_t key_ = 0;
  std::size_t count_ = 0;
};

std::uint32_t edge_cost(const LatticeCosts& costs, int x, int y, int k) {
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
  Mask settled(width, height);
  std::uint16_t dearest = 1;
  for (int y = box.top; y <= box.bottom; ++y) {
    dearest = std::max(dearest, *std::max_element(costs.cost.row(y) + box.left, costs.cost.row(y) + box.right + 1));
  }
  BucketQueue queue(static_cast<std::uint32_t>(std::ceil(1.5 * dearest * (1.0 + costs.turn_weight))) + 2);
  const int source = (start.y - box.top) * width + start.x - box.left;
  best.pixels()[source] = 0;
  queue.push(0, source);
  for (long long round = 0; !queue.empty(); ++round) {
    if (round % 4096 == 0) monitor.check();
    for (const int item : queue.pop_lowest()) {
      const int x = item % width, y = item / width;
      if (settled(x, y)) continue;
      settled(x, y) = 255;
      if (wanted(x, y)) {
        CheapestPath path = walk_back(came, box, {x + box.left, y + box.top}, costs.cost.size());
        path.cost = best(x, y);
        return path;
      }
      for (int k = 0; k < 8; ++k) {
        const int u = x + kDx[k], v = y + kDy[k];
        if (!best.contains(u, v) || settled(u, v) || costs.cost(u + box.left, v + box.top) == 0) continue;
        const std::uint32_t through = best(x, y) + edge_cost(costs, x + box.left, y + box.top, k);
        if (through >= best(u, v)) continue;
        best(u, v) = through;
        came(u, v) = static_cast<std::uint8_t>(k);
        queue.push(through, v * width + u);
      }
    }
  }
  return std::nullopt;
}

}  // namespace ramify
