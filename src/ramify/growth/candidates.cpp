// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/growth/candidates.h"

#include <algorithm>
#include <cmath>

namespace ramify {
namespace {

constexpr int kShortList = 160;        // windows whose costly terms are looked at
constexpr double kHeadingWeight = 2.0; // PICTURES 12.2-5
constexpr double kWidthWeight = 1.0;   // per squared log ratio of radii
constexpr int kHeadingReach = 6;       // extensions over which a chord is taken
constexpr double kGuidedGain = 8.0;    // on omega_G along a course: 400, the most of ALGORITHMS 4.3
constexpr double kReuse = 0.5;         // ALGORITHMS 4.2: Q (1 + uses)^-0.5
constexpr double kVerbatimRun = 4.0;   // extensions copied in one piece before the next is made unlikely
constexpr double kVerbatimLog = -1.386294361119890618;  // log 0.25

int vertex_of(int copied) { return std::abs(copied) - 1; }

// Vertices up to the tip that were copied in one piece.
int verbatim_run(const GrowingBranch& branch) {
  int run = 1;
  for (int i = branch.count() - 1; i > 0; --i, ++run) {
    const int a = branch.copied[i - 1], b = branch.copied[i];
    if (a == 0 || b == 0 || (a > 0) != (b > 0) || std::abs(b) != std::abs(a) + 1) break;
  }
  return run;
}

double one_minus_cosine(const Vec2& a, const Vec2& b) {
  const double lengths = std::sqrt(a.squaredNorm() * b.squaredNorm());
  return lengths > 0.0 ? 1.0 - a.dot(b) / lengths : 1.0;
}

// The terms of a candidate's score that are not its likeness.
struct Scorer {
  const GrowthState& state;
  const GrowingBranch& branch;
  const StepAim& aim;
  Vec2 along;                        // unit vector of the tip's direction
  int from;                          // first node of the chord that is compared
  std::optional<Vec2> intended;      // unit vector
  double heading_weight;
  double remaining;                  // px
  int run;

  Vec2 advance(const Candidate& c) const {
    const int count = std::min(aim.count, state.matcher.following(c.vertex));
    const Vec2 local = state.matcher.displacement(c.vertex, count, branch.count() == 1);
    return local.x() * along + (c.mirrored ? -local.y() : local.y()) * perpendicular(along);
  }

  double heading(const Vec2& step) const {
    if (aim.toward) return -aim.pull * one_minus_cosine(step, *aim.toward - branch.points.back());
    if (!intended) return 0.0;
    return -heading_weight * one_minus_cosine(branch.points.back() + step - branch.points[from], *intended);
  }

  // Heading drift and curls bounded by the exemplar's own 95 and 97 % values (PICTURES 1).
  double drift(const Vec2& step) const {
    const Hierarchy& h = state.style.hierarchy;
    if (aim.guided) return 0.0;  // the user's course may turn more than the exemplar's
    const int m = state.style.bending.extension, tip = branch.count() - 1;
    double penalty = 0.0;
    for (std::size_t l = 0; l < h.lags.size(); ++l) {
      const int at = tip + aim.count - h.lags[l];
      if (at < m || at > tip) continue;
      const double before = angle_of(branch.points[at] - branch.points[at - m]);
      const double excess = std::abs(wrap_angle(angle_of(step) - before)) - h.lag_turn[l];
      if (excess > 0.0) penalty += 0.5 * std::pow(excess / 0.25, 2);
    }
    for (std::size_t l = 0; l < h.lags.size(); ++l) {
      const int at = tip + aim.count - h.lags[l];
      if (at < 0 || at > tip) continue;
      const double chord = (branch.points.back() + step - branch.points[at]).norm() / (h.lags[l] * state.style.step);
      if (chord < h.lag_chord[l]) penalty += 0.5 * std::pow((h.lag_chord[l] - chord) / 0.1, 2);
    }
    return -penalty;
  }

  double histograms(const Candidate& c) const {
    const BendingModel& bending = state.style.bending;
    std::vector<double> turns, widths;
    for (int j = 0; j < std::min(aim.count, state.matcher.following(c.vertex)); ++j) {
      turns.push_back(c.mirrored ? -bending.alpha[c.vertex + j] : bending.alpha[c.vertex + j]);
      widths.push_back(bending.radius[c.vertex + j + 1]);
    }
    double gain = histogram_gain(bending.angles, state.angles, turns);
    if (state.options.radius_histogram) gain += histogram_gain(bending.radii, state.radii, widths);
    // A course asks for straight windows all along: the exemplar's angles have to be asked for as loudly.
    const double weight = (aim.guided ? kGuidedGain : 1.0) * state.options.histogram_weight;
    const double exponent = weight * gain * state.angles.total / bending.extension;
    return state.options.raw_distance ? exponent : std::clamp(exponent, -3.0, 3.0);
  }

  double verbatim(const Candidate& c) const {
    const int last = branch.copied.back();
    if (last == 0 || run <= kVerbatimRun * state.style.bending.extension) return 0.0;
    return (last > 0) != c.mirrored && c.vertex == vertex_of(last) ? kVerbatimLog : 0.0;
  }
};

// Windows that continue a template branch's end only where the growing branch is near its own.
std::vector<double> remaining_scores(const GrowthState& state, double remaining) {
  const BendingModel& bending = state.style.bending;
  std::vector<double> scores(bending.point.size());
  for (int b = 0; b < bending.branch_count(); ++b) {
    const bool cut = state.style.hierarchy.branches[b].end == BranchEnd::Frame;
    for (int i = bending.first[b]; i < bending.first[b + 1]; ++i) {
      const double left = (bending.first[b + 1] - i) * bending.step, want = remaining + bending.step;
      // What the frame cut off would have gone on: only too little left counts against it.
      const double ratio = std::log((left + 16.0) / (want + 16.0));
      scores[i] = cut && want > left ? 0.0 : -0.5 * ratio * ratio;
    }
  }
  return scores;
}

bool better(const Candidate& a, const Candidate& b) {
  if (a.score != b.score) return a.score > b.score;
  return a.vertex != b.vertex ? a.vertex < b.vertex : a.mirrored < b.mirrored;
}

}  // namespace

std::optional<double> intended_direction(const GrowthState& state, const GrowingBranch& branch, int from, double arc_ahead) {
  if (!branch.heading) return std::nullopt;
  const BendingModel& bending = state.style.bending;
  const int first = bending.first[branch.source], last = bending.length_of(branch.source) - 1;
  const double whole = std::max(branch.length, state.style.step);
  const auto at = [&](double arc) {
    const double place = std::clamp(arc / whole, 0.0, 1.0) * last;
    const int i = std::min(static_cast<int>(place), std::max(0, last - 1));
    return Vec2(bending.point[first + i] + (bending.point[first + std::min(last, i + 1)] - bending.point[first + i]) * (place - i));
  };
  const Vec2 whole_chord = bending.point[first + last] - bending.point[first];
  const Vec2 part = at(branch.arc(state.style.step) + arc_ahead) - at(from * state.style.step);
  if (part.norm() < 1e-9 || whole_chord.norm() < 1e-9) return branch.heading;
  const double bend = wrap_angle(angle_of(part) - angle_of(whole_chord));
  return wrap_angle(*branch.heading + branch.course * (branch.mirrored ? -bend : bend));
}

std::vector<Candidate> find_candidates(const GrowthState& state, int number, const StepAim& aim, int most) {
  const GrowingBranch& branch = state.branches[number];
  const int m = state.style.bending.extension, tip = branch.count() - 1;
  WindowQualities qualities;
  const bool ends_soon = aim.count < m;
  state.matcher.match(branch, ends_soon ? aim.count : std::max(1, m / 2), state.options.raw_distance, qualities);

  Scorer scorer{state, branch, aim, direction_of(direction_at(branch, tip)), std::max(0, tip - kHeadingReach * m), std::nullopt, 0.0,
                std::max(0.0, branch.length - branch.arc(state.style.step)), verbatim_run(branch)};
  if (!state.options.free_direction) {
    const auto wanted = intended_direction(state, branch, scorer.from, aim.count * state.style.step);
    if (wanted) scorer.intended = direction_of(*wanted);
    scorer.heading_weight = kHeadingWeight * (1.0 + std::min(2.0, (tip - scorer.from) / (3.0 * m)));
  }
  const std::vector<double> remaining = remaining_scores(state, scorer.remaining);
  const bool plain = state.options.paper_exact;
  // Likeness ends at a factor of two; a wide branch must not take a thin one's bends however well they lead.
  const auto width = [&](int v) {
    const double ratio = std::log(state.style.bending.smooth_radius[v] / branch.radii.back());
    return -kWidthWeight * ratio * ratio;
  };
  std::vector<Candidate> list;
  for (int v = 0; v < state.style.bending.vertex_count(); ++v) {
    const double common = plain ? 0.0 : remaining[v] + width(v) - kReuse * std::log(1.0 + state.window_uses[v]);
    if (std::isfinite(qualities.plain[v])) list.push_back({v, false, 0.0, qualities.plain[v] + common});
    if (state.style.mirror && std::isfinite(qualities.mirrored[v])) list.push_back({v, true, 0.0, qualities.mirrored[v] + common});
  }
  for (Candidate& c : list) c.score += scorer.heading(scorer.advance(c)) + (plain ? 0.0 : scorer.verbatim(c));
  const std::size_t kept = std::min<std::size_t>(list.size(), kShortList);
  std::partial_sort(list.begin(), list.begin() + static_cast<std::ptrdiff_t>(kept), list.end(), better);
  list.resize(kept);
  for (Candidate& c : list) c.score += scorer.histograms(c) + (plain ? 0.0 : scorer.drift(scorer.advance(c)));
  std::sort(list.begin(), list.end(), better);

  std::vector<Candidate> best;
  for (const Candidate& c : list) {
    const bool taken = std::any_of(best.begin(), best.end(), [&](const Candidate& b) {
      return b.mirrored == c.mirrored && std::abs(b.vertex - c.vertex) <= m / 2;
    });
    if (!taken) best.push_back(c);
    if (static_cast<int>(best.size()) >= most) break;
  }
  return best;
}

void leave_frame(const Ground& ground, double direction, double step, Extension& extension) {
  extension.stop = GrowthStop::Frame;
  if (ground.painted()) return;  // what is painted is met to the pixel
  const double radius = extension.radii.back();
  const auto off_canvas = [&](const Vec2& p) {
    return std::max({-p.x(), -p.y(), p.x() - (ground.size().width - 1), p.y() - (ground.size().height - 1)});
  };
  for (double gone = 0.0; gone < 2.0 * radius && !ground.on_canvas(extension.points.back()); gone += step) {
    if (off_canvas(extension.points.back()) >= radius) break;
    extension.points.push_back(extension.points.back() + direction_of(direction) * step);
    extension.radii.push_back(radius);
    extension.turns.push_back(0.0);
    extension.copied.push_back(0);
  }
}

Extension extend_by(const GrowthState& state, int number, const Candidate& candidate, int count) {
  const GrowingBranch& branch = state.branches[number];
  const BendingModel& bending = state.style.bending;
  const double step = state.style.step, tip_radius = branch.radii.back();
  const int m = bending.extension, tip = branch.count() - 1;
  double direction = direction_at(branch, tip);
  Vec2 point = branch.points.back();
  Extension out;
  for (int j = 0; j < std::min(count, state.matcher.following(candidate.vertex)); ++j) {
    const int source = candidate.vertex + j + 1;
    double turn = branch.count() == 1 && j == 0 ? 0.0 : bending.alpha[source - 1];
    turn = wrap_angle((candidate.mirrored ? -turn : turn) + (j == 0 ? candidate.rotation : 0.0));
    direction += turn;
    point += direction_of(direction) * step;
    double radius = bending.radius[source];
    if (!state.options.free_radius) {
      const double wanted = state.template_radius(branch, (tip + j + 1) * step) *
                            std::clamp(radius / bending.smooth_radius[source], 0.7, 1.4);
      radius = wanted * std::pow(tip_radius / wanted, std::pow(0.5, (j + 1.0) / (0.25 * m + 1.0)));
    }
    out.points.push_back(point);
    const double least = std::min(state.style.hierarchy.least_radius, branch.most_radius);
    out.radii.push_back(std::clamp(radius, least, branch.most_radius));
    out.turns.push_back(turn);
    out.copied.push_back(candidate.mirrored ? -(source + 1) : source + 1);
    if (!state.ground.inside(point)) {
      leave_frame(state.ground, direction, step, out);
      break;
    }
  }
  return out;
}

}  // namespace ramify
