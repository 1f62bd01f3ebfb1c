// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/skeleton/capsule_tiles.h"

#include <algorithm>
#include <cmath>

#include "ramify/core/parallel.h"

namespace ramify {

RoundCone::RoundCone(const BodyCapsule& capsule)
    : a_(capsule.a),
      axis_(capsule.b - capsule.a),
      length_(axis_.norm()),
      radius_(capsule.radius_a),
      growth_(capsule.radius_b - capsule.radius_a),
      slope_(growth_ / length_),
      lean_(std::sqrt(1.0 - slope_ * slope_)) {}

CapsuleHit RoundCone::hit(const Vec2& point) const {
  const Vec2 from = point - a_;
  double fraction = growth_ > 0.0 ? 1.0 : 0.0;
  if (length_ > std::abs(growth_)) {
    const double along = from.dot(axis_) / length_, away = std::abs(cross(axis_, from)) / length_;
    fraction = std::clamp((along + away * slope_ / lean_) / length_, 0.0, 1.0);
  }
  return {(from - fraction * axis_).norm() - (radius_ + fraction * growth_), fraction};
}

namespace {

constexpr int kLeaf = 4;     // px
constexpr int kTask = 128;   // px; tiles of this size are the threads' work
constexpr double kSlack = 1e-9;  // px, for rounding

struct Square {
  int x = 0, y = 0, side = 0;  // side is a power of two times kLeaf
};

struct Task {
  Square square;
  std::vector<int> candidates;
};

// What can win in the square among `from`, in order.
std::vector<int> select(const std::vector<RoundCone>& cones, std::span<const int> from, const Square& square,
                        double reach) {
  const double half = 0.5 * square.side, radius = half * std::sqrt(2.0);
  const Vec2 centre(square.x + half - 0.5, square.y + half - 0.5);
  std::vector<double> distances(from.size());
  double best = reach + radius;
  for (std::size_t k = 0; k < from.size(); ++k) {
    distances[k] = cones[from[k]].hit(centre).signed_distance;
    best = std::min(best, distances[k]);
  }
  std::vector<int> kept;
  for (std::size_t k = 0; k < from.size(); ++k) {
    if (distances[k] <= std::min(best + 2.0 * radius, reach + radius) + kSlack) kept.push_back(from[k]);
  }
  return kept;
}

class Walk {
 public:
  Walk(const std::vector<BodyCapsule>& capsules, Size canvas, double reach, const std::function<void(const CapsuleTile&)>& visit)
      : cones_(capsules.begin(), capsules.end()), canvas_(canvas), reach_(reach), visit_(visit) {}

  // Depth is log2(side / kLeaf): bounded by the canvas, not by the skeleton.
  void descend(const Square& square, std::span<const int> from, std::vector<Task>* tasks) const {
    if (square.x >= canvas_.width || square.y >= canvas_.height) return;
    std::vector<int> kept = select(cones_, from, square, reach_);
    if (tasks && (square.side <= kTask || kept.empty())) {
      tasks->push_back({square, std::move(kept)});
    } else if (square.side == kLeaf || kept.empty()) {
      visit_({square.x, square.y, std::min(square.side, canvas_.width - square.x),
              std::min(square.side, canvas_.height - square.y), kept, cones_});
    } else {
      const int half = square.side / 2;
      for (const auto& [dx, dy] : {std::pair{0, 0}, {half, 0}, {0, half}, {half, half}}) {
        descend({square.x + dx, square.y + dy, half}, kept, tasks);
      }
    }
  }

 private:
  std::vector<RoundCone> cones_;
  Size canvas_;
  double reach_;
  const std::function<void(const CapsuleTile&)>& visit_;
};

}  // namespace

void visit_capsule_tiles(const std::vector<BodyCapsule>& capsules, Size canvas, double reach,
                         const std::function<void(const CapsuleTile&)>& visit) {
  std::vector<int> all(capsules.size());
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = static_cast<int>(i);
  int side = kTask;
  while (side < canvas.width || side < canvas.height) side *= 2;
  const Walk walk(capsules, canvas, reach, visit);
  std::vector<Task> tasks;
  walk.descend({0, 0, side}, all, &tasks);
  parallel_for(static_cast<int>(tasks.size()), [&](int i) { walk.descend(tasks[i].square, tasks[i].candidates, nullptr); });
}

NearestCapsule nearest_capsule(const CapsuleTile& tile, const Vec2& point) {
  NearestCapsule nearest;
  for (const int i : tile.candidates) {
    const CapsuleHit hit = tile.cones[static_cast<std::size_t>(i)].hit(point);
    if (nearest.capsule == kNone || hit.signed_distance < nearest.hit.signed_distance) nearest = {i, hit};
  }
  return nearest;
}

}  // namespace ramify
