// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/growth/children.h"

#include <algorithm>
#include <cmath>

#include "ramify/growth/candidates.h"
#include "ramify/growth/extension.h"
#include "ramify/growth/headings.h"

namespace ramify {
namespace {


constexpr double kMostWidening = 1.5;    // of its radius at the start
constexpr double kDenseStart = 0.6;      // D beyond which a child's first stretch stands in others' way
constexpr double kTooShort = 0.35;       // of the intended length: taken back, tried elsewhere
constexpr double kMostPlaceSpread = 0.18;  // of the parent's length, around the place in the template (PICTURES 12.2-4)
constexpr double kOtherSide = 1.0;       // against the side the template's child leaves to: keeps the sides balanced
constexpr double kLed = 5.0;             // of the share of a direction, where the exemplar's branches agree
constexpr double kSwapped = 0.6;         // children swapped for a similar one
constexpr int kNetStart = 3;             // vertices of a child's first stretch in a net
constexpr int kSimilar = 5;
constexpr double kAlike = 0.5;           // squared log ratios: nothing less alike is swapped in
constexpr int kTries = 8;

// Median radius of a template's first 2 m vertices: beyond its parent's influence.
double template_start(const GrowthState& state, int source) {
  const BendingModel& bending = state.style.bending;
  const auto first = bending.radius.begin() + bending.first[source];
  std::vector<double> radii(first, first + std::min(bending.length_of(source), 2 * bending.extension));
  const auto middle = radii.begin() + static_cast<std::ptrdiff_t>(radii.size() / 2);
  std::nth_element(radii.begin(), middle, radii.end());
  return *middle;
}

// The child's first m vertices are its template's own (the paper's non-causal start).
Extension first_stretch(const GrowthState& state, const GrowingBranch& child) {
  const BendingModel& bending = state.style.bending;
  const int first = bending.first[child.source];
  // Across a narrow mesh there is no room for a whole extension.
  const int count = std::min({state.net() ? std::min(kNetStart, bending.extension) : bending.extension,
                              bending.length_of(child.source) - 1,
                              std::max(1, static_cast<int>(std::lround(child.length / state.style.step)))});
  Extension out;
  double direction = child.start_direction;
  Vec2 point = child.points.front();
  for (int j = 0; j < count; ++j) {
    const double turn = j == 0 ? 0.0 : child.mirrored ? -bending.alpha[first + j] : bending.alpha[first + j];
    direction += turn;
    point += direction_of(direction) * state.style.step;
    out.points.push_back(point);
    const double most = std::max(0.5, std::min(child.most_radius, 1.15 * child.radii.front()));
    out.radii.push_back(std::clamp(bending.radius[first + j + 1] * child.radius_scale, 0.5, most));
    out.turns.push_back(turn);
    out.copied.push_back(child.mirrored ? -(first + j + 2) : first + j + 2);
    if (!state.ground.inside(point)) {
      leave_frame(state.ground, direction, state.style.step, out);
      break;
    }
  }
  return out;
}

GrowingBranch plan_branch(const GrowthState& state, const ChildPlan& plan, Rng& rng) {
  const GrowingBranch& parent = state.branches[plan.parent];
  const SourceBranch& source = state.style.hierarchy.branches[plan.source];
  const BendingModel& bending = state.style.bending;
  const double sign = plan.mirrored ? -1.0 : 1.0, rim = parent.radii[plan.node];
  const double along = tangent_at(parent, plan.node);
  GrowingBranch child;
  child.source = plan.source;
  child.mirrored = plan.mirrored;
  child.parent = plan.parent;
  child.parent_node = plan.node;
  child.order = parent.order + 1;
  const double template_rim = bending.smooth_radius[bending.first[source.parent] + source.parent_vertex];
  const double start = template_start(state, plan.source);
  const double least = std::min(state.style.hierarchy.least_radius, std::max(0.5, rim));
  const double radius = std::max(least, plan.width_factor * std::min(start * std::clamp(rim / template_rim, 0.75, 1.3), state.style.hierarchy.most_ratio * rim));
  child.radius_scale = radius / start;
  child.most_radius = std::max(radius, std::min(state.style.hierarchy.most_ratio * rim, kMostWidening * radius));
  child.points = {parent.points[plan.node] + direction_of(along + sign * source.rim_angle) * (rim + 0.5)};
  child.radii = {radius};
  child.turns = {0.0};
  child.copied = {plan.mirrored ? -(bending.first[plan.source] + 1) : bending.first[plan.source] + 1};
  child.start_direction = wrap_angle(along + sign * source.start_angle);
  const double length = (bending.length_of(plan.source) - 1) * state.style.step * std::exp(0.2 * rng.normal());
  child.length = std::max(2.0 * state.style.step, length * plan.length_factor);
  if (plan.most_length > 0.0) child.length = std::min(child.length, plan.most_length);
  child.course = rng.uniform(0.5, 1.0);
  return child;
}

// Where a child's chord points that turns from its parent's course as its template does; rad. The course is taken over
// one extension to both sides: what the parent does in a single bend does not turn the whole child.
double template_chord(const GrowthState& state, const GrowingBranch& parent, int node, int child, bool mirrored) {
  const BendingModel& bending = state.style.bending;
  const SourceBranch& source = state.style.hierarchy.branches[child];
  const auto course = [&](const auto& points, int at, int first, int last) {
    return angle_of(points[std::min(last, at + bending.extension)] - points[std::max(first, at - bending.extension)]);
  };
  const int first = bending.first[source.parent], last = bending.first[source.parent + 1] - 1;
  const Vec2 chord = bending.point[bending.first[child + 1] - 1] - bending.point[bending.first[child]];
  const double turn = wrap_angle(angle_of(chord) - course(bending.point, first + source.parent_vertex, first, last));
  return wrap_angle(course(parent.points, node, 0, parent.count() - 1) + (mirrored ? -turn : turn));
}

double length_of_template(const GrowthState& state, int source) {
  return (state.style.bending.length_of(source) - 1) * state.style.step;
}

double parent_radius_of(const GrowthState& state, int source) {
  const SourceBranch& branch = state.style.hierarchy.branches[source];
  return state.style.bending.smooth_radius[state.style.bending.first[branch.parent] + branch.parent_vertex];
}

// One of the nearest templates in log parent radius and log length, rarely used ones preferred.
int similar_template(const GrowthState& state, int source, Rng& rng) {
  std::vector<std::pair<double, int>> others;
  for (int b = 0; b < static_cast<int>(state.style.hierarchy.branches.size()); ++b) {
    if (state.style.hierarchy.branches[b].parent == kNone) continue;
    const double radius = std::log(parent_radius_of(state, b) / parent_radius_of(state, source));
    const double length = std::log(length_of_template(state, b) / length_of_template(state, source));
    const double width = std::log(template_start(state, b) / template_start(state, source));
    const double apart = radius * radius + length * length + width * width;
    if (apart < kAlike) others.emplace_back(apart + 0.3 * state.template_uses[b], b);
  }
  std::sort(others.begin(), others.end());
  return others[static_cast<std::size_t>(rng.below(std::min<int>(kSimilar, static_cast<int>(others.size()))))].second;
}

struct Place {
  double score;
  int node;
  bool mirrored;
};

// Value of the learnt classifier at a node, by the shape around it and the distances to the forks there are.
double fork_value(const GrowthState& state, const GrowingBranch& branch, int node) {
  const FurcationModel& model = state.style.furcation;
  int before = node, after = branch.count() - 1 - node;
  for (const Fork& fork : branch.forks) {
    if (fork.node <= node) before = std::min(before, node - fork.node);
    if (fork.node >= node) after = std::min(after, fork.node - node);
  }
  const std::vector<double> features = furcation_features(branch.turns, branch.radii, node, before, after,
                                                          state.style.unit_radius, state.style.bending, model);
  return furcation_value(model, features);
}

// The classifier nudges, no more: as a bonus for places it changed nothing measurable (PICTURES 12.2-9).
double classifier_nudge(const GrowthState& state, const GrowingBranch& branch, int node) {
  if (!state.style.furcation.trained) return 0.0;
  return 0.25 * std::clamp(fork_value(state, branch, node), -2.0, 2.0);
}

// The child template, and its mirroring, whose parent looks most like the branch around the node.
ChildPlan best_plan_at(const GrowthState& state, int number, int node) {
  ChildPlan best;
  double highest = -1e300;
  for (int b = 0; b < static_cast<int>(state.style.hierarchy.branches.size()); ++b) {
    if (state.style.hierarchy.branches[b].parent == kNone) continue;
    for (const bool mirrored : {false, true}) {
      if (mirrored && !state.style.mirror) continue;
      const double likeness = junction_likeness(state, state.branches[number], node, b, mirrored);
      if (likeness <= highest) continue;
      highest = likeness;
      best.parent = number;
      best.node = node;
      best.source = b;
      best.mirrored = mirrored;
    }
  }
  return best;
}

std::vector<Place> rank_places(const GrowthState& state, int number, const WantedChild& wanted, Rng& rng) {
  const int source = wanted.source;
  const GrowingBranch& branch = state.branches[number];
  const double reach = std::min(0.6 * length_of_template(state, source), 4.0 * state.spacing + 40.0);
  const int last = branch.count() - 1;
  const Headings& headings =
      state.style.hierarchy.headings[static_cast<std::size_t>(std::min(branch.order + 1, kHeadingOrders - 1))];
  const double directed = state.options.free_direction   ? 0.0
                          : state.options.tropism >= 0.0 ? state.options.tropism
                                                         : 1.0;
  std::vector<Place> places;
  for (int node = 2; node < last - 1; ++node) {
    const double off = (node / static_cast<double>(last) - wanted.place) / wanted.spread;
    const double width = std::log(branch.radii[node] / parent_radius_of(state, source));
    const double common = -0.5 * off * off - 0.5 * width * width + classifier_nudge(state, branch, node);
    for (const bool mirrored : {false, true}) {
      const int side = state.side_of(source, mirrored);
      if ((mirrored && !state.style.mirror) || fork_blocked(state, branch, node, side)) continue;
      // Where a child of this template would end up: branches that hardly bend do not come round to another heading.
      const double direction = template_chord(state, branch, node, source, mirrored);
      const double led =
          kLed * headings.strength * headings.strength * std::log(kHeadingBins * share_at(headings, direction) + 0.3);
      const double skip = branch.radii[node] + 0.6 * state.spacing;
      const double room = free_way(state, branch.points[node], direction, skip, reach);
      places.push_back({common + directed * led + 2.0 * junction_likeness(state, branch, node, source, mirrored) +
                            1.5 * std::log(0.08 + room) + 0.4 * rng.normal() - (side == wanted.side ? 0.0 : kOtherSide),
                        node, mirrored});
    }
  }
  std::sort(places.begin(), places.end(), [](const Place& a, const Place& b) {
    if (a.score != b.score) return a.score > b.score;
    return a.node != b.node ? a.node < b.node : a.mirrored < b.mirrored;
  });
  return places;
}

}  // namespace

double tangent_at(const GrowingBranch& branch, int node) {
  const int last = branch.count() - 1;
  return angle_of(branch.points[std::min(last, node + 2)] - branch.points[std::max(0, node - 2)]);
}

Vec2 tree_root(const GrowthState& state, int branch) {
  while (state.branches[branch].parent != kNone) branch = state.branches[branch].parent;
  return state.branches[branch].points.front();
}

bool fork_blocked(const GrowthState& state, const GrowingBranch& branch, int node, int side) {
  // Where paint asks for more branches than the exemplar has, their gaps shrink alike.
  const double crowding = state.crowding;
  const int gap = std::max(static_cast<int>(crowding * state.style.hierarchy.furcation_gap), 2);
  // Ways to one side within the exemplar's own gaps would run in parallel.
  const int side_gap = std::max(gap, static_cast<int>(crowding * state.style.hierarchy.side_gap));
  if (!state.ground.inside(branch.points[node])) return true;
  return std::any_of(branch.forks.begin(), branch.forks.end(), [&](const Fork& fork) {
    return std::abs(fork.node - node) <= (fork.side == side ? side_gap : gap);
  });
}

double junction_likeness(const GrowthState& state, const GrowingBranch& parent, int node, int source, bool mirrored) {
  const BendingModel& bending = state.style.bending;
  const SourceBranch& child = state.style.hierarchy.branches[source];
  const int first = bending.first[child.parent], count = bending.length_of(child.parent), last = parent.count() - 1;
  double angle = 0.0, radius = 0.0;
  int angles = 0, radii = 0;
  for (int j = -bending.history; j <= bending.history; ++j) {
    const int own = node + j, other = child.parent_vertex + j;
    if (own < 0 || other < 0 || own > last || other >= count) continue;
    radius += std::pow(parent.radii[own] - bending.radius[first + other], 2);
    ++radii;
    if (own == 0 || other == 0 || own == last || other == count - 1) continue;
    const double turn = mirrored ? -bending.alpha[first + other] : bending.alpha[first + other];
    angle += std::pow(parent.turns[own] - turn, 2);
    ++angles;
  }
  const double a = angles > 0 ? std::sqrt(angle / angles) / bending.angle_gain : 1.0;
  const double r = radii > 0 ? std::sqrt(radius / radii) / bending.radius_gain : 1.0;
  return std::log(likeness(a) * likeness(r));
}

int place_child(GrowthState& state, const ChildPlan& plan, Rng& rng) {
  GrowingBranch child = plan_branch(state, plan, rng);
  if (!state.ground.inside(child.points.front())) return kNone;
  if (state.occupancy.link_blocked(state.branches, plan.parent, plan.node, child.points.front())) return kNone;
  const int number = state.start(child);
  const Extension stretch = first_stretch(state, child);
  const bool dense = state.occupancy.density(state.branches, number, stretch.points.back(), child.count()) > kDenseStart;
  if (dense || state.occupancy.meet(state.branches, number, stretch).blocked) {
    state.take_back(number);
    return kNone;
  }
  state.commit(number, stretch);
  state.branches[number].followed = plan.followed;
  const double reach = std::min(0.6 * child.length, 4.0 * state.spacing + 40.0);
  state.branches[number].heading =
      plan.heading
          ? *plan.heading
          : draw_heading(state, child.points.front(),
                         template_chord(state, state.branches[plan.parent], plan.node, plan.source, plan.mirrored),
                         child.order, reach, tree_root(state, plan.parent), rng);
  if (plan.followed == kNone) aim_at_frame(state, state.branches[number]);
  grow_branch(state, number, rng);
  const bool loose = state.net() && !plan.spur && !run_on(state, number, rng);
  if (plan.spur) taper_tip(state, number);
  const GrowingBranch& grown = state.branches[number];
  const double arc = grown.arc(state.style.step);
  if (loose && arc < 2.0 * state.spacing) {
    state.take_back(number);
    return kNone;
  }
  const bool stunted = grown.stop == GrowthStop::Stuck && arc < kTooShort * grown.length &&
                       grown.length > 3.0 * state.style.bending.extension * state.style.step;
  const bool ends_free = grown.stop == GrowthStop::Stuck || grown.stop == GrowthStop::None;
  const bool stump = ends_free && arc < 4.0 * grown.radii.front();
  if (!stunted && !stump) return number;
  state.take_back(number);
  return kNone;
}

namespace {

// How irregular the gaps between the children of a template to one side are: deviation over mean; 1 with too few to
// tell.
double unevenness(const GrowthState& state, int source) {
  std::vector<double> gaps;
  for (const int side : {1, -1}) {
    std::vector<int> places;
    for (int b = 0; b < static_cast<int>(state.style.hierarchy.branches.size()); ++b) {
      const SourceBranch& other = state.style.hierarchy.branches[b];
      if (other.parent == source && state.side_of(b, false) == side) places.push_back(other.parent_vertex);
    }
    std::sort(places.begin(), places.end());
    for (std::size_t i = 1; i < places.size(); ++i) gaps.push_back(places[i] - places[i - 1]);
  }
  if (gaps.size() < 6) return 1.0;
  double mean = 0.0, square = 0.0;
  for (const double gap : gaps) mean += gap / static_cast<double>(gaps.size());
  for (const double gap : gaps) square += (gap - mean) * (gap - mean) / static_cast<double>(gaps.size());
  return std::sqrt(square) / std::max(1e-9, mean);
}

}  // namespace

std::vector<WantedChild> list_children(const GrowthState& state, int number, double share, Rng& rng) {
  const GrowingBranch& branch = state.branches[number];
  const int own = state.style.bending.length_of(branch.source) - 1;
  const double ratio = (branch.count() - 1) / static_cast<double>(std::max(1, own));
  const auto siblings = std::count_if(state.style.hierarchy.branches.begin(), state.style.hierarchy.branches.end(),
                                      [&](const SourceBranch& other) { return other.parent == branch.source; });
  // Many children stand in a row: each keeps its place in it, about a gap more or less, and less where they stand
  // evenly.
  const double spread = std::clamp(1.5 * unevenness(state, branch.source), 0.3, 1.0) *
                        std::min(kMostPlaceSpread, 1.0 / static_cast<double>(std::max<std::ptrdiff_t>(1, siblings)));
  std::vector<WantedChild> list;
  for (int b = 0; b < static_cast<int>(state.style.hierarchy.branches.size()); ++b) {
    if (state.style.hierarchy.branches[b].parent != branch.source) continue;
    // The large ones make the hierarchy: only small ones are left to the room there is.
    const bool large = state.style.bending.length_of(b) > 0.25 * own;
    for (double expected = (large ? 1.0 : share) * std::min(ratio, 2.0); expected > 0.0; expected -= 1.0) {
      if (rng.uniform() >= expected) continue;
      const double place = state.style.hierarchy.branches[b].parent_vertex / static_cast<double>(std::max(1, own));
      list.push_back({rng.uniform() < kSwapped ? similar_template(state, b, rng) : b, place, spread, state.side_of(b, branch.mirrored)});
    }
  }
  std::stable_sort(list.begin(), list.end(), [&](const WantedChild& a, const WantedChild& b) {
    return state.style.bending.length_of(a.source) > state.style.bending.length_of(b.source);
  });
  return list;
}

int fork_at_likeliest(GrowthState& state, int number, Rng& rng) {
  const FurcationModel& model = state.style.furcation;
  const GrowingBranch& branch = state.branches[number];
  std::vector<std::pair<double, int>> ranked;
  for (int node = 2; node + 2 < branch.count(); ++node) {
    if (fork_blocked(state, branch, node, 0)) continue;
    // Without a classifier the renewal process knows gaps only: any free vertex is as good as the other.
    const double probability =
        model.weight.empty() ? rng.uniform() : furcation_probability(model, fork_value(state, branch, node));
    ranked.emplace_back(-probability, node);
  }
  std::sort(ranked.begin(), ranked.end());
  for (std::size_t i = 0; i < std::min<std::size_t>(kTries, ranked.size()); ++i) {
    const ChildPlan plan = best_plan_at(state, number, ranked[i].second);
    if (state.style.hierarchy.branches[plan.source].parent == kNone) return kNone;
    const int child = place_child(state, plan, rng);
    if (child != kNone) return child;
  }
  return kNone;
}

int settle_child(GrowthState& state, int number, const WantedChild& wanted, Rng& rng) {
  std::vector<Place> tried;
  // A large child is worth a long search.
  const int tries = state.style.bending.length_of(wanted.source) > 8 * state.style.bending.extension ? 3 * kTries : kTries;
  for (const Place& place : rank_places(state, number, wanted, rng)) {
    const bool near = std::any_of(tried.begin(), tried.end(), [&](const Place& other) {
      return other.mirrored == place.mirrored && std::abs(other.node - place.node) < 3;
    });
    if (near) continue;
    tried.push_back(place);
    ChildPlan plan;
    plan.parent = number;
    plan.node = place.node;
    plan.source = wanted.source;
    plan.mirrored = place.mirrored;
    plan.spur = wanted.spur;
    const int child = place_child(state, plan, rng);
    if (child != kNone) return child;
    if (static_cast<int>(tried.size()) >= tries) break;
  }
  return kNone;
}

}  // namespace ramify
