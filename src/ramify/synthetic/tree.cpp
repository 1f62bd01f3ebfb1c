// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/synthetic/tree.h"

#include <algorithm>
#include <cmath>

#include "ramify/synthetic/noise.h"

namespace ramify {
namespace {

constexpr double kStep = 2.0;       // px between points
constexpr int kTries = 10;          // places tried for one child
constexpr double kStraight = 0.5;   // chord to way of a branch, at least, on stretches of several widths
constexpr double kSlender = 0.03;  // radius of a child to its length, at most
constexpr double kElders = 0.5;    // how readily new children grow on older orders than the last
constexpr double kPoint = 10.0;    // a free end comes to its point within so many radii
constexpr double kHub = 120.0;      // px from its start on which a root may be near the others of a hub
constexpr double kThinner = 0.95;   // most a child's radius is of its parent's at the furcation
constexpr double kLeaving = 0.35;   // a child must be this far from its parent, as a share of the way it has gone

struct Disc {
  Vec2 at;
  double radius;
  int branch;
  double along;  // px from the branch's start
};

// Points of all finished branches, in square buckets.
class Occupied {
 public:
  explicit Occupied(Size size) : columns_(size.width / kCell + 5), rows_(size.height / kCell + 5),
                                 buckets_(static_cast<std::size_t>(columns_) * rows_) {}

  void add(const Disc& disc) {
    largest_ = std::max(largest_, disc.radius);
    buckets_[bucket(column(disc.at.x()), row(disc.at.y()))].push_back(disc);
  }

  // True when the predicate holds for any disc whose rim may be within `reach` px of p.
  template <class Predicate>
  bool any(const Vec2& p, double reach, Predicate&& predicate) const {
    const double r = reach + largest_;
    for (int j = row(p.y() - r); j <= row(p.y() + r); ++j)
      for (int i = column(p.x() - r); i <= column(p.x() + r); ++i)
        for (const Disc& disc : buckets_[bucket(i, j)])
          if (predicate(disc)) return true;
    return false;
  }

 private:
  static constexpr int kCell = 16;
  int column(double x) const { return std::clamp(static_cast<int>(std::floor(x / kCell)) + 2, 0, columns_ - 1); }
  int row(double y) const { return std::clamp(static_cast<int>(std::floor(y / kCell)) + 2, 0, rows_ - 1); }
  std::size_t bucket(int i, int j) const { return static_cast<std::size_t>(j) * columns_ + i; }

  int columns_, rows_;
  double largest_ = 0.0;
  std::vector<std::vector<Disc>> buckets_;
};

struct Parent {
  int branch;
  double weight;  // its share of the children
};

struct Start {
  Vec2 at;
  double heading = 0.0;
  double radius = 1.0;
  double length = 1e9;
  double tip_share = 0.1;
  int parent = kNone;
  int parent_point = kNone;
};

// Straight pieces with sudden turns: the heading's offset at every step.
std::vector<double> kinks(const TreeCourse& course, int count, Rng rng) {
  std::vector<double> offset(count, 0.0);
  if (course.kink_length <= 0.0) return offset;
  double left = 0.0, angle = 0.0;
  for (double& value : offset) {
    if (left <= 0.0) {
      left = course.kink_length * std::exp(rng.uniform(-1.3, 0.8));
      // Successive turns rather go opposite ways: a zigzag, not a random walk.
      angle = course.kink_angle * (0.9 * rng.normal() - 0.25 * (angle > 0 ? 1.0 : -1.0));
    }
    value = angle;
    left -= kStep;
  }
  return offset;
}

class TreeDrawer {
 public:
  explicit TreeDrawer(const TreePlan& plan) : plan_(plan), occupied_(plan.size) {}

  std::vector<AnnotatedBranch> draw(const Rng& rng, const Monitor& monitor) {
    std::vector<int> previous, elders;
    for (std::size_t i = 0; i < plan_.roots.size(); ++i) {
      const SyntheticRoot& root = plan_.roots[i];
      const Start start{root.start, root.heading, root.radius, root.length, root.tip_share, kNone, kNone};
      for (int attempt = 0; attempt < kTries; ++attempt) {
        const double shortest = attempt + 1 < kTries ? std::max(root.shortest, 8.0 * root.radius) : 8.0 * root.radius;
        if (!grow(start, root.course, shortest, rng.child("root", i * kTries + attempt))) continue;
        previous.push_back(last());
        break;
      }
    }
    for (std::size_t level = 0; level < plan_.levels.size(); ++level) {
      monitor.report(static_cast<double>(level) / static_cast<double>(plan_.levels.size()));
      const LevelPlan& next = plan_.levels[level];
      std::vector<Parent> parents;
      for (int branch : previous) parents.push_back({branch, length_of(branch)});
      if (next.on_elders)
        for (int branch : elders) parents.push_back({branch, kElders * length_of(branch)});
      elders.insert(elders.end(), previous.begin(), previous.end());
      previous = draw_level(next, parents, rng.child("level", level));
    }
    return std::move(branches_);
  }

 private:
  int last() const { return static_cast<int>(branches_.size()) - 1; }
  double length_of(int branch) const { return kStep * (static_cast<double>(branches_[branch].points.size()) - 1.0); }

  // Children of the branches in `parents`; returns those that were made. Along each parent they are made in order, so
  // that Murray's loss of radius reaches those that come later.
  std::vector<int> draw_level(const LevelPlan& level, const std::vector<Parent>& parents, const Rng& rng) {
    double total = 0.0;
    for (const Parent& parent : parents) total += parent.weight;
    std::vector<int> made;
    double owed = 0.0;
    for (const auto& [parent, weight] : parents) {
      owed += level.count * weight / total;
      const int slots = static_cast<int>(std::floor(owed + 0.5));
      owed -= slots;
      double side = rng.child("side", parent).uniform() < 0.5 ? -1.0 : 1.0;
      for (int slot = 0; slot < slots; ++slot) {
        Rng slot_rng = rng.child("slot", static_cast<std::uint64_t>(parent) * 1000 + slot);
        if (slot_rng.uniform() < level.alternate) side = -side;
        if (draw_child(level, parent, (slot + 0.5) / slots, 0.5 / slots, side, slot_rng)) made.push_back(last());
      }
    }
    return made;
  }

  bool draw_child(const LevelPlan& level, int parent, double place, double spread, double side, Rng rng) {
    for (int attempt = 0; attempt < kTries; ++attempt) {
      const AnnotatedBranch& from = branches_[parent];
      const int points = static_cast<int>(from.points.size());
      const double share = level.first + (level.last - level.first) * (place + spread * level.irregular * rng.uniform(-1.0, 1.0));
      const int at = std::clamp(static_cast<int>(share * (points - 1)), 1, points - 2);
      if (points < 6 || outside(from.points[at], -2.0)) continue;
      const double heading = angle_of(from.points[at + 1] - from.points[at - 1]);
      Start start;
      start.at = from.points[at];
      start.heading = heading + (attempt % 3 == 2 ? -side : side) * rng.uniform(level.angle_low, level.angle_high);
      start.radius = std::max(plan_.thinnest, from.radii[at] * rng.uniform(level.ratio_low, level.ratio_high));
      start.length = std::max(level.shortest, length_of(parent) * rng.uniform(level.length_low, level.length_high));
      start.radius = std::max(plan_.thinnest, std::min(start.radius, kSlender * start.length));
      start.tip_share = level.tip_share;
      start.parent = parent;
      start.parent_point = at;
      if (start.radius > kThinner * from.radii[at]) continue;
      // What others cut short is a stub: at first only long ones are taken.
      const double least = (attempt < kTries / 2 ? 1.0 : 0.6) * level.whole * start.length;
      if (!grow(start, level.course, std::max({level.shortest, 7.0 * start.radius, least}), rng.child("course", attempt))) continue;
      keep_murray(parent, at, start.radius);
      std::vector<double>& floor = floors_[parent];
      for (int i = 0; i <= at; ++i) floor[i] = std::max(floor[i], branches_.back().radii.front());
      return true;
    }
    return false;
  }

  // Beyond a furcation the parent has lost what the child took: r^3 = r_parent^3 - r_child^3, eased over a few radii. It
  // stays thicker than the children it already has.
  void keep_murray(int parent, int at, double child_radius) {
    std::vector<double>& radii = branches_[parent].radii;
    const double loss = plan_.murray * (1.0 - std::cbrt(1.0 - std::pow(std::min(0.9, child_radius / radii[at]), 3)));
    const double ease = 4.0 * radii[at] / kStep;
    for (int i = at; i < static_cast<int>(radii.size()); ++i)
      radii[i] = std::max(floors_[parent][i], radii[i] * (1.0 - loss * std::min(1.0, (i - at) / ease)));
  }

  bool outside(const Vec2& p, double margin) const {
    return p.x() < -margin || p.y() < -margin || p.x() > plan_.size.width - 1 + margin ||
           p.y() > plan_.size.height - 1 + margin;
  }

  bool blocked(const Vec2& p, double radius, double gone, int parent) const {
    const double reach = radius + plan_.clearance;
    return occupied_.any(p, reach, [&](const Disc& disc) {
      double needed = disc.radius + reach;
      const bool together = plan_.hub && parent == kNone && disc.along < kHub;
      if (disc.branch == parent || together) needed = std::min(needed, kLeaving * gone);
      return (disc.at - p).squaredNorm() < needed * needed;
    });
  }

  // A path must not come back to itself: its own points further back count like those of a parent.
  bool curls(const std::vector<Vec2>& path, const Vec2& p, double radius) const {
    const int here = static_cast<int>(path.size());
    for (int i = 0; i < here; i += 2) {
      const double needed = std::min(4.0 * radius + plan_.clearance, kStraight * kStep * (here - i));
      if ((path[i] - p).squaredNorm() < needed * needed) return true;
    }
    return false;
  }

  // Walks one branch and keeps it when it gets at least `shortest` px far.
  bool grow(const Start& start, const TreeCourse& course, double shortest, const Rng& rng) {
    const double diagonal = std::hypot(plan_.size.width, plan_.size.height);
    const int most = static_cast<int>(std::min(start.length, 2.0 * diagonal) / kStep);
    const std::vector<double> kink = kinks(course, most + 1, rng.child("kinks"));
    const LineNoise bend(most * kStep, course.bend_length, rng.child("bend"));
    const LineNoise ripple(most * kStep, course.ripple_length, rng.child("ripple"));
    std::vector<Vec2> path{start.at};
    double base = start.heading;
    bool entered = !outside(start.at, 0.0), leaves = false;
    for (int i = 0; i < most; ++i) {
      const double gone = i * kStep;
      base += course.homing * kStep * wrap_angle(course.home - base);
      // Bends set in gently: the first stretch keeps the angle drawn for it.
      const double ease = std::min(1.0, gone / (0.25 * course.bend_length));
      const double heading = base + kink[i] + ease * course.bend_angle * bend.at(gone) + course.ripple_angle * ripple.at(gone);
      const Vec2 next = path.back() + kStep * direction_of(heading);
      if (plan_.allowed && !plan_.allowed(next)) break;
      if (blocked(next, start.radius, gone + kStep, start.parent) || curls(path, next, start.radius)) break;
      path.push_back(next);
      entered = entered || !outside(next, 0.0);
      leaves = entered && (outside(next, start.radius + 2.0) || (plan_.seen && !plan_.seen(next)));
      if (leaves) break;
    }
    if (!entered || kStep * (static_cast<double>(path.size()) - 1.0) < shortest) return false;
    finish(start, path, leaves, rng);
    return true;
  }

  void finish(const Start& start, const std::vector<Vec2>& path, bool leaves, const Rng& rng) {
    AnnotatedBranch branch;
    const double length = kStep * (static_cast<double>(path.size()) - 1.0);
    const LineNoise swell(length, 10.0 * start.radius + 6.0, rng.child("swell"));
    const LineNoise ragged(length, 2.5 * start.radius + 3.0, rng.child("ragged"));
    const double most = start.parent == kNone ? 1e9 : kThinner * branches_[start.parent].radii[start.parent_point];
    // A child's first point after the junction is the second of the path; the first belongs to the parent.
    for (std::size_t i = start.parent == kNone ? 0 : 1; i < path.size(); ++i) {
      const double gone = kStep * static_cast<double>(i);
      const double end = leaves ? 0.25 : 1.0;  // what the frame cuts has tapered only a little
      const double taper = start.tip_share + (1.0 - start.tip_share) * std::pow(1.0 - end * gone / length, 0.7);
      const double noise = plan_.radius_noise * (0.7 * swell.at(gone) + 0.5 * ragged.at(gone));
      branch.points.push_back(path[i]);
      const double point = leaves ? 1.0 : std::sqrt(std::min(1.0, (length - gone + 1.0) / (kPoint * start.radius)));
      const double radius = start.radius * taper * point * std::exp(noise);
      branch.radii.push_back(std::clamp(radius, plan_.thinnest, std::max(plan_.thinnest, most)));
    }
    if (start.parent != kNone) branch.parent = BranchPoint{start.parent, start.parent_point};
    branch.leaves_frame = leaves;
    branches_.push_back(std::move(branch));
    const AnnotatedBranch& kept = branches_.back();
    floors_.emplace_back(kept.points.size(), plan_.thinnest);
    for (std::size_t i = 0; i < kept.points.size(); ++i)
      occupied_.add({kept.points[i], kept.radii[i], last(), kStep * static_cast<double>(i)});
  }

  const TreePlan& plan_;
  Occupied occupied_;
  std::vector<AnnotatedBranch> branches_;
  std::vector<std::vector<double>> floors_;  // px, smallest radius of every point of every branch
};

}  // namespace

std::vector<AnnotatedBranch> draw_tree(const TreePlan& plan, const Rng& rng, const Monitor& monitor) {
  return TreeDrawer(plan).draw(rng, monitor);
}

}  // namespace ramify
