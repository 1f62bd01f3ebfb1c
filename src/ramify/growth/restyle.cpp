// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/growth/restyle.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "ramify/geometry/capsule_index.h"
#include "ramify/geometry/polyline.h"
#include "ramify/geometry/segment.h"
#include "ramify/growth/bent_path.h"
#include "ramify/skeleton/branches.h"
#include "ramify/skeleton/statistics.h"

namespace ramify {
namespace {

constexpr double kShareOfGap = 0.45;    // of the space to a neighbour: both may move
constexpr double kShareOfChild = 0.35;  // of a side branch's length, by which its foot may move
constexpr double kSlope = 0.3;          // px the room for moving may change by along 1 px of a branch
constexpr int kSoftRounds = 3;          // rounds in which crossing places move half as far; after them they stay
constexpr int kLocalRounds = 12;        // then whole branches stay

// The same lines with edges of at most `step` px.
Skeleton divided(const Skeleton& skeleton, double step) {
  Skeleton out(skeleton.size);
  out.dim = skeleton.dim;
  std::vector<int> index_of;
  std::vector<bool> continued(static_cast<std::size_t>(skeleton.count()), false);
  for (const Node& node : skeleton.nodes()) {
    Node next = node;
    if (node.parent != kNone) {
      Node from = skeleton[node.parent];
      if (continued[node.parent]) from.radius = node.radius;  // a side branch does not start as thick as its parent
      continued[node.parent] = true;
      next.parent = index_of[node.parent];
      const int pieces =
          static_cast<int>(std::clamp(std::ceil((node.position - from.position).norm() / step), 1.0, 4096.0));
      for (int k = 1; k < pieces; ++k) {
        const double t = static_cast<double>(k) / pieces;
        Node between = node;
        between.position = (1.0 - t) * from.position + t * node.position;
        between.radius = (1.0 - t) * from.radius + t * node.radius;
        between.parent = next.parent;
        next.parent = out.append(between);
      }
    }
    index_of.push_back(out.append(next));
  }
  for (const auto& [a, b] : skeleton.loop_links) out.loop_links.emplace_back(index_of[a], index_of[b]);
  return out;
}

// A skeleton on its way: every node is where it was, plus its branch's bends, plus what its branch's foot has moved,
// fading towards the tip. With all shares 0 it is as it was, so taking shares back always ends.
class Restyling {
 public:
  Restyling(const Skeleton& skeleton, const Style& style)
      : old_(divided(skeleton, std::clamp(0.5 * style.step, 1.0, 3.0))),
        tree_(branch_tree(old_)),
        feature_(style.feature_size),
        arc_(static_cast<std::size_t>(old_.count()), 0.0),
        bend_(arc_.size(), Vec2::Zero()),
        share_(arc_.size(), 1.0) {
    for (const Branch& branch : tree_.branches) {
      Vec2 last = old_[branch.parent_node == kNone ? branch.nodes.front() : branch.parent_node].xy();
      double arc = 0.0;
      for (const int i : branch.nodes) {
        arc += (old_[i].xy() - last).norm();
        last = old_[i].xy();
        arc_[i] = arc;
      }
    }
  }

  void bend(PathBender& bender, double strength, const Rng& rng, const Monitor& monitor) {
    for (std::size_t b = 0; b < tree_.branches.size(); ++b) {
      monitor.report(static_cast<double>(b) / static_cast<double>(tree_.branches.size()));
      const Branch& branch = tree_.branches[b];
      const Polyline line = branch_polyline(old_, branch);
      const std::vector<Vec2> bent = bender.bend(line.points, line.radii, rng.child("branch", b));
      if (bent.empty() || branch.length <= 0.0) continue;
      const std::vector<double> arcs = arc_lengths(bent);
      for (const int i : branch.nodes) {
        bend_[i] = strength * (point_at_arc(bent, arcs, arcs.back() * arc_[i] / branch.length) - old_[i].xy());
      }
      bend_[branch.nodes.back()] = Vec2::Zero();
      if (branch.parent == kNone) bend_[branch.nodes.front()] = Vec2::Zero();
    }
    limit(3.0 * bender.valley(), monitor);
  }

  Skeleton moved() const {
    Skeleton out = old_;
    std::vector<Vec2> shift(arc_.size());
    for (const Branch& branch : tree_.branches) {
      const Vec2 foot = branch.parent_node == kNone ? Vec2::Zero() : shift[branch.parent_node];
      for (const int i : branch.nodes) {
        shift[i] = share_[i] * bend_[i] + foot_share(branch, i) * foot;
        if (shift[i] == Vec2::Zero()) continue;
        const Vec2 p = old_[i].xy() + shift[i];
        out.set_position(i, Vec3(p.x(), p.y(), old_[i].position.z()));
      }
    }
    return out;
  }

  // Takes back what crosses; the result crosses nowhere the old one did not.
  Skeleton settled(const Monitor& monitor) {
    const std::vector<std::pair<int, int>> before = find_crossings(old_);
    for (int round = 0;; ++round) {
      monitor.check();
      Skeleton now = moved();
      bool clean = true;
      for (const auto& [a, b] : find_crossings(now)) {
        if (std::binary_search(before.begin(), before.end(), std::pair{a, b})) continue;
        clean = false;
        hold(a, round), hold(b, round);
      }
      if (clean) return now;
    }
  }

 private:
  // How much of its foot's shift a node takes over: all at the foot, none at the tip.
  double foot_share(const Branch& branch, int node) const {
    const double t = std::clamp(arc_[node] / std::max(1e-9, std::min(branch.length, 2.0 * feature_)), 0.0, 1.0);
    return 1.0 - t * t * (3.0 - 2.0 * t);
  }

  // Bends become smaller where there is little room.
  void limit(double reach, const Monitor& monitor) {
    std::vector<double> room = gaps(reach, monitor);
    for (const Branch& branch : tree_.branches) {
      if (branch.parent_node != kNone)
        room[branch.parent_node] = std::min(room[branch.parent_node], kShareOfChild * branch.length);
    }
    for (const auto& [a, b] : old_.loop_links) room[a] = room[b] = 0.0;
    for (const Branch& branch : tree_.branches) {
      const std::vector<int>& nodes = branch.nodes;
      const auto pass = [&](int i, int from) {
        room[i] = std::min(room[i], room[from] + kSlope * std::abs(arc_[i] - arc_[from]));
      };
      for (std::size_t k = 1; k < nodes.size(); ++k) pass(nodes[k], nodes[k - 1]);
      for (std::size_t k = nodes.size() - 1; k > 0; --k) pass(nodes[k - 1], nodes[k]);
      for (const int i : nodes) {
        const double size = bend_[i].norm();
        if (size > 0.0) bend_[i] *= room[i] / std::hypot(room[i], size);
      }
    }
  }

  // Px every node may move towards the nearest edge that does not simply lead to it.
  std::vector<double> gaps(double reach, const Monitor& monitor) const {
    Vec2 low = Vec2::Constant(std::numeric_limits<double>::max()), high = -low;
    for (const Node& node : old_.nodes()) low = low.cwiseMin(node.xy()), high = high.cwiseMax(node.xy());
    CapsuleIndex index(low, high, std::max({8.0, reach, (high - low).maxCoeff() / 1024.0}));
    for (int i = 0; i < old_.count(); ++i) {
      if (old_[i].parent == kNone) continue;
      const Node& from = old_[old_[i].parent];
      index.add({from.xy(), old_[i].xy(), from.radius, old_[i].radius, tree_.branch_of_node[i], i});
    }
    std::vector<double> room(arc_.size(), reach);
    for (int i = 0; i < old_.count(); ++i) {
      if (i % 1024 == 0) monitor.check();
      const int own = tree_.branch_of_node[i];
      const Vec2 p = old_[i].xy();
      const Vec2 box = Vec2::Constant(reach / kShareOfGap);
      index.visit_box(p - box, p + box, [&](int number) {
        const Capsule& other = index[number];
        const double distance = nearest_on_segment(p, other.a, other.b).distance;
        // Px along the branches between the two places, where one leads to the other.
        double way = std::numeric_limits<double>::infinity();
        const double length = (other.b - other.a).norm();
        if (other.owner == own)
          way = std::abs(arc_[other.place] - 0.5 * length - arc_[i]) - 0.5 * length;
        else if (tree_.branches[own].parent == other.owner)
          way = arc_[i];
        else if (tree_.branches[other.owner].parent == own)
          way = arc_[other.place] - length;
        if (distance + 1.0 >= 0.5 * way) return true;
        room[i] =
            std::min(room[i], std::max(kShareOfGap * (distance - old_[i].radius - other.widest()), 0.15 * distance));
        return true;
      });
    }
    return room;
  }

  // Less movement around a node, and around the foot of its branch, whose shift it shares.
  void hold(int node, int round) {
    const Branch& branch = tree_.branches[tree_.branch_of_node[node]];
    const double reach = feature_ * (0.5 + 0.25 * round);
    for (const int i : branch.nodes) {
      const double t = std::abs(arc_[i] - arc_[node]) / reach;
      if (round >= kLocalRounds)
        share_[i] = 0.0;
      else if (t < 1.0)
        share_[i] *= (round < kSoftRounds ? 0.5 : 0.0) + (round < kSoftRounds ? 0.5 : 1.0) * t * t * (3.0 - 2.0 * t);
    }
    if (branch.parent_node != kNone && (round >= kLocalRounds || foot_share(branch, node) > 0.0))
      hold(branch.parent_node, round);
  }

  Skeleton old_;
  BranchTree tree_;
  double feature_;
  std::vector<double> arc_;    // px along its branch, from the parent's node
  std::vector<Vec2> bend_;     // px
  std::vector<double> share_;  // 0..1 of the bend that is taken
};

}  // namespace

Skeleton restyle_skeleton(const Skeleton& skeleton, const Style& style, double strength, const Rng& rng,
                          const Monitor& monitor) {
  if (!(strength >= 0.0 && strength <= 1.0))
    throw std::invalid_argument("restyle_skeleton: the strength must be 0 to 1");
  if (strength == 0.0 || skeleton.empty()) return skeleton;
  PathBender bender(style);
  Restyling restyling(skeleton, style);
  restyling.bend(bender, strength, rng, monitor.stage("bend", 0.0, 0.8));
  return restyling.settled(monitor);
}

}  // namespace ramify
