// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/geometry/polyline.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "ramify/geometry/segment.h"

namespace ramify {
namespace {

// Weights of a Gaussian at offsets -reach … reach in units of sigma / kPerSigma, summing to 1.
constexpr int kPerSigma = 6;
constexpr int kReach = 4 * kPerSigma;
std::vector<double> gaussian_weights() {
  std::vector<double> weights;
  double sum = 0.0;
  for (int k = -kReach; k <= kReach; ++k) {
    const double u = static_cast<double>(k) / kPerSigma;
    weights.push_back(std::exp(-0.5 * u * u));
    sum += weights.back();
  }
  for (double& w : weights) w /= sum;
  return weights;
}

// Where the segment from a to b first leaves the circle around `centre`, searching from fraction `from`; negative if it
// does not.
double leave_circle(const Vec2& a, const Vec2& b, const Vec2& centre, double radius, double from) {
  if ((b - centre).norm() < radius) {
    // Convexity: a segment whose searched part starts inside the disc and ends inside stays inside.
    return -1.0;
  }
  const Vec2 edge = b - a, start = a - centre;
  const double qa = edge.squaredNorm(), qb = start.dot(edge), qc = start.squaredNorm() - radius * radius;
  const double root = std::sqrt(std::max(0.0, qb * qb - qa * qc));
  // The larger solution, written so that nothing cancels.
  const double t = qb <= 0.0 ? (root - qb) / qa : -qc / (qb + root);
  return std::clamp(t, from, 1.0);
}

}  // namespace

std::vector<double> arc_lengths(std::span<const Vec2> points) {
  std::vector<double> arcs(points.size(), 0.0);
  for (std::size_t i = 1; i < points.size(); ++i) arcs[i] = arcs[i - 1] + (points[i] - points[i - 1]).norm();
  return arcs;
}

double polyline_length(std::span<const Vec2> points) {
  double length = 0.0;
  for (std::size_t i = 1; i < points.size(); ++i) length += (points[i] - points[i - 1]).norm();
  return length;
}

ArcPosition locate_arc(std::span<const double> arcs, double arc) {
  const int last = static_cast<int>(arcs.size()) - 1;
  if (last < 1 || !(arc > arcs.front())) return {0, 0.0};
  if (arc >= arcs.back()) return {last - 1, 1.0};
  const int next = static_cast<int>(std::upper_bound(arcs.begin(), arcs.end(), arc) - arcs.begin());
  const double step = arcs[next] - arcs[next - 1];
  return {next - 1, step > 0.0 ? (arc - arcs[next - 1]) / step : 0.0};
}

Vec2 point_at_arc(std::span<const Vec2> points, std::span<const double> arcs, double arc) {
  if (points.size() == 1) return points.front();
  const ArcPosition at = locate_arc(arcs, arc);
  return (1.0 - at.fraction) * points[at.segment] + at.fraction * points[at.segment + 1];
}

double value_at_arc(std::span<const double> values, std::span<const double> arcs, double arc) {
  if (values.size() == 1) return values.front();
  const ArcPosition at = locate_arc(arcs, arc);
  return (1.0 - at.fraction) * values[at.segment] + at.fraction * values[at.segment + 1];
}

SampledPolyline resample_count(std::span<const Vec2> points, int count) {
  SampledPolyline result;
  if (points.empty()) return result;
  count = std::max(count, 2);
  const std::vector<double> arcs = arc_lengths(points);
  for (int k = 0; k < count; ++k) {
    const double arc = arcs.back() * k / (count - 1);
    result.arcs.push_back(arc);
    result.points.push_back(point_at_arc(points, arcs, arc));
  }
  result.points.back() = points.back();
  return result;
}

SampledPolyline resample_arc(std::span<const Vec2> points, double step) {
  if (!(step > 0.0)) throw std::invalid_argument("resample_arc: the step must be positive");
  const double steps = std::round(polyline_length(points) / step);
  return resample_count(points, 1 + static_cast<int>(std::clamp(steps, 1.0, 1e8)));
}

SampledPolyline resample_chord(std::span<const Vec2> points, double chord) {
  if (!(chord > 0.0)) throw std::invalid_argument("resample_chord: the chord must be positive");
  SampledPolyline result;
  if (points.empty()) return result;
  const std::vector<double> arcs = arc_lengths(points);
  if (arcs.back() > 1e8 * chord) throw std::invalid_argument("resample_chord: more than 1e8 chords");
  result.points.push_back(points.front());
  result.arcs.push_back(0.0);
  double from = 0.0;  // fraction of the current segment already walked
  for (std::size_t i = 1; i < points.size();) {
    const Vec2& a = points[i - 1];
    const Vec2& b = points[i];
    const double t = leave_circle(a, b, result.points.back(), chord, from);
    const Vec2 next = a + std::max(t, 0.0) * (b - a);
    if (t < 0.0 || next == result.points.back()) {  // equal: a chord below the rounding of the coordinates
      ++i;
      from = 0.0;
      continue;
    }
    result.points.push_back(next);
    result.arcs.push_back(arcs[i - 1] + t * (arcs[i] - arcs[i - 1]));
    from = t;
  }
  return result;
}

std::vector<Vec2> refine_polyline(std::span<const Vec2> points, double step) {
  if (!(step > 0.0)) throw std::invalid_argument("refine_polyline: the step must be positive");
  std::vector<Vec2> knots;
  for (const Vec2& p : points) {
    if (knots.empty() || (p - knots.back()).norm() > 1e-9) knots.push_back(p);
  }
  if (knots.size() < 2) return knots;
  const int last = static_cast<int>(knots.size()) - 1;
  std::vector<Vec2> curve{knots.front()};
  for (int i = 0; i < last; ++i) {
    const Vec2 p1 = knots[i], p2 = knots[i + 1];
    const Vec2 p0 = i > 0 ? knots[i - 1] : Vec2(2.0 * p1 - p2);
    const Vec2 p3 = i + 2 <= last ? knots[i + 2] : Vec2(2.0 * p2 - p1);
    // Non-uniform parameters: square root of the chords ("centripetal").
    const double d0 = std::sqrt((p1 - p0).norm()), d1 = std::sqrt((p2 - p1).norm()), d2 = std::sqrt((p3 - p2).norm());
    const Vec2 m1 = d1 * ((p1 - p0) / d0 - (p2 - p0) / (d0 + d1) + (p2 - p1) / d1);
    const Vec2 m2 = d1 * ((p2 - p1) / d1 - (p3 - p1) / (d1 + d2) + (p3 - p2) / d2);
    const int pieces = std::max(1, static_cast<int>(std::ceil((p2 - p1).norm() / step)));
    for (int k = 1; k < pieces; ++k) {
      const double t = static_cast<double>(k) / pieces, t2 = t * t, t3 = t2 * t;
      curve.push_back((2 * t3 - 3 * t2 + 1) * p1 + (t3 - 2 * t2 + t) * m1 + (3 * t2 - 2 * t3) * p2 + (t3 - t2) * m2);
    }
    curve.push_back(p2);
  }
  return curve;
}

std::vector<Vec2> smooth_polyline(std::span<const Vec2> points, double sigma) {
  std::vector<Vec2> result(points.begin(), points.end());
  const std::vector<double> arcs = arc_lengths(points);
  if (!(sigma > 0.0) || points.size() < 3 || !(arcs.back() > 0.0)) return result;
  static const std::vector<double> weights = gaussian_weights();
  const double length = arcs.back();
  const Vec2 shift = 2.0 * (points.back() - points.front());
  // Reflection in both end points continues the curve for ever: P(u + 2L) = P(u) + 2 (P(L) - P(0)).
  const auto continued = [&](double arc) -> Vec2 {
    const double turns = std::floor((arc + length) / (2.0 * length));
    const double u = arc - turns * 2.0 * length;  // in [-L, L)
    const Vec2 p = point_at_arc(points, arcs, std::abs(u));
    return turns * shift + (u < 0.0 ? Vec2(2.0 * points.front() - p) : p);
  };
  for (std::size_t i = 1; i + 1 < points.size(); ++i) {
    Vec2 sum = Vec2::Zero();
    for (int k = -kReach; k <= kReach; ++k) sum += weights[k + kReach] * continued(arcs[i] + k * sigma / kPerSigma);
    result[i] = sum;
  }
  return result;
}

std::vector<double> smooth_values(std::span<const double> values, std::span<const double> arcs, double sigma) {
  std::vector<double> result(values.begin(), values.end());
  if (!(sigma > 0.0) || values.size() < 2 || !(arcs.back() > 0.0)) return result;
  static const std::vector<double> weights = gaussian_weights();
  const double length = arcs.back();
  for (std::size_t i = 0; i < values.size(); ++i) {
    double sum = 0.0;
    for (int k = -kReach; k <= kReach; ++k) {
      const double arc = arcs[i] + k * sigma / kPerSigma;
      const double u = arc - std::floor((arc + length) / (2.0 * length)) * 2.0 * length;
      sum += weights[k + kReach] * value_at_arc(values, arcs, std::abs(u));
    }
    result[i] = sum;
  }
  return result;
}

std::vector<double> turning_angles(std::span<const Vec2> points) {
  std::vector<double> angles(points.size(), 0.0);
  for (std::size_t i = 1; i + 1 < points.size(); ++i) {
    const Vec2 before = points[i] - points[i - 1], after = points[i + 1] - points[i];
    if (before.squaredNorm() > 0.0 && after.squaredNorm() > 0.0) {
      angles[i] = std::atan2(cross(before, after), before.dot(after));
    }
  }
  return angles;
}

std::vector<Vec2> tangents(std::span<const Vec2> points) {
  const int count = static_cast<int>(points.size());
  std::vector<Vec2> result(points.size(), Vec2::Zero());
  // Index of the nearest point before and after that differs from point i.
  std::vector<int> before(points.size(), kNone), after(points.size(), kNone);
  for (int i = 1; i < count; ++i) before[i] = points[i - 1] != points[i] ? i - 1 : before[i - 1];
  for (int i = count - 2; i >= 0; --i) after[i] = points[i + 1] != points[i] ? i + 1 : after[i + 1];
  for (int i = 0; i < count; ++i) {
    Vec2 sum = Vec2::Zero();
    if (before[i] != kNone) sum += (points[i] - points[before[i]]).normalized();
    if (after[i] != kNone) sum += (points[after[i]] - points[i]).normalized();
    // At a cusp both edges cancel: the edge after decides.
    if (sum.norm() < 1e-9 && after[i] != kNone) sum = points[after[i]] - points[i];
    result[i] = sum.norm() > 0.0 ? Vec2(sum.normalized()) : Vec2(Vec2::Zero());
  }
  return result;
}

int nearest_point(std::span<const Vec2> points, const Vec2& to) {
  std::size_t best = 0;
  for (std::size_t i = 1; i < points.size(); ++i) {
    if ((points[i] - to).squaredNorm() < (points[best] - to).squaredNorm()) best = i;
  }
  return static_cast<int>(best);
}

std::vector<int> simplify_polyline(std::span<const Vec2> points, double tolerance) {
  const int last = static_cast<int>(points.size()) - 1;
  std::vector<bool> keep(points.size(), false);
  std::vector<std::pair<int, int>> open;  // ranges still to check; a stack, not recursion
  if (last >= 0) keep[0] = keep[last] = true, open.emplace_back(0, last);
  while (!open.empty()) {
    const auto [from, to] = open.back();
    open.pop_back();
    int farthest = kNone;
    double distance = tolerance;
    for (int i = from + 1; i < to; ++i) {
      const double d = nearest_on_segment(points[i], points[from], points[to]).distance;
      if (d > distance) distance = d, farthest = i;
    }
    if (farthest == kNone) continue;
    keep[farthest] = true;
    open.emplace_back(from, farthest);
    open.emplace_back(farthest, to);
  }
  std::vector<int> indices;
  for (int i = 0; i <= last; ++i) {
    if (keep[i]) indices.push_back(i);
  }
  return indices;
}

}  // namespace ramify
