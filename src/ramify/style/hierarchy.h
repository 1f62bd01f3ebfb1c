// SPDX-License-Identifier: GPL-3.0-or-later
// What the exemplar's branches are to each other and to the frame: roots, template branches with their children, headings
// per order, ends, spacing (PICTURES 1, 2 and 12.2). Lengths in px of the exemplar, angles in rad.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "ramify/core/types.h"
#include "ramify/style/bending.h"

namespace ramify {

inline constexpr int kHeadingBins = 16;   // over the full circle, from -pi
inline constexpr int kHeadingOrders = 4;  // orders beyond the last share its histogram
inline constexpr double kStartTogether = 10.0;  // px between the rims: roots nearer to each other start from one place
inline constexpr int kHabitatCells = 16;  // per side, of the coarse map of where branches live

// What a node of the exemplar lies on. Where the habitat ends (a field's rim, a skyline) branches end as at the frame.
enum class NodePlace : std::uint8_t { Ground, Border, Landmark };

enum class BranchEnd {
  Tip,    // it ends inside the picture
  Frame,  // it is cut by the frame, or by the border of the habitat
  Join    // it runs into another branch (a T)
};

// One branch of the exemplar; its vertices are those of the bending model's branch of the same number.
struct SourceBranch {
  int parent = kNone;         // number of an earlier source branch
  int parent_vertex = 0;      // where it leaves, counted along the parent
  int order = 0;              // 0 for a root branch
  int tree = 0;               // branches of one tree share it
  double rim_angle = 0.0;     // from the parent's direction to the line from its axis to the first vertex
  double start_angle = 0.0;   // from the parent's direction to the child's first direction
  double ratio = 1.0;         // its radius at the start (beyond the parent's influence) over the parent's
  bool starts_on_frame = false;    // or on the border of the habitat
  bool starts_on_landmark = false; // it starts from something that stays visible where the ground is kept
  BranchEnd end = BranchEnd::Tip;
};

struct Headings {
  std::array<double, kHeadingBins> share{};  // smoothed, sums to 1
  double strength = 0.0;                     // length of the mean direction, 0..1
};

// Share of the bin a direction falls into.
double share_at(const Headings& headings, double direction);

struct Hierarchy {
  std::vector<SourceBranch> branches;  // parents before children
  std::array<Headings, kHeadingOrders> headings;      // absolute direction by order, over one extension
  std::array<Headings, kHeadingOrders> ray_headings;  // direction relative to the ray from the tree's root
  std::vector<int> lags;               // vertices
  std::vector<double> lag_turn;        // rad: 95 % of the turns between directions that many vertices apart
  std::vector<double> lag_chord;       // chord / arc over that many vertices that 97 % exceed
  std::vector<double> lag_winding;  // rad: the most that any branch winds between two of at most that many edges apart
  std::vector<double> tip_profile;     // radius j vertices before a tip over that 2m vertices before it; 2m + 1 entries
  double most_ratio = 0.95;            // radius of a child over its parent's that four in five stay below, at least 0.95
  double least_radius = 0.5;           // px: 3 % of the vertices are thinner
  int side_gap = 1;                    // vertices: 10 % of the gaps between furcations to the same side are shorter
  int highest_order = 0;
  double spacing = 32.0;               // px, rho: median distance to the nearest branch midway between branches
  double clearance = 1.0;              // px between the rims of unrelated branches; 95 % of the vertices keep more
  double opening = 0.2;                // a child's distance from its parent's rim over its arc; 90 % have more
  std::array<double, kHeadingOrders> chord_spread{};  // rad: of the angle between a child's chord and its parent, by order
  double total_length = 0.0;           // px
  int furcation_gap = 1;               // vertices: 5 % of the gaps between furcations are shorter
  std::vector<double> habitat;         // kHabitatCells^2, row by row: length per area, blurred, 1 = the dense part
};

// The bin of a direction, 0..kHeadingBins-1.
int heading_bin(double angle);

// Fills everything but `branches`, which must be there. size: of the exemplar.
void measure_hierarchy(Hierarchy& hierarchy, const BendingModel& bending, Size size);

}  // namespace ramify
