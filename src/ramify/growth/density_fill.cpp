// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/growth/density_fill.h"

#include <algorithm>
#include <cmath>

#include "ramify/growth/children.h"
#include "ramify/growth/headings.h"
#include "ramify/growth/sending.h"

namespace ramify {
namespace {

constexpr int kLooks = 8,
              kNetLooks = 32;  // unfilled cells of which the farthest is taken; in a net at last any, for short cracks
constexpr int kMostTries = 4000;
constexpr int kMostFailures = 40;
constexpr int kMostBans = 2;
constexpr double kNetFilled = 0.88;  // of the length: closing the net and its spurs take the rest
constexpr double kNever = 1e300;
constexpr double kRareHeading = 0.5;  // of what even shares would be: where the exemplar's branches hardly ever go
constexpr double kMostForks = 1.1;  // times the exemplar's, after which length is no reason for more branches

class Filler {
 public:
  Filler(GrowthState& state, int most_order)
      : state_(state), most_order_(most_order), failures_(state.coverage.cells(), 0) {}

  void run() {
    int failures = 0;
    for (int round = 0; round < kMostTries && failures < kMostFailures; ++round) {
      state_.monitor.check();
      if (state_.full() || state_.forks() > kMostForks * state_.wanted_forks()) return;
      if (state_.net() && !state_.twigs_added && state_.left_for_twigs() <= 0.0) return;
      if (state_.net() && state_.grown_length > kNetFilled * state_.wanted_length) return;
      Rng rng = state_.rng.child(state_.twigs_added ? "grow.refill" : "grow.fill", static_cast<std::uint64_t>(round));
      const int cell = pick_cell(rng);
      if (cell == kNone) return;
      const bool sent = send_to(cell, rng);
      failures = sent ? 0 : failures + 1;
      if (!sent) ban(cell);
    }
  }

 private:
  // An unfilled cell, drawn by weight, the farthest from what has grown of several.
  int pick_cell(Rng& rng) {
    std::vector<int> open;
    std::vector<double> weights;
    for (int c = 0; c < state_.coverage.cells(); ++c) {
      if (state_.coverage.covered(c) || failures_[c] >= kMostBans || state_.coverage.weight(c) <= kBlack) continue;
      open.push_back(c);
      weights.push_back(state_.coverage.weight(c));
    }
    if (open.empty()) return kNone;
    int best = kNone;
    double farthest = -1.0;
    const int looks = !state_.net() ? kLooks : state_.twigs_added ? 1 : kNetLooks;
    for (int look = 0; look < looks; ++look) {
      const int cell = open[static_cast<std::size_t>(rng.discrete(weights))];
      const double reach = 4.0 * state_.spacing;
      const double distance =
          state_.coverage.weight(cell) * state_.occupancy.index().nearest_rim(state_.coverage.center_of(cell), reach,
                                                                              [](const Capsule&) { return true; });
      if (distance > farthest) {
        farthest = distance;
        best = cell;
      }
    }
    return best;
  }

  // The nearest node, ahead rather than back, along directions the style likes.
  Errand nearest_start(const Vec2& goal) const {
    const auto cost = [&](const GrowingBranch& branch, int node, const Vec2& way, double distance) {
      const double back = std::max(0.0, 0.3 - direction_of(tangent_at(branch, node)).dot(way) / (distance + 1e-9));
      if (state_.net()) return distance * (1.0 + back);
      const Headings& headings = state_.style.hierarchy.headings[std::min(branch.order + 1, kHeadingOrders - 1)];
      const double most = *std::max_element(headings.share.begin(), headings.share.end());
      const double share = share_at(headings, angle_of(way));
      if (share < kRareHeading * headings.strength / kHeadingBins) return kNever;
      return distance * (1.0 + back) * (headings.strength >= 0.15 ? 1.0 + 2.0 * (1.0 - share / most) : 1.0);
    };
    return cheapest_start(state_, goal, most_order_, kNever, cost, [](const Vec2&) { return true; });
  }

  bool send_to(int cell, Rng& rng) {
    const Vec2 goal = state_.coverage.center_of(cell);
    Errand errand = nearest_start(goal);
    if (errand.parent == kNone) return false;
    const double distance = (goal - state_.branches[errand.parent].points[errand.node]).norm();
    errand.goal = goal;
    errand.length = 1.6 * distance;
    errand.most_length = std::max(2.5 * distance, 4.0 * state_.style.step);
    return send_branch(state_, errand, rng) != kNone;
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
  if (any_child) Filler(state, most_order).run();
}

}  // namespace ramify
