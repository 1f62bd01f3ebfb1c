// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/style/hierarchy.h"

#include <algorithm>
#include <cmath>

#include "ramify/geometry/capsule_field.h"
#include "ramify/style/room.h"

namespace ramify {
namespace {

struct HeadingSum {
  std::array<double, kHeadingBins> counts{};
  Vec2 sum = Vec2::Zero();
  double total = 0.0;
  void add(double angle, double weight) {
    counts[static_cast<std::size_t>(heading_bin(angle))] += weight;
    sum += weight * direction_of(angle);
    total += weight;
  }
};

Headings smoothed(const HeadingSum& sum) {
  Headings headings;
  if (sum.total <= 0.0) {
    headings.share.fill(1.0 / kHeadingBins);
    return headings;
  }
  for (int b = 0; b < kHeadingBins; ++b) {
    const double left = sum.counts[(b + kHeadingBins - 1) % kHeadingBins], right = sum.counts[(b + 1) % kHeadingBins];
    headings.share[b] = (left + 2.0 * sum.counts[b] + right) / (4.0 * sum.total);
  }
  headings.strength = sum.sum.norm() / sum.total;
  return headings;
}

// Directions are taken over one extension: single steps are bends, not headings. What is shorter has one direction;
// every branch counts by its length.
void measure_headings(Hierarchy& hierarchy, const BendingModel& bending) {
  std::array<HeadingSum, kHeadingOrders> absolute, ray;
  for (int b = 0; b < bending.branch_count(); ++b) {
    const SourceBranch& branch = hierarchy.branches[b];
    int root = b;
    while (hierarchy.branches[root].parent != kNone) root = hierarchy.branches[root].parent;
    const Vec2 origin = bending.point[bending.first[root]];
    const int order = std::min(branch.order, kHeadingOrders - 1);
    const int edges = bending.length_of(b) - 1, reach = std::min(bending.extension, edges);
    const double weight = static_cast<double>(edges) / ((edges - reach) / 2 + 1);
    for (int i = bending.first[b] + reach; i < bending.first[b + 1]; i += 2) {
      const double angle = angle_of(bending.point[i] - bending.point[i - reach]);
      absolute[order].add(angle, weight);
      const Vec2 outward = bending.point[i] - origin;
      if (outward.norm() > 4.0 * bending.step) ray[order].add(wrap_angle(angle - angle_of(outward)), weight);
    }
  }
  for (int order = 0; order < kHeadingOrders; ++order) {
    hierarchy.headings[order] = smoothed(absolute[order]);
    hierarchy.ray_headings[order] = smoothed(ray[order]);
    if (absolute[order].total == 0.0 && order > 0) {
      hierarchy.headings[order] = hierarchy.headings[order - 1];
      hierarchy.ray_headings[order] = hierarchy.ray_headings[order - 1];
    }
  }
}

void measure_lags(Hierarchy& hierarchy, const BendingModel& bending) {
  const int m = bending.extension;
  for (int lag = 2 * m; lag <= 64 * m; lag *= 2) {
    std::vector<double> turns, chords;
    for (int b = 0; b < bending.branch_count(); ++b) {
      for (int i = bending.first[b] + m; i + lag < bending.first[b + 1]; ++i) {
        chords.push_back((bending.point[i + lag] - bending.point[i]).norm() / (lag * bending.step));
        const double before = angle_of(bending.point[i] - bending.point[i - m]);
        const double after = angle_of(bending.point[i + lag] - bending.point[i + lag - m]);
        turns.push_back(std::abs(wrap_angle(after - before)));
      }
    }
    if (turns.size() < 20) break;
    std::sort(turns.begin(), turns.end());
    hierarchy.lags.push_back(lag);
    hierarchy.lag_turn.push_back(turns[static_cast<std::size_t>(0.95 * (turns.size() - 1))]);
    std::sort(chords.begin(), chords.end());
    hierarchy.lag_chord.push_back(chords[static_cast<std::size_t>(0.03 * (chords.size() - 1))]);
  }
}

// Turns add up: a loop winds by 2 pi, however its two ends point.
void measure_windings(Hierarchy& hierarchy, const BendingModel& bending) {
  hierarchy.lag_winding.clear();
  for (const int lag : hierarchy.lags) {
    double most = 0.0;
    for (int b = 0; b < bending.branch_count(); ++b) {
      for (int from = bending.first[b]; from < bending.first[b + 1]; ++from) {
        double wound = 0.0;
        for (int i = from + 1; i < std::min(from + 1 + lag, bending.first[b + 1]); ++i) {
          wound += bending.alpha[i];
          most = std::max(most, std::abs(wound));
        }
      }
    }
    hierarchy.lag_winding.push_back(most);
  }
}

void measure_tips(Hierarchy& hierarchy, const BendingModel& bending) {
  const int reach = 2 * bending.extension;
  hierarchy.tip_profile.assign(reach + 1, 1.0);
  for (int j = 0; j <= reach; ++j) {
    std::vector<double> ratios;
    for (int b = 0; b < bending.branch_count(); ++b) {
      if (hierarchy.branches[b].end != BranchEnd::Tip || bending.length_of(b) <= reach + 2) continue;
      const int tip = bending.first[b + 1] - 1;
      ratios.push_back(bending.radius[tip - j] / bending.radius[tip - reach]);
    }
    if (ratios.empty()) {  // nothing seen: a taper to 0.4, as ridges fade
      hierarchy.tip_profile[j] = 0.4 + 0.6 * std::sqrt(static_cast<double>(j) / reach);
      continue;
    }
    const auto middle = ratios.begin() + static_cast<std::ptrdiff_t>(ratios.size() / 2);
    std::nth_element(ratios.begin(), middle, ratios.end());
    hierarchy.tip_profile[j] = std::min(1.0, *middle);
  }
}

// Vertices between neighbouring furcations that leave to the sides wanted (+1 clockwise, -1, or 0 = either), sorted.
std::vector<int> furcation_gaps(const Hierarchy& hierarchy, int side) {
  std::vector<std::vector<int>> leaves(hierarchy.branches.size());
  for (const SourceBranch& branch : hierarchy.branches) {
    if (branch.parent == kNone || (side != 0 && branch.start_angle * side <= 0.0)) continue;
    leaves[branch.parent].push_back(branch.parent_vertex);
  }
  std::vector<int> gaps;
  for (std::vector<int>& places : leaves) {
    std::sort(places.begin(), places.end());
    for (std::size_t i = 1; i < places.size(); ++i) gaps.push_back(places[i] - places[i - 1]);
  }
  std::sort(gaps.begin(), gaps.end());
  return gaps;
}

void measure_gaps(Hierarchy& hierarchy) {
  const std::vector<int> gaps = furcation_gaps(hierarchy, 0);
  hierarchy.furcation_gap = gaps.empty() ? 1 : std::max(1, gaps[gaps.size() / 20]);
  std::vector<int> same_side = furcation_gaps(hierarchy, 1);
  const std::vector<int> others = furcation_gaps(hierarchy, -1);
  same_side.insert(same_side.end(), others.begin(), others.end());
  std::sort(same_side.begin(), same_side.end());
  hierarchy.side_gap = same_side.empty() ? hierarchy.furcation_gap : std::max(1, same_side[same_side.size() / 10]);
  for (const SourceBranch& branch : hierarchy.branches) {
    hierarchy.highest_order = std::max(hierarchy.highest_order, branch.order);
  }
}

// No child is thicker than its parent (PICTURES 12.2-3), but where the exemplar is rooted at a thin end they are.
void measure_ratio(Hierarchy& hierarchy) {
  std::vector<double> ratios;
  for (const SourceBranch& branch : hierarchy.branches) {
    if (branch.parent != kNone) ratios.push_back(branch.ratio);
  }
  std::sort(ratios.begin(), ratios.end());
  hierarchy.most_ratio = ratios.empty() ? 0.95 : std::clamp(ratios[ratios.size() * 4 / 5], 0.95, 3.0);
}

// Length per area on a coarse grid, blurred by one cell: where branches live. Scaled so that the dense part is 1.
void measure_habitat(Hierarchy& hierarchy, const BendingModel& bending, Size size) {
  constexpr int n = kHabitatCells;
  std::vector<double> map(n * n, 0.0);
  for (const Vec2& point : bending.point) {
    const int x = std::clamp(static_cast<int>((point.x() + 0.5) * n / size.width), 0, n - 1);
    const int y = std::clamp(static_cast<int>((point.y() + 0.5) * n / size.height), 0, n - 1);
    map[y * n + x] += 1.0;
  }
  for (int round = 0; round < 2; ++round) {
    std::vector<double> blurred(n * n, 0.0);
    for (int y = 0; y < n; ++y) {
      for (int x = 0; x < n; ++x) {
        for (int dy = -1; dy <= 1; ++dy) {
          for (int dx = -1; dx <= 1; ++dx) {
            const int sx = std::clamp(x + dx, 0, n - 1), sy = std::clamp(y + dy, 0, n - 1);
            blurred[y * n + x] += map[sy * n + sx] * (2 - std::abs(dx)) * (2 - std::abs(dy)) / 16.0;
          }
        }
      }
    }
    map = blurred;
  }
  std::vector<double> sorted = map;
  std::sort(sorted.begin(), sorted.end());
  const double dense = std::max(1e-9, sorted[static_cast<std::size_t>(0.8 * (sorted.size() - 1))]);
  for (double& value : map) value = std::min(1.0, value / dense);
  hierarchy.habitat = map;
}

double measure_spacing(const BendingModel& bending, Size size) {
  std::vector<Capsule> capsules;
  for (int b = 0; b < bending.branch_count(); ++b) {
    for (int i = bending.first[b] + 1; i < bending.first[b + 1]; ++i) {
      capsules.push_back({bending.point[i - 1], bending.point[i], bending.radius[i - 1], bending.radius[i], b, i});
    }
  }
  const double cell = std::max(2.0, std::sqrt(size.width * static_cast<double>(size.height) / 2.5e5));
  const double ridge = median_ridge(capsule_field(capsules, size, cell), 2.0);
  const double side = std::min(size.width, size.height);
  return std::clamp(ridge > 0.0 ? ridge : 0.1 * side, 6.0, 0.15 * side);
}

}  // namespace

int heading_bin(double angle) {
  const int bin = static_cast<int>(std::floor((angle + kPi) / (2.0 * kPi) * kHeadingBins));
  return ((bin % kHeadingBins) + kHeadingBins) % kHeadingBins;
}

double share_at(const Headings& headings, double direction) {
  return headings.share[static_cast<std::size_t>(heading_bin(direction))];
}

void measure_hierarchy(Hierarchy& hierarchy, const BendingModel& bending, Size size) {
  measure_headings(hierarchy, bending);
  measure_lags(hierarchy, bending);
  measure_windings(hierarchy, bending);
  measure_tips(hierarchy, bending);
  measure_gaps(hierarchy);
  measure_ratio(hierarchy);
  measure_habitat(hierarchy, bending, size);
  hierarchy.spacing = measure_spacing(bending, size);
  measure_room(hierarchy, bending, size);
  std::vector<double> radii = bending.radius;
  std::sort(radii.begin(), radii.end());
  hierarchy.least_radius = std::max(0.5, radii[radii.size() * 3 / 100]);
  hierarchy.total_length = 0.0;
  for (int b = 0; b < bending.branch_count(); ++b) hierarchy.total_length += (bending.length_of(b) - 1) * bending.step;
}

}  // namespace ramify
