// SPDX-License-Identifier: GPL-3.0-or-later
// Branches as capsules (segments with a radius at both ends) in a uniform grid: exact distances and neighbours in time
// that does not depend on how many there are (ALGORITHMS 4.5). Lengths in px.
#pragma once

#include <vector>

#include "ramify/core/types.h"

namespace ramify {

struct Capsule {
  Vec2 a = Vec2::Zero();   // px
  Vec2 b = Vec2::Zero();
  double radius_a = 0.0;   // px, at a
  double radius_b = 0.0;   // at b, linear in between
  int owner = kNone;       // the branch it belongs to; of no meaning to the index
  int place = 0;           // its position along the branch; of no meaning to the index

  double widest() const { return radius_a > radius_b ? radius_a : radius_b; }
};

// Distance from a point to the capsule's rim, 0 inside.
double rim_distance(const Capsule& capsule, const Vec2& point);

// Distance between the centre lines minus both radii at the nearest ends of the widths: a lower bound of the gap between
// two capsules (each counts with its larger radius). Negative where they overlap.
double capsule_gap(const Capsule& first, const Capsule& second);

class CapsuleIndex {
 public:
  // Covers [low, high]; capsules and queries outside are kept in the rim cells, so they are slow there, never lost.
  // cell: side of a grid cell, px, > 0.
  CapsuleIndex(const Vec2& low, const Vec2& high, double cell);

  int add(const Capsule& capsule);  // returns its number: 0, 1, 2, …
  void remove_last();               // takes back the latest add; there must be one
  int count() const { return static_cast<int>(items_.size()); }
  const Capsule& operator[](int number) const { return items_[static_cast<std::size_t>(number)].capsule; }

  // visit(number) for every capsule whose box, grown by its radius, may meet the box [low, high]; each once, in an order
  // that depends on what was added only. visit returns false to stop.
  template <class Visit>
  void visit_box(const Vec2& low, const Vec2& high, Visit&& visit) const;

  // Smallest rim distance at `point` over the capsules for which keep(capsule) holds, or `limit` when none is nearer.
  template <class Keep>
  double nearest_rim(const Vec2& point, double limit, Keep&& keep) const;

 private:
  struct Cells {
    int x0 = 0, y0 = 0, x1 = 0, y1 = 0;  // inclusive
  };
  struct Item {
    Capsule capsule;
    Cells cells;
  };
  Cells cells_of(const Vec2& low, const Vec2& high) const;
  int column(double x) const;
  int row(double y) const;

  Vec2 low_;
  double cell_;
  int columns_;
  int rows_;
  std::vector<std::vector<int>> grid_;
  std::vector<Item> items_;
};

template <class Visit>
void CapsuleIndex::visit_box(const Vec2& low, const Vec2& high, Visit&& visit) const {
  const Cells q = cells_of(low, high);
  for (int y = q.y0; y <= q.y1; ++y) {
    for (int x = q.x0; x <= q.x1; ++x) {
      for (const int number : grid_[static_cast<std::size_t>(y) * columns_ + x]) {
        const Cells& own = items_[static_cast<std::size_t>(number)].cells;
        // A capsule lies in several cells: only the first one it shares with the query reports it.
        const bool first = x == (own.x0 > q.x0 ? own.x0 : q.x0) && y == (own.y0 > q.y0 ? own.y0 : q.y0);
        if (first && !visit(number)) return;
      }
    }
  }
}

template <class Keep>
double CapsuleIndex::nearest_rim(const Vec2& point, double limit, Keep&& keep) const {
  double best = limit;
  const Vec2 reach(limit, limit);
  visit_box(point - reach, point + reach, [&](int number) {
    const Capsule& capsule = (*this)[number];
    if (keep(capsule)) {
      const double distance = rim_distance(capsule, point);
      best = distance < best ? distance : best;
    }
    return true;
  });
  return best;
}

}  // namespace ramify
