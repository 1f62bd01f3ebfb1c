// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/style/style.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "ramify/geometry/polyline.h"
#include "ramify/style/cleaning.h"

namespace ramify {
namespace {

constexpr double kPixelSmoothing = 2.0;  // px: a traced skeleton's staircase is not style (PICTURES 10)
constexpr int kFewestVertices = 40;

// Running median over `reach` px to both sides: a width probe that slipped makes a blob, not a style.
std::vector<double> without_blobs(const std::vector<double>& radii, const std::vector<double>& arcs, double reach) {
  std::vector<double> out(radii.size());
  std::size_t first = 0, last = 0;
  std::vector<double> window;
  for (std::size_t i = 0; i < radii.size(); ++i) {
    while (arcs[i] - arcs[first] > reach) ++first;
    while (last + 1 < radii.size() && arcs[last + 1] - arcs[i] <= reach) ++last;
    window.assign(radii.begin() + static_cast<std::ptrdiff_t>(first), radii.begin() + static_cast<std::ptrdiff_t>(last) + 1);
    const auto middle = window.begin() + static_cast<std::ptrdiff_t>(window.size() / 2);
    std::nth_element(window.begin(), middle, window.end());
    out[i] = *middle;
  }
  return out;
}

BendingBranch resampled(const CleanBranch& branch, double step, double feature_size) {
  const std::vector<double> arcs = arc_lengths(branch.points);
  const std::vector<Vec2> smooth = smooth_polyline(branch.points, kPixelSmoothing);
  const std::vector<double> radii = smooth_values(without_blobs(branch.radii, arcs, 0.5 * feature_size), arcs, 2.0 * kPixelSmoothing);
  const std::vector<double> smooth_arcs = arc_lengths(smooth);
  BendingBranch out;
  const SampledPolyline sampled = resample_chord(smooth, step);
  out.points = sampled.points;
  for (const double arc : sampled.arcs) out.radii.push_back(std::max(0.5, value_at_arc(radii, smooth_arcs, arc)));
  return out;
}

// How a child sits on its parent, seen from outside the parent's rim (PICTURES 3).
void tie_to_parent(SourceBranch& child, const BendingBranch& own, const BendingBranch& parent, const Vec2& junction,
                   int extension) {
  const int last = static_cast<int>(parent.points.size()) - 1;
  int at = nearest_point(parent.points, junction);
  if (last >= 2) at = std::clamp(at, 1, last - 1);
  child.parent_vertex = at;
  const double along = angle_of(parent.points[std::min(last, at + 2)] - parent.points[std::max(0, at - 2)]);
  child.rim_angle = wrap_angle(angle_of(own.points.front() - parent.points[at]) - along);
  const std::size_t ahead = std::min<std::size_t>(3, own.points.size() - 1);
  child.start_angle = wrap_angle(angle_of(own.points[ahead] - own.points.front()) - along);
  std::vector<double> start(own.radii.begin(), own.radii.begin() + std::min<std::ptrdiff_t>(
                                                                       static_cast<std::ptrdiff_t>(own.radii.size()), 2 * extension));
  std::nth_element(start.begin(), start.begin() + static_cast<std::ptrdiff_t>(start.size() / 2), start.end());
  child.ratio = start[start.size() / 2] / parent.radii[at];
}

struct Learnt {
  std::vector<BendingBranch> bends;
  std::vector<SourceBranch> sources;
};

Learnt resample_all(const std::vector<CleanBranch>& branches, double step, int extension) {
  Learnt learnt;
  std::vector<int> kept(branches.size(), kNone);
  for (std::size_t b = 0; b < branches.size(); ++b) {
    const CleanBranch& branch = branches[b];
    if (branch.parent != kNone && kept[branch.parent] == kNone) continue;
    BendingBranch bend = resampled(branch, step, step * extension);
    if (bend.points.size() < 4) continue;
    kept[b] = static_cast<int>(learnt.bends.size());
    SourceBranch source;
    source.order = branch.order;
    source.tree = branch.tree;
    source.starts_on_frame = branch.starts_on_frame;
    source.starts_on_landmark = branch.starts_on_landmark;
    source.end = branch.end;
    if (branch.parent != kNone) {
      source.parent = kept[branch.parent];
      tie_to_parent(source, bend, learnt.bends[source.parent], branch.junction, extension);
    }
    learnt.bends.push_back(std::move(bend));
    learnt.sources.push_back(source);
  }
  return learnt;
}

}  // namespace

std::vector<OptionField> describe(LearnStyleOptions& options) {
  return {
      number("feature-size", options.feature_size, 0.0, 10000.0, "px", "Size of a typical bend; 0 measures it."),
      number("extension", options.extension, 2, 64, "", "Vertices per feature size: m of the paper."),
      number("history", options.history, 0, 4096, "", "Vertices compared with the exemplar: k of the paper; 0 = 3 m."),
      flag("mirror-bends", options.mirror, "Learn every bend also mirrored."),
      flag("signed-angles", options.signed_angles, "Furcations learn signed turning angles, as the paper does."),
      flag("platt-probabilities", options.platt_probabilities,
           "Furcation probabilities from five random folds, as the paper's library does."),
      flag("paper-exact", options.paper_exact, "Learn as paper 002 writes it, without our changes."),
  };
}

Style learn_style(const Skeleton& exemplar, const LearnStyleOptions& given, const Monitor& monitor,
                  const std::vector<NodePlace>& places) {
  LearnStyleOptions options = given;
  check_options(describe(options));
  if (exemplar.size.width < 1 || exemplar.size.height < 1) throw InputError("", "the skeleton has no canvas size");
  std::vector<CleanBranch> branches = clean_branches(exemplar, places, monitor);
  monitor.report(0.2);
  Style style;
  style.exemplar_size = exemplar.size;
  style.mirror = options.mirror;
  style.feature_size =
      options.feature_size > 0.0 ? options.feature_size : measure_feature_size(branches, exemplar.size);
  style.step = style.feature_size / options.extension;
  turn_frame_roots(branches, style.feature_size);
  mark_joins(branches, std::max(4.0, style.step));
  Learnt learnt = resample_all(branches, style.step, options.extension);
  style.bending = make_bending(learnt.bends, style.step, options.extension,
                               options.history > 0 ? options.history : 3 * options.extension, options.mirror);
  if (style.bending.vertex_count() < kFewestVertices) {
    throw InputError("", "the skeleton is too small to learn from: " + std::to_string(style.bending.vertex_count()) +
                             " steps of " + number_text(style.step) + " px along its branches, at least " +
                             std::to_string(kFewestVertices) + " are needed; annotate more or longer branches");
  }
  style.unit_radius = std::accumulate(style.bending.radius.begin(), style.bending.radius.end(), 0.0) /
                      style.bending.vertex_count();
  style.hierarchy.branches = std::move(learnt.sources);
  measure_hierarchy(style.hierarchy, style.bending, exemplar.size);
  monitor.report(0.5);
  const FurcationOptions furcation{!(options.signed_angles || options.paper_exact),
                                   options.platt_probabilities || options.paper_exact};
  style.furcation = learn_furcations(style.bending, style.hierarchy, furcation, monitor);
  monitor.report(1.0);
  return style;
}

}  // namespace ramify
