// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/growth/thickness.h"

#include <algorithm>

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

double at_same_share(const std::vector<double>& present, const std::vector<double>& wanted, double value) {
  const auto [low, high] = std::equal_range(present.begin(), present.end(), value);
  // Half of those that are equal lie below.
  const double below = 0.5 * static_cast<double>((low - present.begin()) + (high - present.begin()));
  const double place = below / static_cast<double>(present.size()) * static_cast<double>(wanted.size() - 1);
  const std::size_t i = std::min(static_cast<std::size_t>(place), wanted.size() - 1), next = std::min(i + 1, wanted.size() - 1);
  return wanted[i] + (wanted[next] - wanted[i]) * (place - static_cast<double>(i));
}

void match_thickness(GrowthState& state) {
  std::vector<double> wanted = state.style.bending.radius, present;
  for (const GrowingBranch& branch : state.branches) {
    for (int i = 0; i < branch.count(); ++i) {
      if (state.ground.on_canvas(branch.points[i])) present.push_back(branch.radii[i]);
    }
  }
  if (present.empty()) return;
  std::sort(wanted.begin(), wanted.end());
  std::sort(present.begin(), present.end());
  for (int b = 0; b < static_cast<int>(state.branches.size()); ++b) {
    GrowingBranch& branch = state.branches[b];
    for (int i = 0; i < branch.count(); ++i) {
      double& radius = branch.radii[i];
      const double mapped = std::clamp(at_same_share(present, wanted, radius), radius / kMostChange, radius * kMostChange);
      radius = mapped > radius ? std::min(mapped, radius + free_room(state, b, branch.points[i], radius, mapped)) : mapped;
    }
  }
}

}  // namespace ramify
