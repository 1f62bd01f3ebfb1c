// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/skeleton/statistics.h"

#include <algorithm>
#include <cmath>

#include "ramify/geometry/polyline.h"
#include "ramify/image/image.h"
#include "ramify/skeleton/branches.h"
#include "ramify/skeleton/edit.h"

namespace ramify {
namespace {

constexpr double kFine = 1.0;            // px, step before smoothing
constexpr double kPointSigma = 2.0;      // px (PICTURES 10)
constexpr double kRadiusSigma = 4.0;     // px
constexpr double kRun = 40.0;            // px, of a run that noise floors are drawn from
constexpr double kTortuousLength = 2.0;  // in h; the chord of shorter branches says nothing

// Gaussian of samples at whole steps; beyond the ends the end value goes on (scipy's mode "nearest", truncate 4).
template <class Value>
std::vector<Value> gaussian(const std::vector<Value>& values, double sigma) {
  const int reach = static_cast<int>(4.0 * sigma + 0.5), last = static_cast<int>(values.size()) - 1;
  std::vector<double> weights;
  double sum = 0.0;
  for (int k = -reach; k <= reach; ++k) sum += weights.emplace_back(std::exp(-0.5 * k * k / (sigma * sigma)));
  std::vector<Value> result(values);
  for (int i = 0; i <= last; ++i) {
    Value mean = weights[0] / sum * values[std::clamp(i - reach, 0, last)];
    for (int k = 1 - reach; k <= reach; ++k) mean += weights[k + reach] / sum * values[std::clamp(i + k, 0, last)];
    result[i] = mean;
  }
  return result;
}

struct Samples {
  std::vector<Vec2> points;
  std::vector<double> radii;
};

// At arcs 0, step, 2 step, … below the length.
Samples sample(const Samples& line, double step) {
  const std::vector<double> arcs = arc_lengths(line.points);
  Samples result;
  for (int k = 0; k * step < arcs.back(); ++k) {
    result.points.push_back(point_at_arc(line.points, arcs, k * step));
    result.radii.push_back(value_at_arc(line.radii, arcs, k * step));
  }
  return result;
}

template <class Value>
void append_runs(const std::vector<Value>& values, int size, std::vector<std::vector<Value>>& runs) {
  for (std::size_t i = 0; i < values.size(); i += static_cast<std::size_t>(size)) {
    runs.emplace_back(values.begin() + static_cast<std::ptrdiff_t>(i),
                      values.begin() + static_cast<std::ptrdiff_t>(std::min(i + size, values.size())));
  }
}

// A branch with its parent's node in front, the parent's own radius at it: the line as it was traced.
Samples traced_line(const Skeleton& skeleton, const Branch& branch) {
  Samples line;
  const auto add = [&](int i) {
    line.points.push_back(skeleton[i].xy());
    line.radii.push_back(skeleton[i].radius);
  };
  if (branch.parent_node != kNone) add(branch.parent_node);
  for (const int i : branch.nodes) add(i);
  return line;
}

void measure_headings(const Skeleton& skeleton, const BranchTree& tree, SkeletonStatistics& result) {
  Vec2 all = Vec2::Zero();
  std::vector<Vec2> sums;
  for (int i = 0; i < skeleton.count(); ++i) {
    const int parent = skeleton[i].parent;
    const std::size_t order = static_cast<std::size_t>(tree.branches[tree.branch_of_node[i]].order);
    if (order >= sums.size()) sums.resize(order + 1, Vec2::Zero()), result.order_lengths.resize(order + 1, 0.0);
    if (parent == kNone) continue;
    const Vec2 edge = skeleton[i].xy() - skeleton[parent].xy();
    all += edge, sums[order] += edge;
    result.total_length += edge.norm(), result.order_lengths[order] += edge.norm();
  }
  const auto heading = [](const Vec2& sum, double length) {
    return length > 0.0 ? Heading{sum.norm() / length, angle_of(sum)} : Heading{};
  };
  result.heading = heading(all, result.total_length);
  for (std::size_t o = 0; o < sums.size(); ++o) result.order_headings.push_back(heading(sums[o], result.order_lengths[o]));
}

void measure_topology(const Skeleton& skeleton, const BranchTree& tree, SkeletonStatistics& result) {
  std::vector<int> children(static_cast<std::size_t>(skeleton.count()), 0);
  for (const Node& node : skeleton.nodes()) {
    if (node.parent == kNone) ++result.roots; else ++children[node.parent];
  }
  for (const int c : children) result.tips += c == 0, result.furcations += c > 1;
  result.branches = static_cast<int>(tree.branches.size());
  for (const Branch& branch : tree.branches) {
    double arc = 0.0, last = -1.0;
    for (std::size_t k = 0; k < branch.nodes.size(); ++k) {
      const Node& node = skeleton[branch.nodes[k]];
      if (node.parent != kNone) arc += (node.position - skeleton[node.parent].position).norm();
      if (children[branch.nodes[k]] < 2) continue;
      if (last >= 0.0) result.gaps.push_back(arc - last);
      last = arc;
    }
  }
  const std::vector<int> strahler = strahler_orders(skeleton);
  for (int i = 0; i < skeleton.count(); ++i) {
    const int parent = skeleton[i].parent;
    if (parent != kNone && strahler[parent] == strahler[i]) continue;  // a stream begins at its upper end: count its mouth
    if (strahler[i] > static_cast<int>(result.strahler_streams.size())) result.strahler_streams.resize(strahler[i], 0);
    ++result.strahler_streams[strahler[i] - 1];
  }
}

}  // namespace

double quantile(std::vector<double> values, double q) {
  if (values.empty()) return 0.0;
  std::sort(values.begin(), values.end());
  const double at = std::clamp(q, 0.0, 1.0) * static_cast<double>(values.size() - 1);
  const std::size_t below = static_cast<std::size_t>(at), above = std::min(below + 1, values.size() - 1);
  return values[below] + (at - static_cast<double>(below)) * (values[above] - values[below]);
}

double comparison_step(const Skeleton& skeleton) {
  std::vector<double> radii;
  for (const Node& node : skeleton.nodes()) radii.push_back(node.radius);
  return std::clamp(4.0 * quantile(radii, 0.5), 8.0, 16.0);
}

BendSamples measure_bends(const Skeleton& skeleton, double step) {
  BendSamples samples;
  samples.step = step;
  const int run = std::max(2, static_cast<int>(std::nearbyint(kRun / step)));
  for (const Branch& branch : branch_tree(skeleton).branches) {
    const Samples line = traced_line(skeleton, branch);
    if (polyline_length(line.points) < 2.0 * kFine) continue;
    Samples fine = sample(line, kFine);
    if (static_cast<double>(fine.points.size()) < 2.0 * step) continue;
    fine = {gaussian(fine.points, kPointSigma), gaussian(fine.radii, kRadiusSigma)};
    if (polyline_length(fine.points) < 2.0 * step) continue;
    const Samples coarse = sample(fine, step);
    const std::vector<double> turns = turning_angles(coarse.points);
    const std::vector<double> inner(turns.begin() + 1, turns.end() - 1);
    append_runs(inner, run, samples.angles);
    append_runs(coarse.radii, run, samples.radii);
    samples.length += step * static_cast<double>(coarse.points.size());
  }
  return samples;
}

double box_dimension(const Skeleton& skeleton) {
  const Size canvas = skeleton.size;
  if (skeleton.empty() || canvas.width < 1 || canvas.height < 1) return 0.0;
  Mask line(canvas);
  double thinnest = 1e300;
  for (const Node& node : skeleton.nodes()) {
    thinnest = std::min(thinnest, node.radius);
    const Vec2 a = node.xy(), b = node.parent == kNone ? a : skeleton[node.parent].xy();
    const int steps = static_cast<int>(std::min(1e7, std::ceil(4.0 * (b - a).norm()))) + 1;
    for (int k = 0; k <= steps; ++k) {
      const Vec2 p = a + (b - a) * k / steps;
      if (p.x() < -0.5 || p.y() < -0.5 || p.x() >= canvas.width - 0.5 || p.y() >= canvas.height - 0.5) continue;
      line(static_cast<int>(std::lround(p.x())), static_cast<int>(std::lround(p.y()))) = 255;
    }
  }
  std::vector<Vec2> fit;  // (log 1/eps, log N)
  for (int shift = 1; (8 << shift) <= std::max(canvas.width, canvas.height); ++shift) {
    if ((1 << shift) < 2.0 * thinnest) continue;
    Mask boxes((canvas.width >> shift) + 1, (canvas.height >> shift) + 1);
    for (int y = 0; y < canvas.height; ++y) {
      for (int x = 0; x < canvas.width; ++x) {
        if (line(x, y)) boxes(x >> shift, y >> shift) = 1;
      }
    }
    const auto count = std::count(boxes.pixels().begin(), boxes.pixels().end(), 1);
    if (count > 0) fit.emplace_back(-std::log(1 << shift), std::log(static_cast<double>(count)));
  }
  if (fit.size() < 2) return 0.0;
  Vec2 mean = Vec2::Zero();
  for (const Vec2& p : fit) mean += p / static_cast<double>(fit.size());
  double square = 0.0, product = 0.0;
  for (const Vec2& p : fit) square += (p - mean).x() * (p - mean).x(), product += (p - mean).x() * (p - mean).y();
  return product / square;
}

SkeletonStatistics measure_statistics(const Skeleton& skeleton, double step) {
  SkeletonStatistics result;
  const BranchTree tree = branch_tree(skeleton);
  result.bends = measure_bends(skeleton, step > 0.0 ? step : comparison_step(skeleton));
  measure_topology(skeleton, tree, result);
  measure_headings(skeleton, tree, result);
  if (result.bends.length > 0.0) result.furcations_per_1000px = 1000.0 * result.furcations / result.bends.length;
  for (const Branch& branch : tree.branches) {
    const Samples line = traced_line(skeleton, branch);
    const double chord = (line.points.back() - line.points.front()).norm();
    if (branch.length >= kTortuousLength * result.bends.step && chord > 0.0) result.tortuosity.push_back(branch.length / chord);
  }
  std::sort(result.tortuosity.begin(), result.tortuosity.end());
  for (const ChildStart& start : measure_child_starts(skeleton, tree)) {
    if (!start.emerges) continue;
    result.fork_angles.push_back(start.angle);
    result.fork_ratios.push_back(start.ratio);
  }
  result.box_dimension = box_dimension(skeleton);
  result.crossings = static_cast<int>(find_crossings(skeleton).size());
  return result;
}

}  // namespace ramify
