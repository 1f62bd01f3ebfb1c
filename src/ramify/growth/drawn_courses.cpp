// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/growth/drawn_courses.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "ramify/core/error.h"
#include "ramify/geometry/polyline.h"
#include "ramify/geometry/segment.h"
#include "ramify/growth/mask_strokes.h"

namespace ramify {
namespace {

using Path = std::vector<Vec2>;

constexpr double kStep = 4.0;     // px between a path's points
constexpr double kBeyond = 60.0;  // px a path is followed beyond the frame

// A line out of a mask has no direction of its own: it enters the picture, from the end farther from the middle.
Path entering(Path path, Size size) {
  const Vec2 center(0.5 * size.width, 0.5 * size.height);
  if ((path.back() - center).norm() > (path.front() - center).norm()) std::reverse(path.begin(), path.end());
  return path;
}

// A mask's line that runs into the frame goes on beyond it.
Path prolonged(Path path, Size size) {
  const auto on_rim = [&](const Vec2& p) {
    return std::min({p.x(), p.y(), size.width - 1.0 - p.x(), size.height - 1.0 - p.y()}) < 6.0;
  };
  const std::size_t back = std::min<std::size_t>(path.size() - 1, 12);
  const auto beyond = [](const Vec2& end, const Vec2& before) {
    return Vec2(end + (end - before).stableNormalized() * kBeyond);
  };
  const Vec2 start = beyond(path.front(), path[back]), end = beyond(path.back(), path[path.size() - 1 - back]);
  if (on_rim(path.back())) path.push_back(end);
  if (on_rim(path.front())) path.insert(path.begin(), start);
  return path;
}

// The stretches of a path where something can grow. A stretch that leaves the canvas keeps some way beyond.
std::vector<Path> open_stretches(const Path& path, const Ground& ground, double least, double& lost) {
  const Path points = resample_arc(path, kStep).points;
  std::vector<Path> stretches(1);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const bool open = ground.inside(points[i]) && !ground.blocked(points[i]);
    if (open) {
      stretches.back().push_back(points[i]);
      continue;
    }
    lost += ground.on_canvas(points[i]) ? kStep : 0.0;
    if (stretches.back().empty()) continue;
    if (!ground.blocked(points[i])) {
      for (std::size_t j = i; j < points.size() && !ground.inside(points[j]) && (j - i) * kStep < kBeyond; ++j)
        stretches.back().push_back(points[j]);
    }
    stretches.emplace_back();
  }
  std::erase_if(stretches, [&](const Path& p) { return p.size() < 2 || polyline_length(p) < least; });
  return stretches;
}

// A tree holds no ring: the branch ends just before its own start.
void open_ring(Path& path, double gap) {
  if ((path.front() - path.back()).norm() > gap) return;
  while (path.size() > 3 && polyline_length(path) > 4.0 * gap && (path.front() - path.back()).norm() < gap)
    path.pop_back();
}

double nearest_on(const Path& path, const Vec2& point) {
  double best = std::numeric_limits<double>::infinity();
  for (std::size_t i = 1; i < path.size(); ++i)
    best = std::min(best, nearest_on_segment(point, path[i - 1], path[i]).distance);
  return best;
}

// Takes the longest stretch that leaves a course there is, or the longest of all when none does.
DrawnCourse take_next(std::vector<Path>& stretches, const std::vector<DrawnCourse>& courses, double join) {
  DrawnCourse next;
  for (std::size_t i = 0; i < stretches.size() && next.path.empty(); ++i) {
    for (int c = 0; c < static_cast<int>(courses.size()) && next.path.empty(); ++c) {
      const double start = nearest_on(courses[c].path, stretches[i].front()),
                   end = nearest_on(courses[c].path, stretches[i].back());
      if (std::min(start, end) > join) continue;
      if (end < start) std::reverse(stretches[i].begin(), stretches[i].end());
      next = {stretches[i], c};
      stretches.erase(stretches.begin() + static_cast<std::ptrdiff_t>(i));
    }
  }
  if (next.path.empty()) {
    next.path = stretches.front();
    stretches.erase(stretches.begin());
  }
  return next;
}

}  // namespace

std::vector<DrawnCourse> drawn_courses(const GrowthTarget& target, const Ground& ground, double join, double least,
                                       const Monitor& monitor) {
  std::vector<Path> paths = target.guide_paths;
  if (!target.guide_map.empty()) {
    for (const Path& line : mask_strokes(target.guide_map))
      paths.push_back(prolonged(entering(line, target.size), target.size));
  }
  std::vector<Path> stretches;
  double all = 0.0, lost = 0.0;
  for (const Path& path : paths) {
    if (path.size() < 2) continue;
    all += polyline_length(path);
    for (Path& stretch : open_stretches(path, ground, least, lost)) stretches.push_back(std::move(stretch));
  }
  if (all > 0.0 && stretches.empty()) {
    throw InputError(
        "",
        "the guide lies where nothing can grow: off the canvas, on black or an obstacle, or where the photo has no "
        "branches (below a skyline, beyond a rim); draw a stroke of at least " +
            number_text(std::ceil(least)) + " px elsewhere");
  }
  if (lost > 0.1 * all) {
    monitor.note(number_text(std::round(100.0 * lost / all)) +
                 " % of the guide lies where nothing can grow and is left out");
  }
  std::stable_sort(stretches.begin(), stretches.end(),
                   [](const Path& a, const Path& b) { return polyline_length(a) > polyline_length(b); });
  std::vector<DrawnCourse> courses;
  while (!stretches.empty()) {
    courses.push_back(take_next(stretches, courses, join));
    open_ring(courses.back().path, join);
  }
  return courses;
}

}  // namespace ramify
