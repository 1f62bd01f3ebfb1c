// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/growth/course.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "ramify/geometry/polyline.h"
#include "ramify/geometry/segment.h"

namespace ramify {

double bend_amplitude(const BendingModel& bending) {
  std::vector<double> amplitudes;
  for (int b = 0; b < bending.branch_count(); ++b) {
    for (int i = bending.first[b]; i + bending.extension < bending.first[b + 1]; ++i) {
      const Vec2 across = perpendicular(bending.point[i + bending.extension] - bending.point[i]).stableNormalized();
      double sum = 0.0;
      for (int j = 0; j <= bending.extension; ++j) sum += std::pow((bending.point[i + j] - bending.point[i]).dot(across), 2);
      amplitudes.push_back(std::sqrt(sum / (bending.extension + 1)));
    }
  }
  if (amplitudes.empty()) return bending.step;
  std::sort(amplitudes.begin(), amplitudes.end());
  // The bends that matter are the strong ones: nine in ten are smaller.
  return std::max(bending.step, amplitudes[static_cast<std::size_t>(0.9 * (amplitudes.size() - 1))]);
}

Course::Course(std::vector<Vec2> path, double width) : path_(std::move(path)), arcs_(arc_lengths(path_)), width_(width) {}

double Course::value(const Vec2& point) const {
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 1; i < path_.size(); ++i) {
    nearest = std::min(nearest, nearest_on_segment(point, path_[i - 1], path_[i]).distance);
  }
  return 1.0 - std::exp(-nearest * nearest / (width_ * width_));
}

double Course::arc_at(const Vec2& point, double least, double most) const {
  double best = std::numeric_limits<double>::infinity(), arc = std::clamp(least, 0.0, length());
  for (std::size_t i = 1; i < path_.size(); ++i) {
    if (arcs_[i] < least || arcs_[i - 1] > most) continue;
    const PointOnSegment foot = nearest_on_segment(point, path_[i - 1], path_[i]);
    if (foot.distance < best) {
      best = foot.distance;
      arc = arcs_[i - 1] + foot.fraction * (arcs_[i] - arcs_[i - 1]);
    }
  }
  return arc;
}

Vec2 Course::point_at(double arc) const { return point_at_arc(path_, arcs_, arc); }

double Course::direction_at(double arc, double ahead) const {
  const double from = std::min(arc, length() - ahead);
  return angle_of(point_at(from + ahead) - point_at(from));
}

}  // namespace ramify
