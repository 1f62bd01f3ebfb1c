// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/growth/sending.h"

#include <algorithm>
#include <cmath>

#include "ramify/growth/children.h"

namespace ramify {
namespace {

constexpr std::size_t kTemplates = 4;
constexpr int kStarts = 6;
constexpr double kThin = 0.6;  // of its width: what finds no room may find some thinner

// Children of the exemplar about as long as wanted, on parents as wide; the best few.
std::vector<int> templates_for(const GrowthState& state, double parent_radius, double wanted, Rng& rng) {
  std::vector<std::pair<double, int>> ranked;
  const BendingModel& bending = state.style.bending;
  for (int b = 0; b < bending.branch_count(); ++b) {
    const SourceBranch& source = state.style.hierarchy.branches[b];
    if (source.parent == kNone) continue;
    const double width =
        std::log(bending.smooth_radius[bending.first[source.parent] + source.parent_vertex] / parent_radius);
    const double length = std::log((bending.length_of(b) - 1) * bending.step / std::max(3.0 * bending.step, wanted));
    ranked.emplace_back(width * width + length * length + 0.1 * state.template_uses[b] + 0.3 * rng.normal(), b);
  }
  std::sort(ranked.begin(), ranked.end());
  std::vector<int> best;
  for (std::size_t i = 0; i < std::min(kTemplates, ranked.size()); ++i) best.push_back(ranked[i].second);
  return best;
}

}  // namespace

Errand cheapest_start(const GrowthState& state, const Vec2& goal, int most_order, double most,
                      const std::function<double(const GrowingBranch&, int, const Vec2&, double)>& cost,
                      const std::function<bool(const Vec2&)>& allowed) {
  Errand best;
  for (int b = 0; b < static_cast<int>(state.branches.size()); ++b) {
    const GrowingBranch& branch = state.branches[b];
    if (branch.order >= most_order) continue;
    for (int i = 2; i + 2 < branch.count(); ++i) {
      const Vec2 way = goal - branch.points[i];
      const double distance = way.norm();
      if (distance >= most) continue;
      const double dear = cost(branch, i, way, distance);
      if (dear >= most || fork_blocked(state, branch, i, 0) || !allowed(branch.points[i])) continue;
      most = dear;
      best.parent = b;
      best.node = i;
    }
  }
  return best;
}

int send_branch(GrowthState& state, const Errand& errand, Rng& rng) {
  const GrowingBranch& parent = state.branches[errand.parent];
  const Vec2 way = errand.goal - parent.points[errand.node];
  const bool clockwise = cross(direction_of(tangent_at(parent, errand.node)), way) > 0.0;
  ChildPlan plan;
  plan.parent = errand.parent;
  plan.node = errand.node;
  plan.heading = angle_of(way);
  plan.most_length = errand.most_length;
  plan.followed = errand.followed;
  const std::vector<int> sources = templates_for(state, parent.radii[errand.node], errand.length, rng);
  for (std::size_t i = 0; i < 2 * sources.size(); ++i) {
    const int source = sources[i % sources.size()];
    plan.source = source;
    plan.width_factor = i < sources.size() ? 1.0 : kThin;
    plan.mirrored = (state.style.hierarchy.branches[source].start_angle > 0.0) != clockwise;
    if (plan.mirrored && !state.style.mirror) continue;
    if (errand.followed != kNone)
      plan.length_factor = errand.most_length / ((state.style.bending.length_of(source) - 1) * state.style.step);
    const int child = place_child(state, plan, rng);
    if (child != kNone) return child;
  }
  return kNone;
}

int send_along(GrowthState& state, int course, int parent, Rng& rng) {
  const Course& way = state.courses[course];
  const Vec2 start = way.point_at(0.0);
  std::vector<std::pair<double, int>> nodes;
  const GrowingBranch& branch = state.branches[parent];
  for (int i = 1; i + 2 < branch.count(); ++i) {
    if (!fork_blocked(state, branch, i, 0)) nodes.emplace_back((branch.points[i] - start).norm(), i);
  }
  std::sort(nodes.begin(), nodes.end());
  if (nodes.size() > kStarts) nodes.resize(kStarts);
  for (const auto& [distance, node] : nodes) {
    Errand errand{parent, node, way.point_at(std::min(0.5 * way.length(), 2.0 * state.style.feature_size + distance))};
    errand.length = 1.1 * way.length();
    errand.most_length = 1.3 * way.length() + distance;
    errand.followed = course;
    const int child = send_branch(state, errand, rng);
    if (child != kNone) return child;
  }
  return kNone;
}

}  // namespace ramify
