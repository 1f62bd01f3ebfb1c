// SPDX-License-Identifier: GPL-3.0-or-later
// Which capsules can be the nearest ones within a small tile of the canvas: exact, and about a dozen instead of all.
// Distances have slope 1, so within R of a tile's centre nothing can win that is more than 2 R worse there. A quadtree
// applies this from the whole canvas down to tiles of 4 x 4 px.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "ramify/skeleton/capsules.h"

namespace ramify {

// A capsule with what capsule_hit works out of it alone: the same hits, to the bit, for a part of the time.
class RoundCone {
 public:
  explicit RoundCone(const BodyCapsule& capsule);
  CapsuleHit hit(const Vec2& point) const;

 private:
  Vec2 a_, axis_;  // px
  double length_, radius_, growth_, slope_, lean_;
};

struct CapsuleTile {
  int x = 0, y = 0, width = 0, height = 0;  // px; the tile covers [x - 0.5, x + width - 0.5)
  std::span<const int> candidates;          // indices of capsules, ascending; empty when all are farther than the reach
  std::span<const RoundCone> cones;         // of all capsules
};

// Calls `visit` once for every tile of the canvas, from several threads; it may write only pixels of its tile. Pixels
// whose signed distance exceeds `reach` (px) may lie in a tile without candidates.
void visit_capsule_tiles(const std::vector<BodyCapsule>& capsules, Size canvas, double reach,
                         const std::function<void(const CapsuleTile&)>& visit);

struct NearestCapsule {
  int capsule = kNone;
  CapsuleHit hit;
};
// Over the tile's candidates; the lowest index wins ties.
NearestCapsule nearest_capsule(const CapsuleTile& tile, const Vec2& point);

}  // namespace ramify
