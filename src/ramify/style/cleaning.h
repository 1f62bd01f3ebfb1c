// SPDX-License-Identifier: GPL-3.0-or-later
// A skeleton made fit to learn from: loose ends tied, spurs dropped, children cut at their parent's rim, branches that
// grow thicker towards the frame turned round (PICTURES 3 and 12.2-2). A traced skeleton's accidents are not style.
#pragma once

#include <vector>

#include "ramify/core/monitor.h"
#include "ramify/skeleton/skeleton.h"
#include "ramify/style/hierarchy.h"

namespace ramify {

struct CleanBranch {
  std::vector<Vec2> points;        // px, base to tip, starting at the parent's rim
  std::vector<double> radii;       // px
  int parent = kNone;              // number of an earlier clean branch
  Vec2 junction = Vec2::Zero();    // px, on the parent's axis
  double parent_radius = 0.0;      // px, there
  int order = 0;
  int tree = 0;                    // branches of one tree share it
  bool starts_on_frame = false;    // or on the border of the habitat
  bool starts_on_landmark = false;
  BranchEnd end = BranchEnd::Tip;
};

// Loose trees whose end lies within 10 px of another branch's rim become its children; trees shorter than 1.5 % of the
// length that do not reach the frame, and spurs, are dropped. The roots given stay roots.
// places: one for every node, or empty.
std::vector<CleanBranch> clean_branches(const Skeleton& skeleton, const std::vector<NodePlace>& places, const Monitor& monitor);

// The size of a typical bend, px: the smallest chord over which the r.m.s. distance of the curve from its chord hardly
// grows any more (d log(rms / L) / d log L < 0.3), clamped to 12 px … 0.1 x the shorter side (PICTURES 12.2-1), and to
// max(48 px, 8 x the mean radius): on smooth arcs the growth never ends, and steps must stay finer than the branch.
double measure_feature_size(const std::vector<CleanBranch>& branches, Size size);

// Children that end on the frame thicker than they start are frame roots seen from the wrong end: turned round.
// feature_size in px.
void turn_frame_roots(std::vector<CleanBranch>& branches, double feature_size);

// Ends within `reach` px of another branch's rim become joins (T-ends).
void mark_joins(std::vector<CleanBranch>& branches, double reach);

}  // namespace ramify
