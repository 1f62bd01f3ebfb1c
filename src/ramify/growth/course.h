// SPDX-License-Identifier: GPL-3.0-or-later
// A course a branch follows: the map G of paper 002, section 4.5, as a valley along a path.
#pragma once

#include <vector>

#include "ramify/core/types.h"
#include "ramify/style/bending.h"

namespace ramify {

// R.m.s. distance of the exemplar's curves from their chords over one feature, px: what a valley must leave room for.
double bend_amplitude(const BendingModel& bending);

class Course {
 public:
  // path: px, at least two points; width: of the valley, px (> 0).
  Course(std::vector<Vec2> path, double width);

  const std::vector<Vec2>& path() const { return path_; }
  double length() const { return arcs_.back(); }  // px
  double width() const { return width_; }         // px, of the valley
  double value(const Vec2& point) const;          // G = 1 - exp(-distance^2 / width^2)
  // Px along the path, of the nearest place between two arcs: where the path comes back to itself, what lies far ahead is
  // not meant.
  double arc_at(const Vec2& point, double least, double most) const;
  Vec2 point_at(double arc) const;
  double direction_at(double arc, double ahead) const;  // rad, of the chord over the next `ahead` px

 private:
  std::vector<Vec2> path_;
  std::vector<double> arcs_;
  double width_;
};

}  // namespace ramify
