// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/growth/extension.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "ramify/growth/candidates.h"
#include "ramify/growth/joining.h"
#include "ramify/growth/raster_density.h"
#include "ramify/growth/winding.h"

namespace ramify {
namespace {

constexpr int kBest = 24;              // candidates that are tested (PICTURES 12.2-8)
constexpr double kEpsilon = 1e-3;      // of the paper's Q / (D + epsilon)
constexpr double kValleyFloor = 0.3;   // of G: bends within the valley are all alike, else branches hug its middle
constexpr double kPullAlong = 4.0;     // towards the place ahead on a course
constexpr double kLookAhead = 3.0;     // extensions to that place: a nearer one would straighten the bends
constexpr double kRunOn = 4.0;         // spacings (half a mesh of a net each) that an end may go on to what it joins
constexpr double kDensityFloor = 0.1;  // the same for mean densities (12.2-8: not separable from the maximum)

bool related(const std::vector<GrowingBranch>& branches, int number, int other) {
  return other == number || other == branches[number].parent || branches[other].parent == number;
}

class Stepper {
 public:
  Stepper(GrowthState& state, int number, Rng& rng)
      : state_(state), number_(number), rng_(rng), guided_(state.branches[number].followed != kNone) {}

  // One extension; false when nothing fits.
  bool step() {
    const GrowingBranch& branch = self();
    const int m = state_.style.bending.extension;
    double remaining = branch.length - branch.arc(state_.style.step);
    const bool late = branch.arc(state_.style.step) > 0.6 * branch.length;
    StepAim aim;
    aim.guided = guided_;
    if (branch.joins) {
      if (late) aim.toward = place_to_join();
      aim.pull = 3.0;
      remaining = std::max(remaining, m * state_.style.step);
    }
    aim.count = std::clamp(static_cast<int>(std::lround(remaining / state_.style.step)), 1, m);
    if (guided_) {
      const Course& course = state_.courses[branch.followed];
      const double here = state_.progress(branch);
      const double strayed = (branch.points.back() - course.point_at(here)).norm() / course.width();
      aim.toward = course.point_at(here + kLookAhead * aim.count * state_.style.step);
      aim.pull = kPullAlong * (1.0 + strayed * strayed);
    }
    const std::vector<Candidate> all = find_candidates(state_, number_, aim, 4 * kBest);
    if (all.empty()) return false;
    const auto part = [&](std::size_t from, std::size_t to) {
      from = std::min(from, all.size());
      return std::vector<Candidate>(all.begin() + static_cast<std::ptrdiff_t>(from),
                                    all.begin() + static_cast<std::ptrdiff_t>(std::min(to, all.size())));
    };
    // The retry ladder of ALGORITHMS 4.5.
    if (take_one(part(0, kBest), aim.count)) return true;
    if (take_one(part(kBest, 4 * kBest), aim.count)) return true;
    const int shorter = std::max(1, std::min(aim.count, m / 2));
    if (take_one(part(0, kBest), shorter)) return true;
    for (const double degrees : {10.0, -10.0, 20.0, -20.0, 35.0, -35.0}) {
      std::vector<Candidate> turned = part(0, kBest);
      for (Candidate& candidate : turned) candidate.rotation = degrees * kPi / 180.0;
      if (take_one(turned, shorter)) return true;
    }
    return false;
  }

 private:
  struct Scored {
    double score;
    Extension extension;
  };

  const GrowingBranch& self() const { return state_.branches[number_]; }

  // Tests and scores the candidates; draws among the c best by their scores.
  bool take_one(const std::vector<Candidate>& candidates, int count) {
    std::vector<Scored> fits;
    const bool bounded = !guided_ && !state_.options.paper_exact;  // the user's course may turn as it likes
    const WindingBound winding(state_.style.hierarchy, self());
    for (const Candidate& candidate : candidates) {
      Scored scored{candidate.score, extend_by(state_, number_, candidate, count)};
      if (scored.extension.points.empty() || (bounded && winding.exceeded_by(scored.extension))) continue;
      if (!make_room(scored.extension)) continue;
      scored.score += surroundings(scored.extension);
      fits.push_back(std::move(scored));
    }
    if (fits.empty()) return false;
    std::stable_sort(fits.begin(), fits.end(), [](const Scored& a, const Scored& b) { return a.score > b.score; });
    fits.resize(std::min<std::size_t>(fits.size(), static_cast<std::size_t>(state_.options.candidates)));
    std::vector<double> weights;
    for (const Scored& fit : fits) weights.push_back(std::exp(fit.score - fits.front().score));
    state_.commit(number_, fits[static_cast<std::size_t>(rng_.discrete(weights))].extension);
    return true;
  }

  // False when the extension meets something; an extension that may end on what it meets is cut there.
  bool make_room(Extension& extension) const {
    if (state_.options.raster_density) return !crosses_density(state_, number_, extension);
    const GrowingBranch& branch = self();
    const bool joining = branch.joins && branch.arc(state_.style.step) >= 0.3 * branch.length;
    const Hit hit = state_.occupancy.meet(state_.branches, number_, extension, joining);
    if (!hit.blocked) return true;
    if (hit.capsule == kNone || !joining) return false;
    const Capsule& target = state_.occupancy.index()[hit.capsule];
    return !related(state_.branches, number_, target.owner) &&
           end_on(target, hit.point, state_.occupancy, state_.ground, state_.branches, number_, extension);
  }

  // Density, free space, painted map and guide along the extension and beyond it.
  double surroundings(const Extension& extension) const {
    const GrowingBranch& branch = self();
    const Vec2 from = branch.points.back(), to = extension.points.back();
    const Vec2 along = (to - from).norm() > 1e-9 ? Vec2((to - from).normalized())
                                                 : direction_of(direction_at(branch, branch.count() - 1));
    const double reach = 0.5 * static_cast<double>(extension.points.size()) * state_.style.step;
    const int beyond = branch.count() + static_cast<int>(extension.points.size());
    if (state_.options.raster_density)
      return -std::log(raster_maximum(state_, number_, from, along, 6.0 * reach) + kEpsilon);
    const bool joining = branch.joins && branch.arc(state_.style.step) > 0.5 * branch.length;
    double density = 0.0, free = 0.0, wanted = 0.0;
    int densities = 0, places = 0;
    const auto look = [&](const Vec2& point, int node, bool dense) {
      free += state_.unfilled(point);
      wanted += state_.ground.wanted(point);
      ++places;
      if (!dense || !state_.ground.inside(point)) return;
      density += state_.occupancy.density(state_.branches, number_, point, node);
      ++densities;
    };
    for (std::size_t j = 0; j < extension.points.size(); ++j) {
      look(extension.points[j], branch.count() + static_cast<int>(j), j % 2 == 1);
    }
    for (int j = 1; j <= 4; ++j) look(to + along * (reach * j), beyond, true);
    double score = 0.5 * std::log(0.05 + free / places);
    if (!joining) score -= std::log(density / std::max(1, densities) + kDensityFloor);
    if (state_.ground.painted()) score -= std::log(1.0 - wanted / places + kDensityFloor);
    return score + (guided_ ? guidance(extension) : 0.0);
  }

  // Q / (G + epsilon), G over the extension only: a straight ray would leave a curved valley (ALGORITHMS 4.6). Which
  // way the valley goes is the candidates' affair.
  double guidance(const Extension& extension) const {
    const Course& course = state_.courses[self().followed];
    double sum = 0.0;
    for (const Vec2& point : extension.points) sum += course.value(point);
    return -std::log(sum / static_cast<double>(extension.points.size()) + kValleyFloor);
  }

  // The nearest place of a branch that is no relative, those ahead preferred.
  std::optional<Vec2> place_to_join() const {
    const GrowingBranch& branch = self();
    const int tip = branch.count() - 1;
    const Vec2 from = branch.points.back();
    const Vec2 along = (from - branch.points[std::max(0, tip - state_.style.bending.extension)]).stableNormalized();
    double best = std::max(kRunOn * state_.spacing, 0.25 * branch.length);
    std::optional<Vec2> place;
    const Vec2 reach = Vec2::Constant(best);
    const CapsuleIndex& index = state_.occupancy.index();
    index.visit_box(from - reach, from + reach, [&](int number) {
      const Capsule& other = index[number];
      if (related(state_.branches, number_, other.owner)) return true;
      const Vec2 way = 0.5 * (other.a + other.b) - from;
      const double distance = way.norm();
      if (distance < 1.0) return true;
      const double cost = distance * (1.0 + 2.0 * std::max(0.0, 0.7 - way.dot(along) / distance));
      if (cost < best) {
        best = cost;
        place = from + way;
      }
      return true;
    });
    return place;
  }

  GrowthState& state_;
  int number_;
  Rng& rng_;
  bool guided_;
};

// A branch whose template ends by leaving the frame goes on past its length if the frame is near; one that joins too.
double longest(const GrowthState& state, const GrowingBranch& branch) {
  const bool leaves = state.style.hierarchy.branches[branch.source].end == BranchEnd::Frame;
  return branch.length * ((leaves || branch.joins) && !state.options.paper_exact ? 1.5 : 1.0);
}

// Beyond what the paint asks for a branch does not go on.
bool overfull(const GrowthState& state, const GrowingBranch& branch) {
  constexpr double kTooMuch = 0.05;
  if (!state.ground.painted() || !state.ground.inside(branch.points.back())) return false;
  return state.demand.lack(branch.points.back()) < -kTooMuch * (0.5 + state.ground.wanted(branch.points.back()));
}

}  // namespace

// Ends made by growth alone fade as the exemplar's tips do. What was stopped while it was thick needs more way than
// they and comes down to the exemplar's thinnest: else rivers and vessels end blunt in the open.
void taper_tip(GrowthState& state, int number) {
  constexpr double kWay = 8.0;       // radii
  constexpr double kGuidedWay = 16.0;  // the same for what ends where its guide does: as thick as a main branch
  constexpr double kThick = 2.0;     // times the thinnest
  constexpr double kCutShort = 4.0;  // times the thinnest: a template's own tip as wide as that is a trace cut short
  GrowingBranch& branch = state.branches[number];
  if (branch.stop == GrowthStop::Frame || branch.stop == GrowthStop::Join) return;
  const Hierarchy& learnt = state.style.hierarchy;
  const double radius = branch.radii.back(), widths = radius / learnt.least_radius;
  const bool own_tip =
      learnt.branches[branch.source].end == BranchEnd::Tip && branch.arc(state.style.step) > 0.9 * branch.length;
  if (own_tip && (widths <= kCutShort || state.options.paper_exact)) return;
  const bool thick = widths > kThick && !state.options.paper_exact;
  const int last = static_cast<int>(learnt.tip_profile.size()) - 1, end = branch.count() - 1;
  const bool guided = branch.followed != kNone && branch.followed < static_cast<int>(state.drawn.size());
  const double way_radii = guided ? kGuidedWay : kWay;
  const int way = thick ? std::max(last, static_cast<int>(way_radii * radius / state.style.step)) : last;
  const double pointed = thick ? 1.0 / widths : 1.0;
  for (int j = 0; j <= std::min(way, end); ++j) {
    const double share = static_cast<double>(j) / way;
    const double factor = learnt.tip_profile[static_cast<std::size_t>(std::lround(share * last))];
    branch.radii[end - j] =
        std::max(0.5, branch.radii[end - j] * factor * (pointed + (1.0 - pointed) * (guided ? share : std::sqrt(share))));
  }
}

void aim_at_frame(const GrowthState& state, GrowingBranch& branch) {
  if (state.style.hierarchy.branches[branch.source].end != BranchEnd::Frame || !branch.heading) return;
  const Vec2 along = direction_of(*branch.heading);
  for (double way = 0.5 * branch.length; way <= 2.5 * branch.length; way += state.style.step) {
    if (state.ground.inside(branch.points.back() + along * way)) continue;
    branch.length = 1.1 * way;
    return;
  }
}

void grow_branch(GrowthState& state, int number, Rng& rng) {
  const int m = state.style.bending.extension;
  Stepper stepper(state, number, rng);
  int setbacks = 0;
  for (;;) {
    state.monitor.check();
    const GrowingBranch& branch = state.branches[number];
    if (branch.stop != GrowthStop::None) break;
    const double arc = branch.arc(state.style.step);
    const bool guided = branch.followed != kNone;
    if (guided && state.progress(branch) > state.courses[branch.followed].length() - 0.5 * m * state.style.step) break;
    if (!guided && arc > state.spacing && overfull(state, branch)) break;
    if (arc >= longest(state, branch) - 0.5 * state.style.step) break;
    if (stepper.step()) continue;
    if (branch.count() <= m + 1 || ++setbacks > 3) {
      state.branches[number].stop = GrowthStop::Stuck;
      break;
    }
    state.step_back(number, m);
  }
  if (!state.net()) taper_tip(state, number);
}

bool run_on(GrowthState& state, int number, Rng& rng) {
  const GrowingBranch before = state.branches[number];
  if (before.stop == GrowthStop::Frame || before.stop == GrowthStop::Join || before.followed != kNone) return true;
  const double most = before.arc(state.style.step) + kRunOn * state.spacing;
  GrowingBranch& branch = state.branches[number];
  branch.stop = GrowthStop::None;
  branch.joins = true;
  branch.length = before.arc(state.style.step);
  Stepper stepper(state, number, rng);
  while (branch.stop == GrowthStop::None && branch.arc(state.style.step) < most) {
    state.monitor.check();
    if (!stepper.step()) break;
  }
  if (branch.stop != GrowthStop::None) return true;
  state.step_back(number, branch.count() - before.count());
  branch.stop = before.stop;
  branch.joins = before.joins;
  branch.length = before.length;
  return false;
}

}  // namespace ramify
