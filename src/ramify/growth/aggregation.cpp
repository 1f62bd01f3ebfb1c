// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/growth/aggregation.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "ramify/core/error.h"
#include "ramify/growth/far_walker.h"
#include "ramify/growth/planned_skeleton.h"
#include "ramify/image/image.h"

namespace ramify {

std::vector<OptionField> describe(AggregationOptions& o) {
  return {
      number("walkers", o.walkers, 0, 100000000, "", "Walkers that stay, one after the other (diffusion-limited aggregation, to compare paths with)."),
      choice("launch", o.launch, {"any-node", "circle"}, "Walkers start at any free node, as in the first paper, or on a circle around what is there, which is much faster."),
  };
}

namespace {

constexpr int kDx[4] = {1, -1, 0, 0}, kDy[4] = {0, 0, 1, -1};
constexpr double kAway = 4.0;  // px beyond the farthest node: the launching circle
constexpr double kBack = 2.0;  // times the launching circle: from there walkers return to it in one draw

// Four steps out of every byte of a draw.
class Steps {
 public:
  explicit Steps(Rng& rng) : rng_(rng) {}
  int next() {
    if (left_ == 0) bits_ = rng_.next(), left_ = 16;
    --left_;
    const int step = static_cast<int>(bits_ & 3u);
    bits_ >>= 2;
    return step;
  }

 private:
  Rng& rng_;
  std::uint32_t bits_ = 0;
  int left_ = 0;
};

class Aggregation {
 public:
  Aggregation(Size size, Rng rng, const Monitor& monitor)
      : size_(size), rng_(rng), steps_(rng_), monitor_(monitor), state_(size.width, size.height, kFree),
        index_(static_cast<std::size_t>(size.width) * size.height, kNone) {
    out_.size = size;
    settle(size.width / 2, size.height / 2, kNone);
  }

  Aggregate run(const AggregationOptions& options) {
    const auto room = static_cast<std::size_t>(size_.width) * size_.height;
    const std::size_t wanted = std::min(room, static_cast<std::size_t>(options.walkers));
    while (out_.nodes.size() < wanted) {
      monitor_.report(static_cast<double>(out_.nodes.size()) / wanted);
      if (options.launch == WalkerLaunch::AnyNode) walk_within();
      else walk_from_circle();
      if (options.launch == WalkerLaunch::Circle && at_rim_) {
        monitor_.note("the aggregate reached the canvas's edge after " + std::to_string(out_.nodes.size()) + " of " + std::to_string(wanted) + " walkers");
        break;
      }
    }
    return std::move(out_);
  }

 private:
  enum State : std::uint8_t { kFree, kBeside, kTaken };  // Beside: a neighbour is taken

  void settle(int x, int y, int parent) {
    index_[static_cast<std::size_t>(y * size_.width + x)] = static_cast<int>(out_.nodes.size());
    out_.nodes.push_back(y * size_.width + x);
    out_.parents.push_back(parent);
    state_(x, y) = kTaken;
    for (int k = 0; k < 4; ++k) {
      if (state_.contains(x + kDx[k], y + kDy[k]) && state_(x + kDx[k], y + kDy[k]) == kFree) state_(x + kDx[k], y + kDy[k]) = kBeside;
    }
    at_rim_ = at_rim_ || x == 0 || y == 0 || x == size_.width - 1 || y == size_.height - 1;
    farthest_ = std::max(farthest_, std::hypot(x - size_.width / 2, y - size_.height / 2));
  }
  void settle_beside(int x, int y) {
    for (int k = 0; k < 4; ++k) {
      const int u = x + kDx[k], v = y + kDy[k];
      if (state_.contains(u, v) && state_(u, v) == kTaken) return settle(x, y, index_[static_cast<std::size_t>(v * size_.width + u)]);
    }
  }
  void look_for_cancel() {
    if (++walked_ % (1 << 20) == 0) monitor_.check();
  }

  void walk_within() {
    int x = 0, y = 0;
    do {
      x = rng_.below(size_.width);
      y = rng_.below(size_.height);
    } while (state_(x, y) == kTaken);
    while (state_(x, y) != kBeside) {
      const int k = steps_.next();
      const int u = x + kDx[k], v = y + kDy[k];
      if (state_.contains(u, v)) x = u, y = v;
      look_for_cancel();
    }
    settle_beside(x, y);
  }

  void walk_from_circle() {
    const int cx = size_.width / 2, cy = size_.height / 2;
    const double launch = farthest_ + kAway, near = launch + kAway;
    int x = 0, y = 0;
    const auto leap = [&](double radius) {
      const double angle = rng_.uniform(0.0, 2.0 * kPi);
      x += static_cast<int>(std::lround(radius * std::cos(angle)));
      y += static_cast<int>(std::lround(radius * std::sin(angle)));
    };
    x = cx, y = cy;
    leap(launch);
    for (;; look_for_cancel()) {
      if (state_.contains(x, y) && state_(x, y) == kBeside) return settle_beside(x, y);
      const double dx = x - cx, dy = y - cy, squared = dx * dx + dy * dy;
      if (squared <= near * near) {
        const int k = steps_.next();
        x += kDx[k];
        y += kDy[k];
        continue;
      }
      const double distance = std::sqrt(squared);
      if (distance > kBack * launch) {
        const Vec2 back = return_to_circle(Vec2(dx, dy), launch, rng_);
        x = cx + static_cast<int>(std::lround(back.x()));
        y = cy + static_cast<int>(std::lround(back.y()));
      } else {
        leap(distance - farthest_ - 2.0);
      }
    }
  }

  Size size_;
  Rng rng_;
  Steps steps_;
  Monitor monitor_;
  Image<std::uint8_t> state_;
  std::vector<int> index_;   // in out_.nodes, of every node
  double farthest_ = 0.0;    // px from the middle
  bool at_rim_ = false;
  std::uint64_t walked_ = 0;
  Aggregate out_;
};

}  // namespace

Aggregate grow_aggregate(Size size, const AggregationOptions& options, Rng rng, const Monitor& monitor) {
  AggregationOptions checked = options;
  check_options(describe(checked));
  if (size.width < 3 || size.height < 3) throw InputError("the canvas", "is too small for walkers; it needs at least 3 x 3 nodes");
  return Aggregation(size, rng, monitor).run(options);
}

Skeleton aggregate_skeleton(const Aggregate& aggregate, double radius) {
  Structure structure;
  structure.forest.nodes = aggregate.nodes;
  structure.forest.parents = aggregate.parents;
  structure.forest.paths.assign(aggregate.nodes.size(), 0);
  structure.forest.path_count = 1;
  structure.rounds = {0};
  std::vector<bool> inner(aggregate.nodes.size(), false);
  for (const int parent : aggregate.parents) {
    if (parent != kNone) inner[static_cast<std::size_t>(parent)] = true;
  }
  std::vector<Vec3> positions;
  for (std::size_t i = 0; i < aggregate.nodes.size(); ++i) {
    positions.emplace_back(aggregate.nodes[i] % aggregate.size.width, aggregate.nodes[i] / aggregate.size.width, 0.0);
    if (!inner[i]) structure.endpoints.push_back(static_cast<int>(i));
  }
  return skeleton_from_structure(structure, positions, std::vector<double>(positions.size(), radius), aggregate.size, 2);
}

double mass_radius_dimension(std::span<const Vec2> points, const Vec2& middle) {
  if (points.size() < 100) return 0.0;
  std::vector<double> distance;
  double squared = 0.0;
  for (const Vec2& p : points) {
    distance.push_back((p - middle).norm());
    squared += distance.back() * distance.back();
  }
  std::sort(distance.begin(), distance.end());
  const double extent = std::sqrt(squared / static_cast<double>(points.size()));
  double n = 0, sx = 0, sy = 0, sxx = 0, sxy = 0;
  for (double r = 0.1 * extent; r <= 0.7 * extent; r *= 1.1) {
    const auto within = std::upper_bound(distance.begin(), distance.end(), r) - distance.begin();
    if (within < 2) continue;
    const double x = std::log(r), y = std::log(static_cast<double>(within));
    n += 1, sx += x, sy += y, sxx += x * x, sxy += x * y;
  }
  const double spread = n * sxx - sx * sx;
  return spread > 0.0 ? (n * sxy - sx * sy) / spread : 0.0;
}

}  // namespace ramify
