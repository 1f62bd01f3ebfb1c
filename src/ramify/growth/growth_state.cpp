// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/growth/growth_state.h"

#include <algorithm>
#include <cmath>

namespace ramify {
namespace {

constexpr double kValley = 4.0;  // bend amplitudes: in 1.5 (ALGORITHMS 4.6) only bends within one feature find room
constexpr double kJoin = 0.75;  // features from a drawn course within which another's end belongs to it

// Where branches live in the exemplar, on a canvas of its kind; even where the user placed roots or drew a course.
double habitat_at(const Style& style, const GrowthTarget& target, const Vec2& point) {
  if (!target.roots.empty() || !target.guide_paths.empty() || !target.guide_map.empty()) return 1.0;
  const auto along = [](double value, int side) {
    return std::clamp((value + 0.5) / side * kHabitatCells - 0.5, 0.0, kHabitatCells - 1.0);
  };
  const double x = along(point.x(), target.size.width), y = along(point.y(), target.size.height);
  const int x0 = std::min(static_cast<int>(x), kHabitatCells - 2), y0 = std::min(static_cast<int>(y), kHabitatCells - 2);
  const auto at = [&](int cx, int cy) { return style.hierarchy.habitat[static_cast<std::size_t>(cy * kHabitatCells + cx)]; };
  const double fx = x - x0, fy = y - y0;
  const double value = (at(x0, y0) * (1 - fx) + at(x0 + 1, y0) * fx) * (1 - fy) +
                       (at(x0, y0 + 1) * (1 - fx) + at(x0 + 1, y0 + 1) * fx) * fy;
  return std::max(0.05, value);
}

// What is painted is filled however near branches come to each other.
KeptRoom kept_room(const Style& style, const Ground& ground, double spread) {
  return {spread, ground.painted() ? 0.0 : style.hierarchy.clearance, style.hierarchy.opening};
}

double widest_radius(const Style& style, const GrowthTarget& target) {
  double widest = *std::max_element(style.bending.radius.begin(), style.bending.radius.end());
  for (const GrowthRoot& root : target.roots) widest = std::max(widest, root.radius.value_or(0.0));
  return widest;
}

}  // namespace

GrowthState::GrowthState(const Style& style_, const GrowthTarget& target_, const GrowOptions& options_, Rng rng_,
                         const Monitor& monitor_)
    : style(style_),
      target(target_),
      options(options_),
      monitor(monitor_),
      rng(rng_),
      ground(target),
      drawn(drawn_courses(target, ground, kJoin * style.feature_size, 4.0 * style.step, monitor)),
      spacing(painted_spacing(style, ground)),
      coverage(target.size, spacing, [&](const Vec2& p) { return ground.wanted(p) * habitat_at(style, target, p); }),
      demand(ground.painted() ? Demand(ground, spacing, options.length) : Demand()),
      occupancy(ground, widest_radius(style, target), kept_room(style, ground, spread()), style.step),
      matcher(style.bending),
      window_uses(style.bending.point.size(), 0),
      template_uses(style.hierarchy.branches.size(), 0) {
  angles.low = style.bending.angles.low;
  angles.high = style.bending.angles.high;
  radii.low = style.bending.radii.low;
  radii.high = style.bending.radii.high;
  const double exemplar_area = static_cast<double>(style.exemplar_size.width) * style.exemplar_size.height;
  const double canvas_area = static_cast<double>(target.size.width) * target.size.height;
  wanted_length = options.length * style.hierarchy.total_length * canvas_area / exemplar_area;
  if (ground.painted()) crowding = std::min(1.0, style.hierarchy.total_length / exemplar_area * spacing);
  double joining = 0.0;  // px of branches that end on others
  for (int b = 0; b < style.bending.branch_count(); ++b) {
    if (style.hierarchy.branches[b].end == BranchEnd::Join) joining += (style.bending.length_of(b) - 1) * style.step;
  }
  nets = joining > 0.5 * style.hierarchy.total_length && !ground.painted() && !options.paper_exact;
  const double width = options.guide_width > 0.0 ? options.guide_width : kValley * bend_amplitude(style.bending);
  for (const DrawnCourse& course : drawn) courses.emplace_back(course.path, width);
}

double GrowthState::progress(const GrowingBranch& branch) const {
  const double arc = branch.arc(style.step);
  // Bends make the branch longer than its course, cut corners shorter.
  return courses[branch.followed].arc_at(branch.points.back(), 0.3 * arc - 2.0 * style.feature_size, 1.1 * arc + 2.0 * style.feature_size);
}

int GrowthState::start(const GrowingBranch& branch) {
  branches.push_back(branch);
  branches.back().joins = style.hierarchy.branches[branch.source].end == BranchEnd::Join && !options.paper_exact;
  const int number = static_cast<int>(branches.size()) - 1;
  if (branch.parent != kNone) {
    occupancy.add_link(branches[branch.parent].points[branch.parent_node], branch.points.front(), number);
    branches[branch.parent].forks.push_back({branch.parent_node, side_of(branch.source, branch.mirrored)});
  }
  coverage.cover(branch.points.front(), branch.radii.front(), 1);
  ++template_uses[branch.source];
  return number;
}

int GrowthState::forks() const {
  return static_cast<int>(std::count_if(branches.begin(), branches.end(), [](const GrowingBranch& b) { return b.parent != kNone; }));
}

double GrowthState::wanted_forks() const {
  const auto& learnt = style.hierarchy.branches;
  const auto children = std::count_if(learnt.begin(), learnt.end(), [](const SourceBranch& b) { return b.parent != kNone; });
  return static_cast<double>(children) * grown_length / style.hierarchy.total_length;
}

std::vector<int> GrowthState::twigs() const {
  std::vector<int> twigs;
  for (int b = 0; b < style.bending.branch_count(); ++b) {
    if (style.hierarchy.branches[b].parent != kNone) twigs.push_back(b);
  }
  std::stable_sort(twigs.begin(), twigs.end(),
                   [&](int a, int b) { return style.bending.length_of(a) < style.bending.length_of(b); });
  twigs.resize((twigs.size() + 1) / 2);
  return twigs;
}

double GrowthState::left_for_twigs() const {
  const std::vector<int> short_ones = twigs();
  const double twig =
      short_ones.empty() ? 0.0 : (style.bending.length_of(short_ones[short_ones.size() / 2]) - 1) * style.step;
  const double rate = wanted_forks() / std::max(1.0, grown_length);
  const double missing = rate * wanted_length - forks() - 1;
  return 1.05 * wanted_length - twig * std::max(0.0, missing) - grown_length;
}

int GrowthState::side_of(int source, bool mirrored) const {
  return (style.hierarchy.branches[source].start_angle > 0.0) != mirrored ? 1 : -1;
}

void GrowthState::commit(int number, const Extension& extension) {
  GrowingBranch& branch = branches[number];
  for (std::size_t j = 0; j < extension.points.size(); ++j) {
    grown_length += (extension.points[j] - branch.points.back()).norm();
    branch.turns.back() = extension.turns[j];
    branch.points.push_back(extension.points[j]);
    branch.radii.push_back(extension.radii[j]);
    branch.turns.push_back(0.0);
    branch.copied.push_back(extension.copied[j]);
    occupancy.add_edge(branch, number, branch.count() - 1);
    coverage.cover(extension.points[j], extension.radii[j], 1);
    demand.add(extension.points[j], branch.points[branch.points.size() - 2], 1);
    angles.add(extension.turns[j]);
    radii.add(extension.radii[j]);
    if (extension.copied[j] != 0) ++window_uses[std::abs(extension.copied[j]) - 1];
  }
  branch.stop = extension.stop;
}

void GrowthState::step_back(int number, int count) {
  GrowingBranch& branch = branches[number];
  for (int j = 0; j < count && branch.count() > 1; ++j) {
    occupancy.remove_last();
    coverage.cover(branch.points.back(), branch.radii.back(), -1);
    demand.add(branch.points.back(), branch.points[branch.points.size() - 2], -1);
    grown_length -= (branch.points.back() - branch.points[branch.count() - 2]).norm();
    angles.add(branch.turns[branch.count() - 2], -1.0);
    radii.add(branch.radii.back(), -1.0);
    if (branch.copied.back() != 0) --window_uses[std::abs(branch.copied.back()) - 1];
    branch.points.pop_back();
    branch.radii.pop_back();
    branch.turns.pop_back();
    branch.copied.pop_back();
    branch.turns.back() = 0.0;
  }
  branch.stop = GrowthStop::None;
}

void GrowthState::take_back(int number) {
  step_back(number, branches[number].count());
  const GrowingBranch& branch = branches[number];
  coverage.cover(branch.points.front(), branch.radii.front(), -1);
  --template_uses[branch.source];
  if (branch.parent != kNone) {
    occupancy.remove_last();
    branches[branch.parent].forks.pop_back();
  }
  branches.pop_back();
}

double GrowthState::template_radius(const GrowingBranch& branch, double arc) const {
  const BendingModel& bending = style.bending;
  const int first = bending.first[branch.source], last = bending.length_of(branch.source) - 1;
  const double place = std::clamp(arc / std::max(branch.length, style.step), 0.0, 1.0) * last;
  const int i = std::min(static_cast<int>(place), std::max(0, last - 1));
  const double f = place - i;
  const double low = bending.smooth_radius[first + i], high = bending.smooth_radius[first + std::min(i + 1, last)];
  return branch.radius_scale * (low + (high - low) * f);
}

}  // namespace ramify
