// SPDX-License-Identifier: GPL-3.0-or-later
// Trees drawn by rule instead of learnt: what the synthetic photographs are built on. Branches never touch, children
// are thinner than their parents, and radii follow Murray (r^3 is kept at a furcation; Murray 1926).
#pragma once

#include <functional>
#include <vector>

#include "ramify/core/monitor.h"
#include "ramify/core/random.h"
#include "ramify/core/types.h"
#include "ramify/exemplar/annotation.h"

namespace ramify {

// How a branch winds. All angles are standard deviations around its base heading.
struct TreeCourse {
  double kink_length = 0.0;   // px, typical length of straight pieces between sudden turns; 0 = no kinks
  double kink_angle = 0.0;    // rad
  double bend_length = 200.0; // px, wavelength of the smooth bends
  double bend_angle = 0.2;    // rad
  double ripple_length = 20.0;// px, a second, finer set of bends
  double ripple_angle = 0.05; // rad
  double homing = 0.0;        // 1/px, how fast the base heading turns towards `home`
  double home = 0.0;          // rad
};

struct SyntheticRoot {
  Vec2 start = Vec2::Zero();  // px, may lie outside the frame
  double heading = 0.0;       // rad
  double radius = 4.0;        // px at the start
  double length = 1e9;        // px at most
  double shortest = 0.0;      // px; other courses are tried when the first ends earlier
  double tip_share = 0.1;     // radius at a free end, as a share of the start's
  TreeCourse course;
};

// The children of all branches of the order before.
struct LevelPlan {
  int count = 10;                               // wanted altogether
  double angle_low = 0.5, angle_high = 1.1;     // rad from the parent's heading
  double length_low = 0.3, length_high = 0.8;   // share of the parent's length
  double ratio_low = 0.3, ratio_high = 0.7;     // radius to the parent's radius there
  double tip_share = 0.3;
  double shortest = 20.0;                       // px (and 7 radii); what collisions cut shorter is tried elsewhere
  double whole = 0.6;                           // share of its length a child must reach; after some tries 0.6 of that
  double alternate = 0.6;                       // chance that a child leaves on the other side than the one before
  double first = 0.06, last = 0.95;             // where on the parent children may start, share of its length
  bool on_elders = true;                        // also on the orders before the last
  double irregular = 0.9;                       // how far from even spacing, 0 … 1
  TreeCourse course;
};

struct TreePlan {
  Size size;
  std::vector<SyntheticRoot> roots;
  std::vector<LevelPlan> levels;      // order 1, 2, …
  double clearance = 6.0;             // px between the rims of two branches
  double thinnest = 0.8;              // px, no radius is smaller
  double murray = 1.0;                // share of Murray's loss that reaches the parent, 0 … 1
  bool hub = false;                   // the roots meet in one place: near their starts they may be close
  double radius_noise = 0.08;         // relative s.d. of the radius along a branch, correlated over about 2 r … 10 r
  std::function<bool(const Vec2&)> allowed;  // a branch ends in a tip where it would leave this; empty = everywhere
  std::function<bool(const Vec2&)> seen;     // a branch that leaves this is cut, as by the frame; empty = everywhere
};

// Branches, parents before children, with radii; leaves_frame is set where the frame cuts the tip. Points are 2 px apart;
// a branch that enters or leaves through the frame has its outer points outside the picture.
std::vector<AnnotatedBranch> draw_tree(const TreePlan& plan, const Rng& rng, const Monitor& monitor);

}  // namespace ramify
