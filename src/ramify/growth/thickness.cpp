// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/growth/thickness.h"

#include <algorithm>
#include <utility>

#include "ramify/skeleton/radius_map.h"

namespace ramify {
namespace {

constexpr double kMostChange = 1.5;  // factor: what grew short of thin branches must not become a picture of thin mains
constexpr double kGap = 1.0;         // px between rims that stay free

bool relatives(const std::vector<GrowingBranch>& branches, int a, int b) {
  return a == b || branches[a].parent == b || branches[b].parent == a;
}

// Px that the node's rim may move out: half of what is free before the next stranger.
double free_room(const GrowthState& state, int number, const Vec2& point, double radius, double wanted) {
  const double limit = 2.0 * wanted - radius + kGap;
  const double rim = state.occupancy.index().nearest_rim(
      point, limit, [&](const Capsule& other) { return !relatives(state.branches, number, other.owner); });
  return std::max(0.0, 0.5 * (rim - radius - kGap));
}

}  // namespace

void match_thickness(GrowthState& state) {
  std::vector<double> radii;
  for (const GrowingBranch& branch : state.branches) {
    for (int i = 0; i < branch.count(); ++i) {
      if (state.ground.on_canvas(branch.points[i])) radii.push_back(branch.radii[i]);
    }
  }
  if (radii.empty()) return;
  const RadiusSpread present = measure_radius_spread(std::move(radii)),
                     wanted = measure_radius_spread(state.style.bending.radius);
  for (int b = 0; b < static_cast<int>(state.branches.size()); ++b) {
    GrowingBranch& branch = state.branches[b];
    for (int i = 0; i < branch.count(); ++i) {
      double& radius = branch.radii[i];
      const double same_share = wanted.radius_at(present.share_at(radius));
      const double mapped = std::clamp(same_share, radius / kMostChange, radius * kMostChange);
      radius = mapped > radius ? std::min(mapped, radius + free_room(state, b, branch.points[i], radius, mapped)) : mapped;
    }
  }
}

}  // namespace ramify
