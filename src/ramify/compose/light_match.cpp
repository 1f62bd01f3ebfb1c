// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/compose/light_match.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace ramify {
namespace {

constexpr int kShapeSamples = 11;
constexpr double kShapeWeight = 1.0;  // copies bend freely; a like course saves them from being stretched
constexpr double kBadWeight = 4.0;
constexpr double kReuseWeight = 0.03;
constexpr double kEarlyWeight = 0.15;  // a child's start likes the middle of a source branch (PICTURES 12.3-10)
constexpr double kFrameCost = 0.3;     // the disc leaves the photo
constexpr double kHueWeight = 0.5;
constexpr double kWidthWeight =
    3.0;  // per squared log ratio: light that is stretched across grows ragged and its fringes wide
constexpr double kMisfitWeight = 6.0;  // of widths that differ by more than the strictest choice allows
constexpr double kNoise = 0.02;
constexpr double kBanned = 1e3;
constexpr double kNoTip = 0.3;  // an open tip that the source does not end in: the fade has to make it

// What all sources are compared with.
struct Goal {
  int sample = 0;
  double s = 0.0;  // px, radius of the disc
  double radius = 1.0;
  Vec3 level = Vec3::Zero();
  int to_end = 0;      // samples left to the tip
  bool tip = false;    // the disc holds an open tip
  bool start = false;  // the disc holds the base
  std::array<int, kShapeSamples> offsets{};
  std::array<Vec2, kShapeSamples> shape{};
  std::array<bool, kShapeSamples> valid{};
};

Goal make_goal(const Strand& target, int sample, const LightRules& rules) {
  Goal goal;
  goal.sample = sample;
  goal.radius = std::max(0.3, target.radii[sample]);
  goal.s = surround_radius(target.radii[sample], rules.surround_factor, rules.surround_cap);
  if (!target.level.empty()) goal.level = target.level[sample];
  goal.to_end = target.count() - 1 - sample;
  goal.tip = target.open_end && goal.to_end < goal.s;
  goal.start = sample - goal.s < target.first;
  for (int k = 0; k < kShapeSamples; ++k) {
    const double along = goal.s * (2.0 * k / (kShapeSamples - 1) - 1.0);
    goal.offsets[k] = static_cast<int>(std::lround(along));
    const int t = sample + goal.offsets[k];
    goal.valid[k] = t >= target.first && t < target.count();
    goal.shape[k] = goal.valid[k] ? Vec2(target.points[t] - target.points[sample]) : Vec2(0.0, 0.0);
  }
  return goal;
}

// How strict the choice of spots is: relaxed step by step when too few are left.
struct Strictness {
  double log_radius, tip_offset, surround;
  bool real_tip;
};
constexpr std::array<Strictness, 3> kStrictness{
    {{0.45, 2.5, 1.0, true}, {0.9, 4.0, 0.5, false}, {9.0, 1e9, 0.0, false}}};

bool admits(const Strictness& strict, const Goal& goal, const Strand& strand, int sample) {
  const double to_end = strand.count() - 1 - sample;
  if (std::abs(std::log(strand.radii[sample] / goal.radius)) >= strict.log_radius) return false;
  if (goal.tip) return std::abs(to_end - goal.to_end) <= strict.tip_offset && (!strict.real_tip || strand.open_end);
  return to_end >= strict.surround * goal.s;
}

// Brightness and hue apart: a branch may be somewhat brighter than asked for, but not of another colour.
double level_cost(const Vec3& level, const Vec3& wanted) {
  const auto log_ratio = [](double a, double b) {
    return std::log((std::max(0.0, a) + 0.02) / (std::max(0.0, b) + 0.02));
  };
  const double brightness = log_ratio(level.mean(), wanted.mean());
  double hue = 0.0;
  for (int c = 0; c < 3; ++c) hue += std::pow(log_ratio(level[c], wanted[c]) - brightness, 2);
  return brightness * brightness + kHueWeight * hue;
}

// The part of the cost that needs no shapes.
double plain_cost(const LightSource& source, const SourceSpot& spot, const Goal& goal, const Vec2& place,
                  double leave_out) {
  const Strand& strand = source.strands[spot.strand];
  const double width = std::abs(std::log(strand.radii[spot.sample] / goal.radius));
  double cost = spot.penalty + kWidthWeight * width * width +
                kMisfitWeight * std::pow(std::max(0.0, width - kStrictness[0].log_radius), 2);
  if (goal.level.sum() > 0.0) cost += level_cost(strand.level[spot.sample], goal.level);
  if (goal.start && spot.sample < 2.0 * goal.s) cost += kEarlyWeight;
  if ((strand.points[spot.sample] - place).norm() < leave_out) cost += kBanned;
  return cost;
}

// How far the courses differ when one is turned onto the other, and how much of the source is not fit to be copied.
double course_cost(const LightSource& source, const SourceSpot& spot, const Goal& goal) {
  const Strand& strand = source.strands[spot.strand];
  const Vec2 centre = strand.points[spot.sample];
  std::array<Vec2, kShapeSamples> shape;
  double along = 0.0, across = 0.0, bad = 0.0;
  for (int k = 0; k < kShapeSamples; ++k) {
    const int t = std::clamp(spot.sample + goal.offsets[k], 0, strand.count() - 1);
    bad += strand.bad[t];
    Vec2 p = goal.valid[k] ? Vec2(strand.points[t] - centre) : Vec2(0.0, 0.0);
    if (spot.mirrored) p.x() = -p.x();
    shape[k] = p;
    along += p.dot(goal.shape[k]), across += cross(p, goal.shape[k]);
  }
  const double angle = std::atan2(across, along);
  Eigen::Matrix2d turn;
  turn << std::cos(angle), -std::sin(angle), std::sin(angle), std::cos(angle);
  double misfit = 0.0;
  for (int k = 0; k < kShapeSamples; ++k) misfit += (turn * shape[k] - goal.shape[k]).squaredNorm();
  return kShapeWeight * misfit / (kShapeSamples * goal.s * goal.s) + kBadWeight * bad / kShapeSamples;
}

// Extra cost of other branches within 0.7 s, beyond what a branch of this width covers itself, and of leaving the
// photo.
double surround_cost(const LightSource& source, const SourceSpot& spot, const Goal& goal) {
  const Vec2 centre = source.position(spot);
  const double s = goal.s;
  double covered = 0.0;
  int count = 0;
  for (int j = -3; j <= 3; ++j) {
    for (int i = -3; i <= 3; ++i) {
      const Vec2 u(0.7 * i / 3.0, 0.7 * j / 3.0);
      if (u.squaredNorm() >= 0.5) continue;
      const Vec2 p = centre + s * u;
      covered += source.cover.clamped(static_cast<int>(std::lround(p.x())), static_cast<int>(std::lround(p.y())));
      ++count;
    }
  }
  const double expected = std::min(1.0, 1.6 * (1.3 * goal.radius + 2.0) / (0.9 * s));
  const bool leaves = centre.x() < s || centre.y() < s || centre.x() > source.cover.width() - 1 - s ||
                      centre.y() > source.cover.height() - 1 - s;
  return std::max(0.0, covered / count - expected) + (leaves ? kFrameCost : 0.0);
}

bool better(const LightMatch& a, const LightMatch& b) {
  return a.cost < b.cost || (a.cost == b.cost && a.spot < b.spot);
}

void keep_best(std::vector<LightMatch>& matches, std::size_t count) {
  const std::size_t kept = std::min(count, matches.size());
  std::partial_sort(matches.begin(), matches.begin() + static_cast<std::ptrdiff_t>(kept), matches.end(), better);
  matches.resize(kept);
}

}  // namespace

std::vector<int> fragment_centres(const Strand& target, const LightRules& rules) {
  const auto s = [&](int t) { return surround_radius(target.radii[t], rules.surround_factor, rules.surround_cap); };
  std::vector<int> centres{target.first};
  const int n = target.count();
  while (true) {
    const int t = centres.back();
    int next = t + 1;
    while (next < n && (target.points[next] - target.points[t]).norm() < rules.spacing * (s(t) + s(next))) ++next;
    if (next >= n) break;
    centres.push_back(next);
  }
  if (n - 1 - centres.back() > 2) centres.push_back(n - 1);
  return centres;
}

std::optional<LightMatch> continue_light(const LightSource& source, const Strand& target, int before_sample,
                                         const LightMatch& before, int sample, const LightRules& rules,
                                         double leave_out) {
  const Goal goal = make_goal(target, sample, rules);
  LightMatch match = before;
  match.place.sample += sample - before_sample;
  const Strand& strand = source.strands[match.place.strand];
  const int left = strand.count() - 1 - match.place.sample;
  if (left < 0 || strand.bad[match.place.sample] || (!goal.tip && left < std::min(goal.s, 1.0 * goal.to_end)))
    return std::nullopt;
  while (match.spot + 2 < static_cast<int>(source.spots.size()) &&
         source.spots[match.spot + 2].strand == match.place.strand &&
         source.spots[match.spot + 2].sample <= match.place.sample) {
    match.spot += 2;  // each place is listed as it is and mirrored
  }
  match.cost = plain_cost(source, match.place, goal, target.points[sample], leave_out) +
               course_cost(source, match.place, goal) + surround_cost(source, match.place, goal);
  if (goal.tip && std::abs(left - goal.to_end) > kStrictness[0].tip_offset) match.cost += kNoTip;
  if (match.cost >= kBanned) return std::nullopt;
  return match;
}

std::vector<LightMatch> match_light(const LightSource& source, const Strand& target, int sample,
                                    const std::vector<int>& uses, const LightRules& rules, double leave_out, Rng rng) {
  const Goal goal = make_goal(target, sample, rules);
  const auto wanted = static_cast<std::size_t>(rules.candidates);
  std::vector<LightMatch> matches;
  for (const Strictness& strict : kStrictness) {
    matches.clear();
    std::size_t allowed = 0;
    for (int i = 0; i < static_cast<int>(source.spots.size()); ++i) {
      const SourceSpot& spot = source.spots[i];
      if (!admits(strict, goal, source.strands[spot.strand], spot.sample)) continue;
      const double plain = plain_cost(source, spot, goal, target.points[sample], leave_out) + kReuseWeight * uses[i];
      allowed += plain < kBanned;
      if (matches.size() == 3 * wanted && plain >= matches.front().cost) continue;
      matches.push_back({spot, i, plain + course_cost(source, spot, goal)});
      std::push_heap(matches.begin(), matches.end(), better);
      if (matches.size() <= 3 * wanted) continue;
      std::pop_heap(matches.begin(), matches.end(), better);
      matches.pop_back();
    }
    if (allowed >= 6) break;
  }
  for (LightMatch& match : matches) {
    match.cost += surround_cost(source, match.place, goal);
    match.cost += kNoise * std::log(-std::log(std::max(1e-12, rng.uniform())));
  }
  keep_best(matches, wanted);
  return matches;
}

}  // namespace ramify
