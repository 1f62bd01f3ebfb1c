// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/growth/guide.h"

#include <algorithm>
#include <cmath>

#include "ramify/geometry/polyline.h"
#include "ramify/geometry/segment.h"

namespace ramify {
namespace {

// The pixel farthest from `start` inside the painted course, with the way back to it.
struct Flood {
  int farthest = 0;
  std::vector<int> from;
};

Flood flood(const ScalarImage& map, int start) {
  const int w = map.width(), h = map.height();
  Flood result{start, std::vector<int>(static_cast<std::size_t>(w) * h, kNone)};
  std::vector<int> open{start};
  result.from[start] = start;
  for (std::size_t next = 0; next < open.size(); ++next) {
    const int x = open[next] % w, y = open[next] / w;
    result.farthest = open[next];
    for (const auto& [dx, dy] : {std::pair{1, 0}, {-1, 0}, {0, 1}, {0, -1}, {1, 1}, {-1, -1}, {1, -1}, {-1, 1}}) {
      if (!map.contains(x + dx, y + dy) || map(x + dx, y + dy) < 0.5f) continue;
      const int other = (y + dy) * w + x + dx;
      if (result.from[other] != kNone) continue;
      result.from[other] = open[next];
      open.push_back(other);
    }
  }
  return result;
}

// The longest way through the painted course (two floods), smoothed to its middle; it starts at the end farther from the
// canvas's centre, as a branch that enters the picture.
std::vector<Vec2> path_from_map(const ScalarImage& map) {
  const auto start = std::find_if(map.pixels().begin(), map.pixels().end(), [](float v) { return v >= 0.5f; });
  if (start == map.pixels().end()) return {};
  const int first = flood(map, static_cast<int>(start - map.pixels().begin())).farthest;
  const Flood way = flood(map, first);
  std::vector<Vec2> path;
  for (int at = way.farthest;; at = way.from[at]) {
    path.emplace_back(at % map.width(), at / map.width());
    if (at == first) break;
  }
  const Vec2 center(0.5 * map.width(), 0.5 * map.height());
  if ((path.back() - center).norm() > (path.front() - center).norm()) std::reverse(path.begin(), path.end());
  return smooth_polyline(path, 8.0);
}

}  // namespace

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

Guide::Guide(const GrowthTarget& target, double width)
    : path_(target.guide_path.empty() && !target.guide_map.empty() ? path_from_map(target.guide_map) : target.guide_path),
      arcs_(arc_lengths(path_)),
      width_(width) {}

double Guide::length() const { return arcs_.empty() ? 0.0 : arcs_.back(); }

double Guide::distance(const Vec2& point) const {
  double best = std::numeric_limits<double>::infinity();
  for (std::size_t i = 1; i < path_.size(); ++i) {
    best = std::min(best, nearest_on_segment(point, path_[i - 1], path_[i]).distance);
  }
  return best;
}

double Guide::value(const Vec2& point) const {
  const double d = distance(point) / width_;
  return 1.0 - std::exp(-d * d);
}

double Guide::arc_at(const Vec2& point) const {
  double best = std::numeric_limits<double>::infinity(), arc = 0.0;
  for (std::size_t i = 1; i < path_.size(); ++i) {
    const PointOnSegment foot = nearest_on_segment(point, path_[i - 1], path_[i]);
    if (foot.distance < best) {
      best = foot.distance;
      arc = arcs_[i - 1] + foot.fraction * (arcs_[i] - arcs_[i - 1]);
    }
  }
  return arc;
}

Vec2 Guide::point_at(double arc) const { return point_at_arc(path_, arcs_, arc); }

}  // namespace ramify
