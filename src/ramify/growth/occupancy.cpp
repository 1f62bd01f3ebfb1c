// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/growth/occupancy.h"

#include <algorithm>
#include <cmath>

#include "ramify/geometry/segment.h"
#include "ramify/style/hierarchy.h"

namespace ramify {
namespace {

constexpr int kLinkPlace = -1;  // place of the capsule that ties a child to its parent's axis

// Clear space two branches keep between their rims, px.
double kept_gap(const Capsule& a, const Capsule& b) {
  return std::max(1.0, 0.5 * std::min(std::min(a.radius_a, a.radius_b), std::min(b.radius_a, b.radius_b)));
}

// Roots that start where another does, as strokes from one cloud or vessels from one disc.
bool share_start(const GrowingBranch& a, const GrowingBranch& b) {
  return a.parent == kNone && b.parent == kNone &&
         (a.points.front() - b.points.front()).norm() < a.radii.front() + b.radii.front() + kStartTogether;
}

bool meets_itself(const Capsule& own, const Extension& extension, std::size_t from, double step) {
  for (std::size_t j = from + 1; j < extension.points.size(); ++j) {
    const double arc = static_cast<double>(j - from) * step;
    const double distance = segment_distance(own.a, own.b, extension.points[j - 1], extension.points[j]);
    if (j > from + 1 && distance < 0.5 * step) return true;
    if (arc > 6.0 * own.widest() + 4.0 * step && distance < 2.0 * own.widest() + 1.0) return true;
  }
  return false;
}

}  // namespace

Occupancy::Occupancy(const Ground& ground, double widest, const KeptRoom& room, double step)
    : ground_(ground),
      room_(room),
      step_(step),
      widest_(widest),
      index_(Vec2(-widest, -widest), Vec2(ground.size().width + widest, ground.size().height + widest),
             std::clamp(2.0 * widest, 16.0, 40.0)) {}

void Occupancy::add_link(const Vec2& junction, const Vec2& start, int branch) {
  index_.add({junction, start, 0.0, 0.0, branch, kLinkPlace});
}

void Occupancy::add_edge(const GrowingBranch& branch, int number, int node) {
  index_.add(
      {branch.points[node - 1], branch.points[node], branch.radii[node - 1], branch.radii[node], number, node - 1});
}

bool Occupancy::blocked_ground(const Capsule& edge) const {
  const Vec2 across = perpendicular(edge.b - edge.a).stableNormalized() * edge.radius_b;
  return ground_.blocked(edge.b) || ground_.blocked(0.5 * (edge.a + edge.b)) || ground_.blocked(edge.b + across) ||
         ground_.blocked(edge.b - across);
}

Occupancy::Verdict Occupancy::judge(const std::vector<GrowingBranch>& branches, int number, const Capsule& edge,
                                    const Capsule& other, double clearance) const {
  const GrowingBranch& branch = branches[number];
  const double widths = edge.widest() + other.widest();
  const double room = std::max(kept_gap(edge, other), std::min(clearance, room_.opening * edge.place * step_));
  if (other.owner == number) {
    if (edge.place - other.place < 2) return Verdict::Clear;
    const double distance = segment_distance(edge.a, edge.b, other.a, other.b);
    // On a thick parent a child has room to turn back to the link it hangs on.
    if (other.place == kLinkPlace) return distance < 0.25 ? Verdict::Blocked : Verdict::Clear;
    if (distance < 0.5 * step_) return Verdict::Blocked;
    // Near along the branch it may come near in space: a bend, not a touch.
    if ((edge.place - other.place) * step_ < 3.0 * (widths + 0.5 * clearance) + 4.0 * step_) return Verdict::Clear;
    return distance < widths + std::max(kept_gap(edge, other), 0.5 * clearance) ? Verdict::Blocked : Verdict::Clear;
  }
  const double distance = segment_distance(edge.a, edge.b, other.a, other.b);
  if (branch.parent != kNone && other.owner == branch.parent && other.place != kLinkPlace) {
    const GrowingBranch& parent = branches[branch.parent];
    const double rim = parent.radii[branch.parent_node];
    const bool near = edge.place * step_ < 2.0 * rim + 4.0 * step_ &&
                      std::abs(other.place - branch.parent_node) * step_ < 3.0 * rim + 5.0 * step_;
    if (near) {
      // A child starts half a pixel off its parent's rim: on a thin parent it must not be asked for more than that.
      const double clear =
          std::min(std::max(0.25 * step_, 0.6 * std::min(other.radius_a, other.radius_b)), 0.6 * (rim + 0.5));
      return distance < clear ? Verdict::Blocked : Verdict::Clear;
    }
  }
  if (share_start(branch, branches[other.owner]) && edge.place * step_ < 2.0 * widths + 4.0 * step_) {
    return distance < 0.25 * step_ ? Verdict::Blocked : Verdict::Clear;
  }
  return distance < widths + room ? Verdict::Meets : Verdict::Clear;
}

Hit Occupancy::meet(const std::vector<GrowingBranch>& branches, int number, const Extension& extension,
                    bool joining) const {
  const double clearance = joining ? 0.0 : room_.clearance;
  const GrowingBranch& branch = branches[number];
  Vec2 from = branch.points.back();
  double from_radius = branch.radii.back();
  for (std::size_t j = 0; j < extension.points.size(); ++j) {
    const Capsule edge{
        from, extension.points[j], from_radius, extension.radii[j], number, branch.count() - 1 + static_cast<int>(j)};
    if (blocked_ground(edge)) return {true, kNone, static_cast<int>(j)};
    Hit hit;
    const Vec2 reach = Vec2::Constant(1.5 * edge.widest() + clearance + 3.0 + 0.5 * step_);
    index_.visit_box(edge.a.cwiseMin(edge.b) - reach, edge.a.cwiseMax(edge.b) + reach, [&](int capsule) {
      const Verdict verdict = judge(branches, number, edge, index_[capsule], clearance);
      if (verdict == Verdict::Clear) return true;
      const bool worse = verdict == Verdict::Blocked || !hit.blocked;
      if (worse) hit = {true, verdict == Verdict::Meets ? capsule : kNone, static_cast<int>(j)};
      return verdict != Verdict::Blocked;
    });
    if (hit.blocked) return hit;
    if (meets_itself(edge, extension, j, step_)) return {true, kNone, static_cast<int>(j)};
    from = edge.b;
    from_radius = edge.radius_b;
  }
  return {};
}

bool Occupancy::link_blocked(const std::vector<GrowingBranch>& branches, int parent, int parent_node,
                             const Vec2& start) const {
  const Vec2 junction = branches[parent].points[parent_node];
  bool blocked = ground_.blocked(start) || ground_.blocked(0.5 * (junction + start));
  const Vec2 margin = Vec2::Constant(1.0);
  index_.visit_box(junction.cwiseMin(start) - margin, junction.cwiseMax(start) + margin, [&](int number) {
    const Capsule& other = index_[number];
    const bool at_junction = other.owner == parent && (other.place == parent_node || other.place == parent_node - 1);
    if (!at_junction && segment_distance(junction, start, other.a, other.b) < 0.5) blocked = true;
    return !blocked;
  });
  return blocked;
}

double Occupancy::density(const std::vector<GrowingBranch>& branches, int number, const Vec2& point, int node) const {
  const GrowingBranch& branch = branches[number];
  const double own = 3.0 * room_.spread + 2.0 * branch.radii.back();
  const double nearest = index_.nearest_rim(point, 2.5 * room_.spread, [&](const Capsule& other) {
    if (other.owner == number) return (node - other.place) * step_ >= own;
    if (other.place == kLinkPlace) return false;
    if (other.owner != branch.parent || node * step_ >= own) return true;
    return std::abs(other.place - branch.parent_node) * step_ >= own;
  });
  return std::exp(-nearest * nearest / (room_.spread * room_.spread));
}

}  // namespace ramify
