// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/growth/bent_path.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

#include "ramify/core/parallel.h"
#include "ramify/geometry/polyline.h"

namespace ramify {
namespace {

constexpr double kValley = 1.5;    // times the bends' amplitude (ALGORITHMS 4.6)
constexpr double kMostTurn = 1.5;  // times the exemplar's spread: more closing than that would show
constexpr double kStray = 2.5;     // valleys from the course
constexpr int kAttempts = 4;
constexpr int kShortList = 64;
constexpr int kBest = 3;
constexpr double kEpsilon = 0.05;     // of the valley's floor: bends within it are all alike
constexpr double kPull = 3.0;         // towards the place ahead
constexpr double kWidthWeight = 1.0;  // per squared log ratio of radii
constexpr double kReuse = 0.5;
constexpr double kLongest = 1e5;  // px: no picture is as long
constexpr double kFreeEnd = 0.5;  // rad, by which the last edge may leave the course's direction

std::vector<Vec2> chain(const Vec2& start, double direction, double step, const std::vector<double>& turns) {
  std::vector<Vec2> points{start};
  for (const double turn : turns) {
    direction += turn;
    points.push_back(points.back() + direction_of(direction) * step);
  }
  return points;
}

}  // namespace

double close_chain(std::vector<Vec2>& points, const Vec2& end, double direction, const ChainSpread& spread) {
  constexpr double kFailed = std::numeric_limits<double>::infinity();
  const std::size_t edges = points.size() - 1;
  if (edges < 3) return kFailed;
  // turns[0] is the first edge's direction; the step is common to all edges.
  double step = polyline_length(points) / static_cast<double>(edges);
  std::vector<double> turns{angle_of(points[1] - points[0])};
  for (std::size_t i = 1; i < edges; ++i)
    turns.push_back(wrap_angle(angle_of(points[i + 1] - points[i]) - angle_of(points[i] - points[i - 1])));
  const std::vector<double> before = turns;
  const Vec2 start = points.front();
  const auto spread_of = [&](std::size_t i) { return i == 0 ? spread.heading : spread.turn; };
  const double near = 0.01 * step;
  std::vector<Vec2> moved = points;
  for (int round = 0; round < 5; ++round) {
    const Vec2 gap = end - moved.back();
    const double turn = wrap_angle(direction - angle_of(moved[edges] - moved[edges - 1]));
    if (gap.norm() < near && std::abs(turn) < 1e-3) break;
    // Turning edge i moves the end by the perpendicular of the way from its start to the end.
    Eigen::MatrixXd jacobian(3, static_cast<Eigen::Index>(edges) + 1);
    Eigen::VectorXd variance(static_cast<Eigen::Index>(edges) + 1);
    for (std::size_t i = 0; i < edges; ++i) {
      const Vec2 moves = perpendicular(moved.back() - moved[i]);
      jacobian.col(static_cast<Eigen::Index>(i)) << moves.x(), moves.y(), 1.0;
      variance[static_cast<Eigen::Index>(i)] = spread_of(i) * spread_of(i);
    }
    const Vec2 way = moved.back() - start;
    jacobian.col(static_cast<Eigen::Index>(edges)) << way.x(), way.y(), 0.0;
    variance[static_cast<Eigen::Index>(edges)] = spread.stretch * spread.stretch;
    const Eigen::MatrixXd weighted = variance.asDiagonal() * jacobian.transpose();
    const Eigen::Vector3d change = (jacobian * weighted).fullPivLu().solve(Eigen::Vector3d(gap.x(), gap.y(), turn));
    const Eigen::VectorXd deltas = weighted * change;
    if (!deltas.allFinite() || deltas.cwiseAbs().maxCoeff() > 1.0) return kFailed;
    for (std::size_t i = 0; i < edges; ++i) turns[i] += deltas[static_cast<Eigen::Index>(i)];
    step *= std::exp(deltas[static_cast<Eigen::Index>(edges)]);
    moved = chain(start, 0.0, step, turns);
  }
  const Vec2 rest = end - moved.back();
  if (!(rest.norm() < near)) return kFailed;
  double most = 0.0;
  for (std::size_t i = 1; i < edges; ++i) most = std::max(most, std::abs(turns[i] - before[i]));
  for (std::size_t i = 1; i <= edges; ++i) moved[i] += rest * (static_cast<double>(i) / static_cast<double>(edges));
  moved.back() = end;
  points = std::move(moved);
  return most;
}

PathBender::PathBender(const Style& style)
    : style_(style),
      matcher_(style.bending),
      valley_(kValley * bend_amplitude(style.bending)),
      turn_spread_(0.0),
      uses_(static_cast<std::size_t>(style.bending.vertex_count()), 0) {
  const BendingModel& model = style.bending;
  double count = 1e-9;
  for (int b = 0; b < model.branch_count(); ++b) {
    for (int i = model.first[b] + 1; i + 1 < model.first[b + 1]; ++i, count += 1.0)
      turn_spread_ += model.alpha[i] * model.alpha[i];
  }
  turn_spread_ = std::max(0.02, std::sqrt(turn_spread_ / count));
  angles_.low = model.angles.low;
  angles_.high = model.angles.high;
}

std::vector<PathBender::Choice> PathBender::short_list(const GrowingBranch& branch, const Course& course,
                                                       double progress, int count) const {
  const BendingModel& model = style_.bending;
  WindowQualities qualities;
  matcher_.match(branch, count < model.extension ? count : std::max(1, model.extension / 2), false, qualities);
  const Vec2 tip = branch.points.back(), along = direction_of(direction_at(branch, branch.count() - 1));
  const Vec2 aim = (course.point_at(progress + 2.0 * count * style_.step) - tip).stableNormalized();
  const double width = std::log(branch.radii.back());
  std::vector<Choice> list;
  for (int v = 0; v < model.vertex_count(); ++v) {
    if (!std::isfinite(qualities.plain[v])) continue;
    const double ratio = std::log(model.smooth_radius[v]) - width;
    const double common = -kWidthWeight * ratio * ratio - kReuse * std::log(1.0 + uses_[v]);
    const Vec2 local = matcher_.displacement(v, std::min(count, matcher_.following(v)), branch.count() == 1);
    for (const bool mirrored : {false, true}) {
      if (mirrored && !style_.mirror) continue;
      const Vec2 step = local.x() * along + (mirrored ? -local.y() : local.y()) * perpendicular(along);
      const double turned = 1.0 - aim.dot(step.stableNormalized());
      list.push_back(
          {v, mirrored, (mirrored ? qualities.mirrored[v] : qualities.plain[v]) + common - kPull * turned, {}, {}});
    }
  }
  const std::size_t kept = std::min<std::size_t>(list.size(), kShortList);
  std::partial_sort(list.begin(), list.begin() + static_cast<std::ptrdiff_t>(kept), list.end(),
                    [](const Choice& a, const Choice& b) {
                      if (a.score != b.score) return a.score > b.score;
                      return a.vertex != b.vertex ? a.vertex < b.vertex : a.mirrored < b.mirrored;
                    });
  list.resize(kept);
  return list;
}

// The extension itself, how deep in the valley it lies, and what it does for the angles.
void PathBender::look_closer(const GrowingBranch& branch, const Course& course, double progress, int count,
                             Choice& choice) const {
  const BendingModel& model = style_.bending;
  double direction = direction_at(branch, branch.count() - 1), up = 0.0;
  Vec2 point = branch.points.back();
  const int most = std::min(count, matcher_.following(choice.vertex));
  const double reach = count * style_.step;
  for (int j = 0; j < most; ++j) {
    double turn = branch.count() == 1 && j == 0 ? 0.0 : model.alpha[choice.vertex + j];
    if (choice.mirrored) turn = -turn;
    direction += turn;
    point += direction_of(direction) * style_.step;
    choice.turns.push_back(turn);
    choice.points.push_back(point);
    const double away = (point - course.point_at(course.arc_at(point, progress, progress + 2.0 * reach))).norm();
    up += 1.0 - std::exp(-away * away / (valley_ * valley_));
  }
  choice.score -= std::log(up / most + kEpsilon);
  const double gain = histogram_gain(model.angles, angles_, choice.turns) * 400.0 * angles_.total / model.extension;
  choice.score += std::clamp(gain, -3.0, 3.0);
}

bool PathBender::grow(const Course& course, std::span<const double> arcs, std::span<const double> radii, Rng& rng,
                      GrowingBranch& branch) const {
  const double step = style_.step, length = course.length();
  const std::size_t most = static_cast<std::size_t>(4.0 * length / step) + 16;
  double progress = 0.0;
  while (length - progress > 0.6 * step && branch.points.size() < most) {
    check_cancel();
    const int count =
        std::clamp(static_cast<int>(std::lround((length - progress) / step)), 1, style_.bending.extension);
    std::vector<Choice> choices = short_list(branch, course, progress, count);
    if (choices.empty()) return false;
    for (Choice& choice : choices) look_closer(branch, course, progress, count, choice);
    std::stable_sort(choices.begin(), choices.end(),
                     [](const Choice& a, const Choice& b) { return a.score > b.score; });
    choices.resize(std::min<std::size_t>(choices.size(), kBest));
    std::vector<double> weights;
    for (const Choice& choice : choices) weights.push_back(std::exp(choice.score - choices.front().score));
    const Choice& taken = choices[static_cast<std::size_t>(rng.discrete(weights))];
    for (std::size_t j = 0; j < taken.points.size(); ++j) {
      progress = course.arc_at(taken.points[j], progress, progress + 4.0 * step);
      branch.turns.back() = taken.turns[j];
      branch.points.push_back(taken.points[j]);
      branch.turns.push_back(0.0);
      branch.radii.push_back(value_at_arc(radii, arcs, progress));
      branch.copied.push_back(taken.mirrored ? -(taken.vertex + static_cast<int>(j) + 2)
                                             : taken.vertex + static_cast<int>(j) + 2);
      if (length - progress <= 0.6 * step) break;
    }
  }
  return length - progress <= 0.6 * step && branch.points.size() >= 4;
}

void PathBender::remember(const GrowingBranch& branch) {
  for (const double turn : turning_angles(branch.points)) angles_.add(turn);
  for (const int copied : branch.copied) {
    if (copied != 0) ++uses_[static_cast<std::size_t>(std::abs(copied) - 1)];
  }
}

std::vector<Vec2> PathBender::bend(std::span<const Vec2> points, std::span<const double> radii, const Rng& rng) {
  const double length = polyline_length(points);
  if (points.size() < 2 || !(length < kLongest) || length < std::max(0.5 * style_.feature_size, 4.0 * style_.step))
    return {};
  // What is finer than the exemplar's bends goes: they take its place.
  const double sigma = std::min(0.5 * style_.feature_size, 0.25 * length);
  const SampledPolyline even = resample_arc(points, std::max(0.5, 0.125 * sigma));
  std::vector<Vec2> smooth = smooth_polyline(even.points, sigma);
  smooth.front() = points.front(), smooth.back() = points.back();
  const Course course(resample_arc(smooth, std::max(1.0, 0.5 * sigma)).points, valley_);
  if (course.length() < 3.0 * style_.step) return {};
  std::vector<double> arcs = arc_lengths(points);
  for (double& arc : arcs) arc *= course.length() / length;
  const double ahead = std::min(style_.feature_size, 0.5 * course.length());
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    Rng own = rng.child("bend", static_cast<std::uint64_t>(attempt));
    GrowingBranch branch;
    branch.points = {points.front()};
    branch.radii = {radii.front()};
    branch.turns = {0.0};
    branch.copied = {0};
    branch.start_direction = course.direction_at(0.0, ahead) + own.normal() * turn_spread_;
    if (!grow(course, arcs, radii, own, branch)) continue;
    const double wanted = course.direction_at(course.length(), ahead);
    const std::size_t last = branch.points.size() - 1;
    const double turned = wrap_angle(angle_of(branch.points[last] - branch.points[last - 1]) - wanted);
    const double most = close_chain(branch.points, points.back(), wanted + std::clamp(turned, -kFreeEnd, kFreeEnd),
                                    {turn_spread_, 0.3, 0.05});
    if (most > kMostTurn * turn_spread_) continue;
    const auto strayed = [&](const Vec2& p) {
      check_cancel();
      return (p - course.point_at(course.arc_at(p, 0.0, course.length()))).norm() > kStray * valley_;
    };
    if (std::any_of(branch.points.begin(), branch.points.end(), strayed)) continue;
    remember(branch);
    return branch.points;
  }
  return {};
}

}  // namespace ramify
