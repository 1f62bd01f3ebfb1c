// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/style/room.h"

#include <algorithm>
#include <cmath>

#include "ramify/geometry/capsule_index.h"

namespace ramify {
namespace {

constexpr double kKeepClear = 0.05;     // of the vertices are nearer to a stranger than the clearance
constexpr double kOpensSlower = 0.1;    // of the places along children open more slowly than `opening`
constexpr double kSlack = 0.85;         // of what was measured is asked for
constexpr double kLeastSpread = 0.15;   // rad
constexpr double kMostSpread = 0.8;     // rad (PICTURES 12.2-5)

double lower(std::vector<double>& values, double share) {
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
}

bool family(const Hierarchy& hierarchy, int a, int b) {
  return a == b || hierarchy.branches[a].parent == b || hierarchy.branches[b].parent == a;
}

// An end that runs into another branch comes near it by its nature.
bool runs_in(const Hierarchy& hierarchy, const BendingModel& bending, int branch, int vertex, double reach) {
  return hierarchy.branches[branch].end == BranchEnd::Join && (bending.first[branch + 1] - vertex) * bending.step < reach;
}

CapsuleIndex index_of(const Hierarchy& hierarchy, const BendingModel& bending, Size size) {
  CapsuleIndex index(Vec2::Zero(), Vec2(size.width, size.height), std::max(8.0, hierarchy.spacing));
  for (int b = 0; b < bending.branch_count(); ++b) {
    for (int i = bending.first[b] + 1; i < bending.first[b + 1]; ++i) {
      if (runs_in(hierarchy, bending, b, i, 4.0 * hierarchy.spacing)) continue;
      index.add({bending.point[i - 1], bending.point[i], bending.radius[i - 1], bending.radius[i], b, i});
    }
  }
  return index;
}

double measure_clearance(const Hierarchy& hierarchy, const BendingModel& bending, const CapsuleIndex& index) {
  const double limit = 4.0 * hierarchy.spacing;
  std::vector<double> gaps;
  for (int b = 0; b < bending.branch_count(); ++b) {
    for (int i = bending.first[b]; i < bending.first[b + 1]; ++i) {
      if (runs_in(hierarchy, bending, b, i, limit)) continue;
      const double rim = index.nearest_rim(bending.point[i], limit + bending.radius[i],
                                           [&](const Capsule& other) { return !family(hierarchy, b, other.owner); });
      gaps.push_back(rim - bending.radius[i]);
    }
  }
  return gaps.empty() ? 1.0 : std::clamp(kSlack * lower(gaps, kKeepClear), 0.0, 0.5 * hierarchy.spacing);
}

// Distance from the parent's rim over the arc, beyond what the parent's width hides.
double measure_opening(const Hierarchy& hierarchy, const BendingModel& bending, const CapsuleIndex& index) {
  std::vector<double> slopes;
  for (int b = 0; b < bending.branch_count(); ++b) {
    const SourceBranch& branch = hierarchy.branches[b];
    if (branch.parent == kNone) continue;
    const double rim = bending.radius[bending.first[branch.parent] + branch.parent_vertex];
    for (int i = bending.first[b]; i < bending.first[b + 1]; ++i) {
      const double arc = (i - bending.first[b]) * bending.step;
      if (arc < 2.0 * rim + 4.0 * bending.step) continue;
      if (arc > 2.0 * rim + 4.0 * bending.step + 2.0 * hierarchy.spacing) break;
      const double gap = index.nearest_rim(bending.point[i], arc, [&](const Capsule& other) { return other.owner == branch.parent; });
      slopes.push_back((gap - bending.radius[i]) / arc);
    }
  }
  return slopes.empty() ? 0.2 : std::clamp(kSlack * lower(slopes, kOpensSlower), 0.0, 0.5);
}

// Circular deviation of the angle from the parent's direction to a child's chord, sides folded together.
void measure_chord_spread(Hierarchy& hierarchy, const BendingModel& bending) {
  std::array<Vec2, kHeadingOrders> sums{};
  std::array<double, kHeadingOrders> counts{};
  sums.fill(Vec2::Zero());
  for (int b = 0; b < bending.branch_count(); ++b) {
    const SourceBranch& branch = hierarchy.branches[b];
    if (branch.parent == kNone) continue;
    const int first = bending.first[branch.parent], last = bending.first[branch.parent + 1] - 1, at = first + branch.parent_vertex;
    const double along = angle_of(bending.point[std::min(last, at + 2)] - bending.point[std::max(first, at - 2)]);
    const double chord = angle_of(bending.point[bending.first[b + 1] - 1] - bending.point[bending.first[b]]);
    const std::size_t order = static_cast<std::size_t>(std::min(branch.order, kHeadingOrders - 1));
    sums[order] += direction_of((branch.start_angle < 0.0 ? -1.0 : 1.0) * wrap_angle(chord - along));
    counts[order] += 1.0;
  }
  for (std::size_t order = 0; order < sums.size(); ++order) {
    const double strength = counts[order] > 2.0 ? sums[order].norm() / counts[order] : 0.0;
    const double deviation = strength > 0.0 ? std::sqrt(-2.0 * std::log(std::min(1.0, strength))) : kMostSpread;
    hierarchy.chord_spread[order] = std::clamp(deviation, kLeastSpread, kMostSpread);
  }
}

}  // namespace

void measure_room(Hierarchy& hierarchy, const BendingModel& bending, Size size) {
  const CapsuleIndex index = index_of(hierarchy, bending, size);
  hierarchy.clearance = measure_clearance(hierarchy, bending, index);
  hierarchy.opening = measure_opening(hierarchy, bending, index);
  measure_chord_spread(hierarchy, bending);
}

}  // namespace ramify
