// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/growth/density_fill.h"

#include <algorithm>
#include <cmath>

#include "ramify/growth/children.h"
#include "ramify/growth/headings.h"
#include "ramify/growth/roots.h"

namespace ramify {
namespace {

constexpr int kLooks = 8;            // unfilled cells of which the farthest is taken
constexpr int kMostTries = 4000;
constexpr double kPaintedShare = 0.97;

class Filler {
 public:
  Filler(GrowthState& state, int most_order) : state_(state), most_order_(most_order), failures_(state.coverage.cells(), 0) {}

  void run() {
    const int most_failures = state_.ground.painted() ? 1000 : 40;
    // A branch every half reach would fill the plane twice over: beyond that the map asks for what cannot be.
    const double most_length = 4.0 * state_.wanted_length + 4.0 * state_.ground.open_area() / state_.style.hierarchy.spacing;
    int failures = 0;
    for (int round = 0; round < kMostTries && failures < most_failures; ++round) {
      state_.monitor.check();
      if (state_.full() && !state_.ground.painted()) return;
      if (state_.grown_length > most_length) return;
      if (state_.ground.painted() && state_.coverage.filled_share() > kPaintedShare) return;
      Rng rng = state_.rng.child("grow.fill", static_cast<std::uint64_t>(round));
      const int cell = pick_cell(rng);
      if (cell == kNone) return;
      const bool sent = send_branch(cell, rng);
      failures = sent ? 0 : failures + 1;
      if (!sent) ban(cell);
    }
  }

 private:
  struct Start {
    int branch = kNone;
    int node = 0;
    double distance = 0.0;
  };

  // An unfilled cell, drawn by weight, the farthest from what has grown of several.
  int pick_cell(Rng& rng) {
    const int most_bans = state_.ground.painted() ? 5 : 2;
    std::vector<int> open;
    std::vector<double> weights;
    for (int c = 0; c < state_.coverage.cells(); ++c) {
      if (state_.coverage.covered(c) || failures_[c] >= most_bans || state_.coverage.weight(c) <= kBlack) continue;
      open.push_back(c);
      weights.push_back(state_.coverage.weight(c));
    }
    if (open.empty()) return kNone;
    int best = kNone;
    double farthest = -1.0;
    for (int look = 0; look < kLooks; ++look) {
      const int cell = open[static_cast<std::size_t>(rng.discrete(weights))];
      const double reach = 4.0 * state_.style.hierarchy.spacing;
      const double distance = state_.coverage.weight(cell) *
                              state_.occupancy.index().nearest_rim(state_.coverage.center_of(cell), reach,
                                                                   [](const Capsule&) { return true; });
      if (distance > farthest) {
        farthest = distance;
        best = cell;
      }
    }
    return best;
  }

  bool sees(const Vec2& from, const Vec2& to) const {
    const int samples = std::max(2, static_cast<int>((to - from).norm() / 4.0));
    for (int i = 1; i < samples; ++i) {
      if (state_.ground.wanted(from + (to - from) * (static_cast<double>(i) / samples)) <= kBlack) return false;
    }
    return true;
  }

  // The nearest node a child could leave from, ahead rather than back, along directions the style likes.
  Start nearest_start(const Vec2& goal) const {
    Start best;
    best.distance = 1e300;
    for (int b = 0; b < static_cast<int>(state_.branches.size()); ++b) {
      const GrowingBranch& branch = state_.branches[b];
      if (branch.order >= most_order_) continue;
      for (int i = 2; i + 2 < branch.count(); ++i) {
        const Vec2 way = goal - branch.points[i];
        double distance = way.norm();
        if (distance >= best.distance) continue;
        const double back = std::max(0.0, 0.3 - direction_of(tangent_at(branch, i)).dot(way) / (distance + 1e-9));
        distance *= 1.0 + back;
        if (!state_.ground.painted()) {
          const Headings& headings = state_.style.hierarchy.headings[std::min(branch.order + 1, kHeadingOrders - 1)];
          const double most = *std::max_element(headings.share.begin(), headings.share.end());
          const double share = headings.share[static_cast<std::size_t>(heading_bin(angle_of(way)))];
          if (headings.strength >= 0.15) distance *= 1.0 + 2.0 * (1.0 - share / most);
        }
        if (distance >= best.distance || fork_blocked(state_, branch, i, 0) || !sees(branch.points[i], goal)) continue;
        best = {b, i, distance};
      }
    }
    return best;
  }

  bool send_branch(int cell, Rng& rng) {
    const Vec2 goal = state_.coverage.center_of(cell);
    const Start start = nearest_start(goal);
    if (start.branch == kNone) return state_.ground.painted() && plant_root(goal, rng);
    const GrowingBranch& parent = state_.branches[start.branch];
    const Vec2 way = goal - parent.points[start.node];
    const double distance = way.norm();
    const bool clockwise = cross(direction_of(tangent_at(parent, start.node)), way) > 0.0;
    for (const int source : templates_for(parent.radii[start.node], distance, rng)) {
      ChildPlan plan;
      plan.parent = start.branch;
      plan.node = start.node;
      plan.source = source;
      plan.mirrored = (state_.style.hierarchy.branches[source].start_angle > 0.0) != clockwise;
      if (plan.mirrored && !state_.style.mirror) continue;
      plan.heading = angle_of(way);
      plan.most_length = std::max(2.5 * distance, 4.0 * state_.style.step);
      if (place_child(state_, plan, rng) != kNone) return true;
    }
    return false;
  }

  // Children of the exemplar about 1.6 times as long as the way, on parents as wide; the best few.
  std::vector<int> templates_for(double parent_radius, double distance, Rng& rng) const {
    std::vector<std::pair<double, int>> ranked;
    const BendingModel& bending = state_.style.bending;
    for (int b = 0; b < bending.branch_count(); ++b) {
      const SourceBranch& source = state_.style.hierarchy.branches[b];
      if (source.parent == kNone) continue;
      const double width = std::log(bending.smooth_radius[bending.first[source.parent] + source.parent_vertex] / parent_radius);
      const double length = std::log((bending.length_of(b) - 1) * bending.step / std::max(3.0 * bending.step, 1.6 * distance));
      ranked.emplace_back(width * width + length * length + 0.1 * state_.template_uses[b] + 0.3 * rng.normal(), b);
    }
    std::sort(ranked.begin(), ranked.end());
    std::vector<int> best;
    for (std::size_t i = 0; i < std::min<std::size_t>(4, ranked.size()); ++i) best.push_back(ranked[i].second);
    return best;
  }

  // An island of white: a root of its own, in the direction of the longest free way.
  bool plant_root(const Vec2& goal, Rng& rng) {
    if (state_.ground.blocked(goal)) return false;
    const std::vector<int> roots = root_templates(state_.style);
    RootPlan plan;
    plan.source = roots[static_cast<std::size_t>(rng.below(static_cast<int>(roots.size())))];
    plan.position = goal;
    double best = -1.0;
    for (int i = 0; i < 16; ++i) {
      const double direction = -kPi + i * kPi / 8.0;
      double way = 0.0;
      for (int j = 1; j <= 10; ++j) way += state_.coverage.unfilled(goal + direction_of(direction) * (12.0 * j));
      if (way > best) {
        best = way;
        plan.direction = direction;
      }
    }
    plan.length = (state_.style.bending.length_of(plan.source) - 1) * state_.style.step;
    return place_root(state_, plan, rng) != kNone;
  }

  void ban(int cell) {
    const Vec2 center = state_.coverage.center_of(cell);
    for (int dy = -2; dy <= 2; ++dy) {
      for (int dx = -2; dx <= 2; ++dx) {
        const int other = state_.coverage.cell_at(center + Vec2(dx, dy) * state_.coverage.cell_side());
        if (other != kNone) ++failures_[other];
      }
    }
  }

  GrowthState& state_;
  int most_order_;
  std::vector<int> failures_;
};

}  // namespace

void fill_wanted(GrowthState& state, int most_order) {
  const bool any_child = std::any_of(state.style.hierarchy.branches.begin(), state.style.hierarchy.branches.end(),
                                     [](const SourceBranch& b) { return b.parent != kNone; });
  if (any_child || state.ground.painted()) Filler(state, most_order).run();
}

}  // namespace ramify
