// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/growth/roots.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "ramify/growth/candidates.h"
#include "ramify/growth/children.h"
#include "ramify/growth/extension.h"
#include "ramify/growth/sending.h"

namespace ramify {
namespace {

constexpr double kJitter = 0.08;      // of the side (PICTURES 2: 10 %)
constexpr double kTurnJitter = 0.2;   // rad (12.2-5)
constexpr int kTries = 8;

double template_length(const Style& style, int source) { return (style.bending.length_of(source) - 1) * style.step; }

double template_direction(const Style& style, int source) {
  const int first = style.bending.first[source];
  const int ahead = std::min(style.bending.length_of(source) - 1, style.bending.extension);
  return angle_of(style.bending.point[first + ahead] - style.bending.point[first]);
}

double template_heading(const Style& style, int source) {
  return angle_of(style.bending.point[style.bending.first[source + 1] - 1] - style.bending.point[style.bending.first[source]]);
}

// The exemplar's place on this canvas: distances to the frame scale with it.
Vec2 on_this_canvas(const GrowthState& state, const Vec2& point) {
  const Size from = state.style.exemplar_size, to = state.target.size;
  return {(point.x() + 0.5) * to.width / from.width - 0.5, (point.y() + 0.5) * to.height / from.height - 0.5};
}

// A place on the frame may slide along its side only.
Vec2 slide_along_frame(const Vec2& point, Vec2 jitter, Size size) {
  const double left = point.x(), top = point.y(), right = size.width - 1 - left, bottom = size.height - 1 - top;
  const double nearest = std::min({left, top, right, bottom});
  (nearest == top || nearest == bottom ? jitter.y() : jitter.x()) = 0.0;
  return jitter;
}

// From a landmark to a tip, as a midrib: a new one must fit the old leaf.
bool fits_old_ground(const GrowthState& state, int source) {
  const SourceBranch& branch = state.style.hierarchy.branches[source];
  return branch.starts_on_landmark && state.target.kept && branch.end == BranchEnd::Tip;
}

RootPlan plan_from_template(const GrowthState& state, int source, const Vec2& tree_jitter, double freedom, Rng& rng) {
  const SourceBranch& branch = state.style.hierarchy.branches[source];
  const Size size = state.target.size;
  RootPlan plan;
  plan.source = source;
  const Vec2 own = state.style.bending.point[state.style.bending.first[source]];
  const Vec2 low = Vec2::Zero(), high(size.width - 1, size.height - 1);
  if (branch.starts_on_landmark && state.target.kept) {
    plan.position = (state.target.kept->scale * own + state.target.kept->shift).cwiseMax(low).cwiseMin(high);
  } else {
    const Vec2 place = on_this_canvas(state, own);
    plan.position = (place + (branch.starts_on_frame ? slide_along_frame(place, tree_jitter, size) : tree_jitter)).cwiseMax(low).cwiseMin(high);
  }
  // The surer the main direction, the less it is disturbed.
  const bool fits = fits_old_ground(state, source);
  const double jitter_scale = (fits ? 0.3 : 1.0) * freedom * kTurnJitter * std::clamp(2.0 * (1.0 - state.style.hierarchy.headings[0].strength), 0.25, 1.0);
  const double turn = jitter_scale * rng.normal();
  plan.direction = template_direction(state.style, source) + turn;
  plan.heading = template_heading(state.style, source) + 0.5 * turn + jitter_scale * rng.normal();
  plan.length = template_length(state.style, source) * std::exp((fits ? 0.03 : 0.15) * rng.normal());
  // Where another root has exactly this place, this one starts beside it.
  for (const GrowingBranch& other : state.branches) {
    if ((other.points.front() - plan.position).norm() >= 1.0) continue;
    plan.position += direction_of(plan.direction) * std::max(1.0, 0.7 * state.style.bending.smooth_radius[state.style.bending.first[source]]);
  }
  return plan;
}

// Straight points from outside the canvas to a root on the frame; none for a root inside.
Extension lead_in(const GrowthState& state, const GrowingBranch& root) {
  Extension lead;
  if (state.ground.painted()) return lead;
  const Vec2 back = direction_of(root.start_direction) * -state.style.step, place = root.points.front();
  const int most = 1 + static_cast<int>(1.5 * root.radii.front() / state.style.step);
  if (state.ground.inside(place + 2.0 * back) && state.ground.inside(place + back)) return lead;
  for (int j = most - 1; j >= 0; --j) {
    lead.points.push_back(place + back * j);
    lead.radii.push_back(root.radii.front());
    lead.turns.push_back(0.0);
    lead.copied.push_back(0);
  }
  return lead;
}

// The paper's start: the first k + 1 vertices of the main branch are the exemplar's own, as far as they fit.
void copy_stem(GrowthState& state, int number) {
  const int first = state.style.bending.first[state.branches[number].source];
  const Extension stem = extend_by(state, number, {first, false, 0.0, 0.0}, state.style.bending.history);
  if (!stem.points.empty() && !state.occupancy.meet(state.branches, number, stem).blocked) state.commit(number, stem);
}

// Trees on one side of the frame that stand nearer to each other than they would be moved: they are moved together.
std::map<int, int> stands_of(const Style& style, const std::vector<int>& roots) {
  const double near = kJitter * std::max(style.exemplar_size.width, style.exemplar_size.height);
  std::map<int, int> stand;
  for (std::size_t i = 0; i < roots.size(); ++i) {
    const SourceBranch& root = style.hierarchy.branches[roots[i]];
    if (stand.contains(root.tree)) continue;
    stand[root.tree] = root.tree;
    const Vec2 place = style.bending.point[style.bending.first[roots[i]]];
    for (std::size_t j = 0; j < i && root.starts_on_frame; ++j) {
      const SourceBranch& other = style.hierarchy.branches[roots[j]];
      if (!other.starts_on_frame || (style.bending.point[style.bending.first[roots[j]]] - place).norm() > near)
        continue;
      stand[root.tree] = stand[other.tree];
      break;
    }
  }
  return stand;
}

// A root whose template leaves the picture, as a stroke to the ground or a river from frame to frame: when its own way
// did not lead out, a straight course does.
int place_leaving(GrowthState& state, RootPlan plan, Rng& rng) {
  const Vec2 along = direction_of(plan.heading.value_or(plan.direction));
  std::vector<Vec2> path{plan.position};
  const double side = std::max(state.target.size.width, state.target.size.height);
  for (double way = state.style.feature_size; way < 2.0 * side; way += state.style.feature_size) {
    path.push_back(plan.position + along * way);
    if (!state.ground.inside(path.back())) break;
  }
  if (path.size() < 3) return kNone;
  path.push_back(path.back() + along * state.style.feature_size);
  state.courses.emplace_back(path, 4.0 * bend_amplitude(state.style.bending));
  plan.followed = static_cast<int>(state.courses.size()) - 1;
  plan.length = 1.3 * state.courses.back().length();
  return place_root(state, plan, rng);
}

bool leaves(const Style& style, int source) {
  return style.hierarchy.branches[source].end == BranchEnd::Frame;
}

// All roots of the exemplar, each tree moved as one: strokes from one place stay together.
std::vector<int> grow_own_roots(GrowthState& state) {
  std::vector<int> grown;
  std::map<int, Vec2> tree_jitter;
  std::set<int> settled;  // trees that have a root: what else starts there stays with it
  const Size size = state.target.size;
  const std::vector<int> templates = root_templates(state.style);
  const std::map<int, int> stands = stands_of(state.style, templates);
  for (const int source : templates) {
    state.monitor.check();
    const int tree = stands.at(state.style.hierarchy.branches[source].tree);
    Rng rng = state.rng.child("grow.root", static_cast<std::uint64_t>(source));
    for (int attempt = 0; attempt < kTries; ++attempt) {
      // Nearer and nearer to the exemplar's own place and direction: a stalk may leave it no other.
      const double freedom = static_cast<double>(kTries - 1 - attempt) / (kTries - 1);
      const double reach = freedom * kJitter;
      const Vec2 drawn(rng.uniform(-1, 1) * reach * size.width, rng.uniform(-1, 1) * reach * size.height);
      if (!settled.contains(tree)) tree_jitter[tree] = drawn;
      const RootPlan plan = plan_from_template(state, source, tree_jitter[tree], freedom, rng);
      if (!state.ground.inside(plan.position) || state.ground.blocked(plan.position)) continue;
      const bool last = attempt + 1 == kTries, must_leave = leaves(state.style, source) && !state.options.paper_exact;
      int number = last && must_leave ? place_leaving(state, plan, rng) : place_root(state, plan, rng);
      if (number == kNone && last && must_leave) number = place_root(state, plan, rng);
      if (number == kNone) continue;
      const GrowingBranch& branch = state.branches[number];
      // Stuck early, or out of the habitat or frame all but at once: another start may do better. So for a midrib that
      // leaves its leaf at the side.
      const double least = fits_old_ground(state, source) ? 0.9 : branch.stop == GrowthStop::Stuck ? 0.3 : 0.1;
      const bool good =
          branch.arc(state.style.step) > least * branch.length && (!must_leave || branch.stop == GrowthStop::Frame);
      if (good || last) {
        grown.push_back(number);
        settled.insert(tree);
        break;
      }
      state.take_back(number);
    }
  }
  return grown;
}

// The template whose first direction is nearest to the wanted one, long ones preferred.
int template_for(const Style& style, const std::optional<double>& direction, std::size_t turn) {
  const std::vector<int> roots = root_templates(style);
  if (!direction) return roots[turn % roots.size()];
  return *std::max_element(roots.begin(), roots.end(), [&](int a, int b) {
    const auto score = [&](int r) {
      return std::cos(template_direction(style, r) - *direction) + 0.5 * std::log(template_length(style, r));
    };
    return score(a) < score(b);
  });
}

std::vector<int> grow_given_roots(GrowthState& state) {
  std::vector<int> grown;
  for (std::size_t i = 0; i < state.target.roots.size(); ++i) {
    const GrowthRoot& root = state.target.roots[i];
    const std::string name = "root " + std::to_string(i + 1);
    if (!state.ground.on_canvas(root.position)) throw InputError("", name + " lies outside the canvas");
    if (state.ground.blocked(root.position)) throw InputError("", name + " lies on an obstacle or on black of the density map");
    Rng rng = state.rng.child("grow.given_root", i);
    RootPlan plan;
    plan.source = template_for(state.style, root.direction, i);
    plan.position = root.position;
    plan.direction = root.direction.value_or(template_direction(state.style, plan.source));
    if (!root.direction) plan.heading = template_heading(state.style, plan.source) + kTurnJitter * rng.normal();
    plan.radius = root.radius;
    plan.length = template_length(state.style, plan.source) * std::exp(0.15 * rng.normal());
    int number = place_root(state, plan, rng);
    // One of them leads out where the exemplar's do.
    if (i == 0 && number != kNone && leaves(state.style, plan.source) &&
        state.branches[number].stop != GrowthStop::Frame) {
      state.take_back(number);
      number = place_leaving(state, plan, rng);
      if (number == kNone) number = place_root(state, plan, rng);
    }
    if (number != kNone) grown.push_back(number);
  }
  return grown;
}

// A main branch along each drawn course that leaves no other; the longest has the first of the user's roots.
std::vector<int> grow_along_courses(GrowthState& state) {
  std::vector<int> branch_of(state.drawn.size(), kNone), grown;
  const std::vector<int> roots = root_templates(state.style);
  for (int c = 0; c < static_cast<int>(state.drawn.size()); ++c) {
    Rng rng = state.rng.child("grow.course", static_cast<std::uint64_t>(c));
    const int parent = state.drawn[c].parent;
    if (parent != kNone && branch_of[parent] != kNone) {
      branch_of[c] = send_along(state, c, branch_of[parent], rng);
    } else {
      const Course& course = state.courses[c];
      RootPlan plan;
      plan.source = roots[static_cast<std::size_t>(c) % roots.size()];
      plan.position = course.point_at(0.0);
      plan.direction = course.direction_at(0.0, 2.0 * state.style.feature_size);
      plan.length = 1.3 * course.length();  // bends make the way longer
      plan.followed = c;
      if (c == 0 && !state.target.roots.empty()) {
        plan.position = state.target.roots.front().position;
        plan.radius = state.target.roots.front().radius;
        plan.direction = state.target.roots.front().direction.value_or(plan.direction);
      }
      branch_of[c] = place_root(state, plan, rng);
    }
    if (branch_of[c] != kNone) grown.push_back(branch_of[c]);
  }
  return grown;
}

}  // namespace

std::vector<int> root_templates(const Style& style) {
  std::vector<int> roots;
  for (int b = 0; b < static_cast<int>(style.hierarchy.branches.size()); ++b) {
    if (style.hierarchy.branches[b].parent == kNone) roots.push_back(b);
  }
  std::stable_sort(roots.begin(), roots.end(), [&](int a, int b) {
    return style.bending.length_of(a) > style.bending.length_of(b);
  });
  return roots;
}

int place_root(GrowthState& state, const RootPlan& plan, Rng& rng) {
  GrowingBranch root;
  root.source = plan.source;
  const double profile = state.style.bending.smooth_radius[state.style.bending.first[plan.source]];
  root.radius_scale = plan.radius ? *plan.radius / profile : std::exp(0.1 * rng.normal());
  root.points = {plan.position};
  root.radii = {std::max(0.5, profile * root.radius_scale)};
  root.turns = {0.0};
  root.copied = {0};
  root.start_direction = wrap_angle(plan.direction);
  root.length = std::max(2.0 * state.style.step, plan.length);
  root.followed = plan.followed;
  root.heading = plan.followed != kNone ? std::nullopt : std::optional<double>(wrap_angle(plan.heading.value_or(plan.direction)));
  root.course = rng.uniform(0.6, 1.0);
  // A root on the frame starts outside, so that its rounded end is never seen.
  const Extension lead = lead_in(state, root);
  root.points.front() -= direction_of(root.start_direction) * (static_cast<double>(lead.points.size()) * state.style.step);
  const int number = state.start(root);
  if (state.occupancy.meet(state.branches, number, lead, true).blocked) {
    state.take_back(number);
    return kNone;
  }
  state.commit(number, lead);
  if (state.options.copy_stem && state.branches.size() == 1) copy_stem(state, number);
  if (plan.followed == kNone) aim_at_frame(state, state.branches[number]);
  state.branches[number].length += static_cast<double>(lead.points.size()) * state.style.step;
  grow_branch(state, number, rng);
  if (state.branches[number].count() >= 4 + static_cast<int>(lead.points.size())) return number;
  state.take_back(number);
  return kNone;
}

std::vector<int> grow_roots(GrowthState& state) {
  if (!state.drawn.empty()) return grow_along_courses(state);
  return state.target.roots.empty() ? grow_own_roots(state) : grow_given_roots(state);
}

}  // namespace ramify
