// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/exemplar/width_probe.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "ramify/exemplar/traced_line.h"

namespace ramify {
namespace {

constexpr double kStep = 0.25;       // px between samples of a profile
constexpr double kSampling = 0.5;    // px, blur by pixel area and bilinear reading: sqrt(1/12 + 1/6)
constexpr int kCandidates = 6;       // edges kept per side
constexpr double kWeakest = 0.2;     // of the profile's strongest edge
constexpr double kDummyCost = -0.2;  // cost of "no pair here"; a clear pair costs about -2
constexpr double kJump = 4.0;        // weight of squared edge moves between neighbours
constexpr double kFarOff =
    2.0;  // of the prior radius: a glow that is half as bright only farther out is not the branch's
constexpr double kLargestJump = 3.0;  // so that a branch can recover after a disturbance

struct Profile {
  std::vector<double> values;  // along the normal, kStep apart, positive where the branch is stronger than the surround
  double reach = 0.0;          // px, values run from -reach to +reach
  double at(int i) const { return -reach + i * kStep; }
};

double sample(const ScalarImage& image, const Vec2& p) {
  const int x = static_cast<int>(std::floor(p.x())), y = static_cast<int>(std::floor(p.y()));
  const double fx = p.x() - x, fy = p.y() - y;
  return (1 - fy) * ((1 - fx) * image.clamped(x, y) + fx * image.clamped(x + 1, y)) +
         fy * ((1 - fx) * image.clamped(x, y + 1) + fx * image.clamped(x + 1, y + 1));
}

// Mean of the profiles at -2 … +2 px along the branch.
Profile read_profile(const ScalarImage& picture, const Vec2& at, const Vec2& along, double reach, bool bright) {
  Profile p;
  const int half = static_cast<int>(std::ceil(reach / kStep));
  p.reach = half * kStep;
  const Vec2 normal = perpendicular(along);
  for (int i = -half; i <= half; ++i) {
    double sum = 0.0;
    for (int k = -2; k <= 2; ++k) sum += sample(picture, at + k * along + i * kStep * normal);
    p.values.push_back((bright ? 0.2 : -0.2) * sum);
  }
  return p;
}

struct Edge {
  double at = 0.0;        // px along the normal
  double strength = 0.0;  // 0..1 of the profile's strongest edge
};

struct Pair {
  double left = 0.0, right = 0.0;  // px along the normal
  double strength = 0.0;           // mean of both, 0 for "no pair"
  double cost = kDummyCost;
};

// Derivative of Gaussian along the profile.
std::vector<double> slope_of(const Profile& p, double sigma) {
  const int half = static_cast<int>(std::ceil(3.0 * sigma / kStep)), n = static_cast<int>(p.values.size());
  std::vector<double> kernel(static_cast<std::size_t>(half) + 1);
  double moment = 0.0;
  for (int k = 1; k <= half; ++k) {
    kernel[k] = k * std::exp(-0.5 * k * k * kStep * kStep / (sigma * sigma));
    moment += 2.0 * k * kStep * kernel[k];
  }
  std::vector<double> slope(p.values.size(), 0.0);
  for (int i = 0; i < n; ++i) {
    for (int k = 1; k <= half; ++k) {
      slope[i] += kernel[k] * (p.values[std::min(i + k, n - 1)] - p.values[std::max(i - k, 0)]);
    }
    slope[i] /= moment;
  }
  return slope;
}

// Local maxima of sign * slope, strongest first, at most kCandidates; sub-pixel by a parabola.
std::vector<Edge> edges_of(const Profile& p, const std::vector<double>& slope, double sign, double strongest) {
  std::vector<Edge> edges;
  for (int i = 1; i + 1 < static_cast<int>(slope.size()); ++i) {
    const double before = sign * slope[i - 1], here = sign * slope[i], after = sign * slope[i + 1];
    if (here < kWeakest * strongest || here < before || here <= after) continue;
    const double bend = before - 2.0 * here + after;
    edges.push_back({p.at(i) + (bend < 0.0 ? 0.5 * (before - after) / bend : 0.0) * kStep, here / strongest});
  }
  std::stable_sort(edges.begin(), edges.end(), [](const Edge& a, const Edge& b) { return a.strength > b.strength; });
  if (edges.size() > kCandidates) edges.resize(kCandidates);
  return edges;
}

std::vector<Pair> pairs_of(const Profile& p, double prior, double max_radius) {
  std::vector<Pair> pairs{{-prior, prior, 0.0, kDummyCost}};
  const std::vector<double> slope = slope_of(p, std::max(1.0, 0.15 * prior));
  double strongest = 0.0;
  // The strongest edge near the branch sets the scale; a coast far away must not silence a creek's banks.
  for (std::size_t i = 0; i < slope.size(); ++i) {
    if (std::abs(p.at(static_cast<int>(i))) < 2.0 * prior + 2.0) strongest = std::max(strongest, std::abs(slope[i]));
  }
  if (strongest <= 0.0) return pairs;
  for (const Edge& left : edges_of(p, slope, 1.0, strongest)) {
    for (const Edge& right : edges_of(p, slope, -1.0, strongest)) {
      const double radius = 0.5 * (right.at - left.at), middle = 0.5 * (right.at + left.at);
      if (radius < 0.4 || radius > max_radius || std::abs(middle) > 0.6 * prior + 1.5) continue;
      const double ratio = std::log(radius / prior);
      const double strength = std::min(left.strength, 1.5) + std::min(right.strength, 1.5);
      pairs.push_back(
          {left.at, right.at, 0.5 * strength,
           -strength + 0.1 * std::abs(std::abs(left.at) - std::abs(right.at)) / prior + 0.6 * ratio * ratio});
    }
  }
  return pairs;
}

double jump_cost(const Pair& a, const Pair& b, double spacing) {
  if (a.strength == 0.0 || b.strength == 0.0) return a.strength == b.strength ? 0.0 : 0.5;
  const double dl = b.left - a.left, dr = b.right - a.right;
  return std::min(kLargestJump,
                  kJump * (dl * dl + dr * dr) / (spacing * spacing + 0.05 * (a.right - a.left) * (a.right - a.left)));
}

// The cheapest sequence of pairs along the branch (Viterbi).
std::vector<Pair> best_pairs(const std::vector<std::vector<Pair>>& choices, double spacing) {
  std::vector<std::vector<double>> cost(choices.size());
  std::vector<std::vector<int>> came(choices.size());
  for (std::size_t i = 0; i < choices.size(); ++i) {
    for (const Pair& pair : choices[i]) {
      double best = i == 0 ? 0.0 : std::numeric_limits<double>::max();
      int from = kNone;
      for (std::size_t k = 0; i > 0 && k < choices[i - 1].size(); ++k) {
        const double through = cost[i - 1][k] + jump_cost(choices[i - 1][k], pair, spacing);
        if (through < best) {
          best = through;
          from = static_cast<int>(k);
        }
      }
      cost[i].push_back(best + pair.cost);
      came[i].push_back(from);
    }
  }
  std::vector<Pair> chosen(choices.size());
  int at = static_cast<int>(std::min_element(cost.back().begin(), cost.back().end()) - cost.back().begin());
  for (std::size_t i = choices.size(); i-- > 0; at = came[i][at]) chosen[i] = choices[i][at];
  return chosen;
}

// Half contrast: from the brightest point near the middle outwards to half way down to the darker of both sides' lows.
Pair half_contrast(const Profile& p, double prior, double max_radius) {
  const int n = static_cast<int>(p.values.size()), middle = n / 2;
  const int near = static_cast<int>(std::lround((0.5 * prior + 1.0) / kStep));
  int peak = middle;
  for (int i = std::max(0, middle - near); i <= std::min(n - 1, middle + near); ++i) {
    if (p.values[i] > p.values[peak]) peak = i;
  }
  const double left_low = *std::min_element(p.values.begin(), p.values.begin() + peak + 1);
  const double right_low = *std::min_element(p.values.begin() + peak, p.values.end());
  const double contrast = p.values[peak] - std::max(left_low, right_low);
  Pair pair{-prior, prior, 0.0, 0.0};
  if (contrast < 0.02) return pair;
  const double level = p.values[peak] - 0.5 * contrast;
  int a = peak, b = peak;
  while (a > 0 && p.values[a - 1] > level) --a;
  while (b < n - 1 && p.values[b + 1] > level) ++b;
  if (a == 0 || b == n - 1) return pair;
  pair.left = p.at(a) - kStep * (p.values[a] - level) / (p.values[a] - p.values[a - 1]);
  pair.right = p.at(b) + kStep * (p.values[b] - level) / (p.values[b] - p.values[b + 1]);
  pair.strength = std::min(1.0, contrast / 0.2);
  // At a faint end the half height is reached far off, on another branch's glow.
  if (0.5 * (pair.right - pair.left) > std::min(max_radius, kFarOff * prior + 1.0)) pair.strength = 0.0;
  return pair;
}

std::vector<double> running_median(const std::vector<double>& values, int half) {
  std::vector<double> out;
  for (int i = 0; i < static_cast<int>(values.size()); ++i) {
    const int low = std::max(0, i - half), high = std::min(static_cast<int>(values.size()) - 1, i + half);
    std::vector<double> window(values.begin() + low, values.begin() + high + 1);
    std::nth_element(window.begin(), window.begin() + static_cast<std::ptrdiff_t>(window.size() / 2), window.end());
    out.push_back(window[window.size() / 2]);
  }
  return out;
}

// Replaces values without strength by linear interpolation between the neighbours that have some.
void bridge_gaps(std::vector<double>& values, const std::vector<Pair>& pairs) {
  int last = kNone;
  for (int i = 0; i < static_cast<int>(values.size()); ++i) {
    if (pairs[i].strength == 0.0) continue;
    for (int k = last + 1; k < i; ++k) {
      const double t = last == kNone ? 1.0 : static_cast<double>(k - last) / (i - last);
      values[k] = t * values[i] + (last == kNone ? 0.0 : (1.0 - t) * values[last]);
    }
    last = i;
  }
  for (int k = last + 1; last != kNone && k < static_cast<int>(values.size()); ++k) values[k] = values[last];
}

ProbedLine probe_once(const ScalarImage& picture, const std::vector<Vec2>& line, const std::vector<double>& prior,
                      const WidthProbeOptions& options) {
  const int n = static_cast<int>(line.size());
  std::vector<std::vector<Pair>> choices;
  std::vector<Vec2> normals;
  double mean_prior = 0.0;
  for (int i = 0; i < n; ++i) {
    const int reach = std::clamp(static_cast<int>(prior[i]), 3, 12);
    const Vec2 along = tangent_at(line, i, reach);
    normals.push_back(perpendicular(along));
    const double span = std::min(std::max(4.0 * prior[i], 12.0), 2.0 * options.max_radius + 8.0);
    const Profile p = read_profile(picture, line[i], along, span, options.bright);
    if (options.glow)
      choices.push_back({half_contrast(p, prior[i], options.max_radius)});
    else
      choices.push_back(pairs_of(p, prior[i], options.max_radius));
    mean_prior += prior[i] / n;
  }
  const double spacing = n > 1 ? std::max(0.5, (line[1] - line[0]).norm()) : 1.0;
  const std::vector<Pair> pairs = best_pairs(choices, spacing);
  std::vector<double> apparent, shifts;
  for (int i = 0; i < n; ++i) {
    apparent.push_back(0.5 * (pairs[i].right - pairs[i].left));
    shifts.push_back(std::clamp(0.5 * (pairs[i].right + pairs[i].left), -0.5 * prior[i] - 1.0, 0.5 * prior[i] + 1.0));
  }
  bridge_gaps(apparent, pairs);
  bridge_gaps(shifts, pairs);
  const double sigma = std::max(2.0, 0.5 * mean_prior);
  shifts = smoothed(running_median(shifts, 3), sigma);
  // What blur adds to thin bars is taken off last: the correction is steep, so noise must be gone before.
  std::vector<double> radii = smoothed(running_median(apparent, 3), options.glow ? sigma : std::max(4.0, sigma));
  for (int i = 0; i < n && !options.glow; ++i) {
    radii[i] = bar_radius(radii[i], std::hypot(options.blur, std::max(1.0, 0.15 * prior[i]), kSampling));
  }
  ProbedLine out;
  for (int i = 0; i < n; ++i) {
    out.points.push_back(line[i] + shifts[i] * normals[i]);
    out.radii.push_back(std::clamp(radii[i], 0.4, options.max_radius));
    out.confidence.push_back(std::min(1.0, pairs[i].strength));
  }
  return out;
}

}  // namespace

double bar_radius(double apparent, double sigma) {
  // The smoothed bar's slope G(x - w) - G(x + w) is steepest where (x - w) = (x + w) exp(-2 x w / sigma^2). For thin
  // bars x tends to sigma whatever w is; below 1.02 sigma the width cannot be told and the smallest useful one is
  // given.
  double low = 0.3, high = apparent;
  if (apparent <= low) return apparent;
  const auto excess = [&](double w) {
    return (apparent - w) - (apparent + w) * std::exp(-2.0 * apparent * w / (sigma * sigma));
  };
  if (excess(low) < 0.0) return low;
  for (int i = 0; i < 40; ++i) {
    const double w = 0.5 * (low + high);
    (excess(w) > 0.0 ? low : high) = w;
  }
  return 0.5 * (low + high);
}

ProbedLine probe_widths(const ScalarImage& picture, const std::vector<Vec2>& line, const std::vector<double>& prior,
                        const WidthProbeOptions& options) {
  const ProbedLine first = probe_once(picture, line, prior, options);
  const std::vector<Vec2> middle = smoothed(first.points, 2.0);
  ProbedLine second = probe_once(picture, middle, first.radii, options);
  second.points = smoothed(second.points, 1.0);
  return second;
}

}  // namespace ramify
