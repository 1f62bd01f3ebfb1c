// SPDX-License-Identifier: GPL-3.0-or-later
// How branches bend: the exemplar itself, as turning angles and radii at constant steps (paper 002, sections 4.1 and
// 4.2). There is no transition matrix: growth looks for stretches of the exemplar that look like what it has just grown.
#pragma once

#include <span>
#include <vector>

#include "ramify/core/types.h"
#include "ramify/style/histogram.h"

namespace ramify {

// Flat arrays over all vertices, one branch after the other, base to tip.
struct BendingModel {
  double step = 1.0;                  // h, px: every vertex lies exactly this far from the one before
  int extension = 8;                  // m: vertices appended at a time
  int history = 24;                   // k: growth compares the last k + 1 vertices
  std::vector<int> first;             // per branch its first vertex, and one more entry: the number of vertices
  std::vector<Vec2> point;            // px of the exemplar
  std::vector<double> alpha;          // rad, turn from the edge before to the edge after; 0 at a branch's two ends
  std::vector<double> radius;         // px
  std::vector<double> smooth_radius;  // px, the profile without its fluctuation (PICTURES 12.2-3)
  double angle_gain = 1.0;            // rad: median r.m.s. difference between windows of the exemplar
  double radius_gain = 1.0;           // px: the same for radii
  Histogram angles;                   // rad, symmetric range; mirrored bends counted as well
  Histogram radii;                    // px

  int branch_count() const { return static_cast<int>(first.size()) - 1; }
  int vertex_count() const { return static_cast<int>(point.size()); }
  int length_of(int branch) const { return first[branch + 1] - first[branch]; }  // vertices
};

// One branch to learn from: points at constant chord, radii beside them.
struct BendingBranch {
  std::vector<Vec2> points;   // px, at least 2
  std::vector<double> radii;  // px
};

// Builds arrays, profiles, gains and histograms. extension = m >= 1, history = k >= 1; mirror: count every bend also mirrored.
BendingModel make_bending(const std::vector<BendingBranch>& branches, double step, int extension, int history, bool mirror);

// 1 / (difference + 1) + 1, in (1, 2]: the paper's dist for an already measured ||X - Y||.
double likeness(double difference);

// Q of the paper for two windows of equal length, in (1, 4]: raw compares with the plain norms in rad and px, otherwise
// with r.m.s. differences in units of the gains, so that both attributes count alike (ALGORITHMS 4.2).
double window_quality(const BendingModel& model, std::span<const double> alpha_a, std::span<const double> alpha_b,
                      std::span<const double> radius_a, std::span<const double> radius_b, bool raw);

}  // namespace ramify
