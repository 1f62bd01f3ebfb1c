// SPDX-License-Identifier: GPL-3.0-or-later
// A drawn course the main branch follows: the map G of paper 002, section 4.5, as a valley along a path.
#pragma once

#include "ramify/growth/grow.h"

namespace ramify {

// R.m.s. distance of the exemplar's curves from their chords over one feature, px: what a valley must leave room for.
double bend_amplitude(const BendingModel& bending);

class Guide {
 public:
  // width: of the valley, px (> 0).
  Guide(const GrowthTarget& target, double width);

  bool empty() const { return path_.size() < 2; }
  const std::vector<Vec2>& path() const { return path_; }
  double length() const;                      // px
  double width() const { return width_; }
  double distance(const Vec2& point) const;   // px to the path
  double value(const Vec2& point) const;      // G = 1 - exp(-distance^2 / width^2)
  double arc_at(const Vec2& point) const;     // px along the path, of the nearest place
  Vec2 point_at(double arc) const;

 private:
  std::vector<Vec2> path_;
  std::vector<double> arcs_;
  double width_;
};

}  // namespace ramify
