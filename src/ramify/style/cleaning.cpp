// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/style/cleaning.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "ramify/geometry/polyline.h"
#include "ramify/style/rooted_graph.h"

namespace ramify {
namespace {

constexpr double kShortestSpur = 8.0;  // px

double median_of(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

bool on_frame(const Vec2& point, double radius, Size size) {
  const double margin = std::min({point.x(), point.y(), size.width - 1 - point.x(), size.height - 1 - point.y()});
  return margin <= std::max(4.0, radius + 3.0);
}

// Cuts what lies inside the parent, and takes the first radii from beyond its influence. False when nothing is left.
bool cut_at_rim(CleanBranch& branch) {
  const double rim = branch.parent_radius;
  std::size_t first = 0;
  while (first < branch.points.size() && (branch.points[first] - branch.junction).norm() <= rim) ++first;
  branch.points.erase(branch.points.begin(), branch.points.begin() + static_cast<std::ptrdiff_t>(first));
  branch.radii.erase(branch.radii.begin(), branch.radii.begin() + static_cast<std::ptrdiff_t>(first));
  if (branch.points.size() < 2) return false;
  std::size_t clear = 0;
  while (clear < branch.points.size() && (branch.points[clear] - branch.junction).norm() <= 1.5 * rim) ++clear;
  if (clear > 0 && clear + 2 < branch.radii.size()) {
    const std::size_t stop = std::min(branch.radii.size(), clear + 5);
    const auto begin = branch.radii.begin();
    const double radius = median_of({begin + static_cast<std::ptrdiff_t>(clear), begin + static_cast<std::ptrdiff_t>(stop)});
    std::fill(begin, begin + static_cast<std::ptrdiff_t>(clear), radius);
  }
  return polyline_length(branch.points) >= std::max(kShortestSpur, 2.0 * median_of(branch.radii));
}

double distance_to(const CleanBranch& branch, const Vec2& point) {
  double best = 1e300;
  for (std::size_t i = 0; i < branch.points.size(); ++i) {
    best = std::min(best, (branch.points[i] - point).norm() - branch.radii[i]);
  }
  return best;
}

void count_orders(std::vector<CleanBranch>& branches) {
  for (CleanBranch& branch : branches) {
    branch.order = branch.parent == kNone ? 0 : branches[branch.parent].order + 1;
    if (branch.parent != kNone) branch.tree = branches[branch.parent].tree;
  }
}

// Median r.m.s. distance from the chord over windows of `chord` px; negative with too few windows.
double bend_amplitude(const std::vector<std::vector<Vec2>>& curves, double step, double chord) {
  const int window = static_cast<int>(chord / step);
  std::vector<double> amplitudes;
  for (const std::vector<Vec2>& curve : curves) {
    for (int i = 0; i + window < static_cast<int>(curve.size()); i += std::max(1, window / 4)) {
      const Vec2 across = perpendicular(curve[i + window] - curve[i]);
      const double length = across.norm();
      if (length < 1e-6) continue;
      double sum = 0.0;
      for (int j = i; j <= i + window; ++j) sum += std::pow((curve[j] - curve[i]).dot(across) / length, 2);
      amplitudes.push_back(std::sqrt(sum / (window + 1)));
    }
  }
  return amplitudes.size() > 5 ? median_of(amplitudes) : -1.0;
}

}  // namespace

std::vector<CleanBranch> clean_branches(const Skeleton& skeleton, const std::vector<NodePlace>& places, const Monitor& monitor) {
  const auto lies_on = [&](int node, NodePlace place) { return !places.empty() && places[static_cast<std::size_t>(node)] == place; };
  std::vector<bool> anchored;
  for (const NodePlace place : places) anchored.push_back(place == NodePlace::Landmark);
  const RootedGraph graph = tie_loose_trees(skeleton, anchored, monitor);
  std::vector<CleanBranch> branches;
  std::vector<int> kept(graph.runs.size(), kNone);
  for (std::size_t r = 0; r < graph.runs.size(); ++r) {
    const GraphRun& run = graph.runs[r];
    if (run.parent_run != kNone && kept[run.parent_run] == kNone) continue;
    CleanBranch branch;
    for (const int node : run.nodes) {
      branch.points.push_back(skeleton[node].xy());
      branch.radii.push_back(std::max(0.5, skeleton[node].radius));
    }
    const int start = run.nodes.front(), end = run.nodes.back();
    branch.starts_on_frame = run.parent_run == kNone && (on_frame(branch.points.front(), branch.radii.front(), skeleton.size) ||
                                                         lies_on(start, NodePlace::Border));
    branch.starts_on_landmark = run.parent_run == kNone && lies_on(start, NodePlace::Landmark);
    const bool leaves = on_frame(branch.points.back(), branch.radii.back(), skeleton.size) || lies_on(end, NodePlace::Border);
    branch.end = leaves ? BranchEnd::Frame : BranchEnd::Tip;
    branch.tree = static_cast<int>(r);
    if (run.parent_run != kNone) {
      branch.parent = kept[run.parent_run];
      branch.junction = skeleton[run.parent_node].xy();
      branch.parent_radius = skeleton[run.parent_node].radius;
      if (!cut_at_rim(branch)) continue;
    } else if (branch.points.size() < 2) {
      continue;
    } else {
      for (const CleanBranch& other : branches) {
        const double touching = other.radii.front() + branch.radii.front() + kStartTogether;
        if (other.parent == kNone && (other.points.front() - branch.points.front()).norm() <= touching) branch.tree = other.tree;
      }
    }
    kept[r] = static_cast<int>(branches.size());
    branches.push_back(std::move(branch));
  }
  count_orders(branches);
  return branches;
}

double measure_feature_size(const std::vector<CleanBranch>& branches, Size size) {
  constexpr double kStep = 2.0;
  constexpr std::array kChords{6.0, 8.0, 12.0, 16.0, 24.0, 32.0, 48.0, 64.0, 96.0, 128.0, 192.0};
  std::vector<std::vector<Vec2>> curves;
  for (const CleanBranch& branch : branches) {
    curves.push_back(resample_chord(smooth_polyline(branch.points, 2.0), kStep).points);
  }
  std::vector<double> ratios;
  for (const double chord : kChords) {
    const double amplitude = bend_amplitude(curves, kStep, chord);
    if (amplitude <= 0.0) break;
    ratios.push_back(amplitude / chord);
  }
  double feature = ratios.empty() ? 12.0 : kChords[ratios.size() - 1];
  for (std::size_t i = 2; i + 1 < ratios.size(); ++i) {
    if (std::log(ratios[i + 1] / ratios[i]) / std::log(kChords[i + 1] / kChords[i]) < 0.3) {
      feature = kChords[i];
      break;
    }
  }
  double radii = 0.0, vertices = 0.0;
  for (const CleanBranch& branch : branches) {
    for (const double radius : branch.radii) radii += radius;
    vertices += static_cast<double>(branch.radii.size());
  }
  const double most = std::min(0.1 * std::min(size.width, size.height), std::max(48.0, 8.0 * radii / std::max(1.0, vertices)));
  return std::clamp(feature, 12.0, std::max(12.0, most));
}

void turn_frame_roots(std::vector<CleanBranch>& branches, double feature_size) {
  for (CleanBranch& branch : branches) {
    if (branch.parent == kNone || branch.end != BranchEnd::Frame) continue;
    if (polyline_length(branch.points) < 2.5 * feature_size) continue;
    const std::ptrdiff_t third = std::max<std::ptrdiff_t>(1, static_cast<std::ptrdiff_t>(branch.radii.size() / 3));
    const double start = median_of({branch.radii.begin(), branch.radii.begin() + third});
    const double end = median_of({branch.radii.end() - third, branch.radii.end()});
    if (end <= 1.3 * std::max(start, 0.8 * branch.parent_radius)) continue;
    std::reverse(branch.points.begin(), branch.points.end());
    std::reverse(branch.radii.begin(), branch.radii.end());
    branch.starts_on_frame = true;
    branch.end = BranchEnd::Join;
    branch.parent = kNone;
    // A tree number of its own: the vertex count is larger than any number given before.
    branch.tree = static_cast<int>(branches.size() + (&branch - branches.data()));
  }
  count_orders(branches);
}

void mark_joins(std::vector<CleanBranch>& branches, double reach) {
  for (std::size_t b = 0; b < branches.size(); ++b) {
    if (branches[b].end != BranchEnd::Tip) continue;
    const Vec2 tip = branches[b].points.back();
    const double rim = branches[b].radii.back() + reach;
    for (std::size_t other = 0; other < branches.size(); ++other) {
      const bool family = other == b || static_cast<int>(other) == branches[b].parent ||
                          branches[other].parent == static_cast<int>(b);
      if (!family && distance_to(branches[other], tip) < rim) {
        branches[b].end = BranchEnd::Join;
        break;
      }
    }
  }
}

}  // namespace ramify
