// SPDX-License-Identifier: GPL-3.0-or-later
// An exemplar's bends along a given line, with both ends held (ALGORITHMS 4.6): the line's coarse course is a valley
// that the bending model is grown along, and what is missing at the end is spread over all turns.
#pragma once

#include <span>
#include <vector>

#include "ramify/core/random.h"
#include "ramify/growth/course.h"
#include "ramify/growth/growing_branch.h"
#include "ramify/growth/window_matcher.h"
#include "ramify/style/style.h"

namespace ramify {

// Turns and step of a chain of edges, changed as little as possible (weighted by variance) so that it ends at `end`,
// px, in `direction`, rad: Gauss-Newton with the three constraints linearised, at most five steps.
struct ChainSpread {
  double turn = 0.2;      // rad, standard deviation of turns
  double heading = 0.3;   // rad, of the first edge's direction
  double stretch = 0.05;  // of the log of the step
};
// Returns the largest change of a turn, rad; infinite when it did not come within 0.01 step of the end, then points are
// as they were. O(points) a step.
double close_chain(std::vector<Vec2>& points, const Vec2& end, double direction, const ChainSpread& spread);

// Bends lines one after the other; remembers what it took, so that the angles of all lines together come near the
// exemplar's.
class PathBender {
 public:
  explicit PathBender(const Style& style);  // the style must outlive it

  double feature() const { return style_.feature_size; }  // px: shorter lines keep their shape
  double valley() const { return valley_; }               // px, how far bends may stray: 1.5 times their amplitude

  // A line from points.front() to points.back(), exactly, with edges of about style.step px; radii (px, one a point)
  // say which widths' bends are wanted. Empty when the line is shorter than half a feature, longer than 1e5 px, or
  // nothing fits.
  std::vector<Vec2> bend(std::span<const Vec2> points, std::span<const double> radii, const Rng& rng);

 private:
  struct Choice {
    int vertex = 0;
    bool mirrored = false;
    double score = 0.0;
    std::vector<Vec2> points;
    std::vector<double> turns;
  };

  bool grow(const Course& course, std::span<const double> arcs, std::span<const double> radii, Rng& rng,
            GrowingBranch& branch) const;
  std::vector<Choice> short_list(const GrowingBranch& branch, const Course& course, double progress, int count) const;
  void look_closer(const GrowingBranch& branch, const Course& course, double progress, int count, Choice& choice) const;
  void remember(const GrowingBranch& branch);

  const Style& style_;
  WindowMatcher matcher_;
  double valley_;
  double turn_spread_;  // rad, r.m.s. of the exemplar's turns
  Histogram angles_;    // of what was bent
  std::vector<int> uses_;
};

}  // namespace ramify
