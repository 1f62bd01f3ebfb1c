// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/geometry/bezier.h"

#include <algorithm>
#include <cmath>

namespace ramify {
namespace {

constexpr int kImprovements = 4;       // Newton rounds before a run of points is split
constexpr double kTangentReach = 3.0;  // end tangents look this many tolerances along the points: noise is no direction

std::vector<Vec2> without_repeats(std::span<const Vec2> points) {
  std::vector<Vec2> out;
  for (const Vec2& p : points) {
    if (out.empty() || (p - out.back()).squaredNorm() > 1e-12) out.push_back(p);
  }
  return out;
}

double turn_at(const Vec2& before, const Vec2& at, const Vec2& after) {
  const Vec2 in = at - before, out = after - at;
  return std::abs(std::atan2(cross(in, out), in.dot(out)));
}

// Direction in which the points leave `from` (step +1) or come from when read backwards (step -1).
Vec2 end_tangent(std::span<const Vec2> points, int from, int step, int stop, double reach) {
  int i = from;
  while (i != stop && (points[i] - points[from]).norm() < reach) i += step;
  if (i == from) i += step;
  return (points[i] - points[from]).normalized();
}

// Fits runs of one smooth piece. Appends to `curves`.
class Fitter {
 public:
  Fitter(std::span<const Vec2> points, double tolerance, std::vector<CubicBezier>& curves)
      : points_(points), tolerance_(tolerance), curves_(curves) {}

  void fit(int first, int last, const Vec2& out, const Vec2& in) {
    if (last - first == 1) {
      const double third = (points_[last] - points_[first]).norm() / 3.0;
      curves_.push_back({points_[first], points_[first] + third * out, points_[last] + third * in, points_[last]});
      return;
    }
    std::vector<double> t = chord_parameters(first, last);
    CubicBezier curve = least_squares(first, last, t, out, in);
    int worst = first;
    double error = largest_error(first, last, curve, t, worst);
    for (int k = 0; k < kImprovements && error > tolerance_ && error < 6.0 * tolerance_; ++k) {
      improve(first, curve, t);
      curve = least_squares(first, last, t, out, in);
      error = largest_error(first, last, curve, t, worst);
    }
    if (error <= tolerance_) {
      curves_.push_back(curve);
      return;
    }
    worst = std::clamp(worst, first + 1, last - 1);
    const Vec2 through = middle_tangent(first, worst, last);
    fit(first, worst, out, -through);
    fit(worst, last, through, in);
  }

 private:
  std::vector<double> chord_parameters(int first, int last) const {
    std::vector<double> t(static_cast<std::size_t>(last - first) + 1, 0.0);
    for (int i = first + 1; i <= last; ++i) t[i - first] = t[i - first - 1] + (points_[i] - points_[i - 1]).norm();
    for (double& value : t) value /= t.back();
    return t;
  }

  // The lengths of both handles by least squares; a third of the chord where that makes no sense.
  CubicBezier least_squares(int first, int last, const std::vector<double>& t, const Vec2& out, const Vec2& in) const {
    const Vec2 a = points_[first], d = points_[last];
    double c00 = 0, c01 = 0, c11 = 0, x0 = 0, x1 = 0;
    for (int i = first; i <= last; ++i) {
      const double u = t[i - first], v = 1.0 - u;
      const double b1 = 3 * v * v * u, b2 = 3 * v * u * u;
      const Vec2 rest = points_[i] - (v * v * v + b1) * a - (u * u * u + b2) * d;
      c00 += b1 * b1;
      c01 += b1 * b2 * out.dot(in);
      c11 += b2 * b2;
      x0 += b1 * out.dot(rest);
      x1 += b2 * in.dot(rest);
    }
    const double chord = (d - a).norm(), determinant = c00 * c11 - c01 * c01;
    double left = 0.0, right = 0.0;
    if (std::abs(determinant) > 1e-9 * c00 * c11) {
      left = (x0 * c11 - x1 * c01) / determinant;
      right = (c00 * x1 - c01 * x0) / determinant;
    }
    const double least = 1e-3 * chord, most = 3.0 * chord + 1e-9;
    if (!(left > least && left < most && right > least && right < most)) left = right = chord / 3.0;
    return {a, a + left * out, d + right * in, d};
  }

  double largest_error(int first, int last, const CubicBezier& curve, const std::vector<double>& t, int& worst) const {
    double largest = 0.0;
    worst = (first + last) / 2;
    for (int i = first + 1; i < last; ++i) {
      const double error = (point_on(curve, t[i - first]) - points_[i]).norm();
      if (error > largest) largest = error, worst = i;
    }
    return largest;
  }

  // One Newton step towards the nearest point of the curve, for every point.
  void improve(int first, const CubicBezier& curve, std::vector<double>& t) const {
    for (std::size_t i = 1; i + 1 < t.size(); ++i) {
      const Vec2 gap = point_on(curve, t[i]) - points_[first + static_cast<int>(i)], d1 = derivative_on(curve, t[i]);
      const double u = t[i];
      const Vec2 d2 = 6 * (1 - u) * (curve[2] - 2 * curve[1] + curve[0]) + 6 * u * (curve[3] - 2 * curve[2] + curve[1]);
      const double slope = d1.squaredNorm() + gap.dot(d2);
      if (slope > 1e-12) t[i] = std::clamp(u - gap.dot(d1) / slope, 0.0, 1.0);
    }
  }

  Vec2 middle_tangent(int first, int at, int last) const {
    const double reach = kTangentReach * tolerance_;
    const Vec2 ahead = end_tangent(points_, at, 1, last, reach), back = end_tangent(points_, at, -1, first, reach);
    const Vec2 sum = ahead - back;
    return sum.norm() > 1e-9 ? Vec2(sum.normalized()) : ahead;
  }

  std::span<const Vec2> points_;
  double tolerance_;
  std::vector<CubicBezier>& curves_;
};

void fit_smooth_run(std::span<const Vec2> points, double tolerance, std::vector<CubicBezier>& curves) {
  const int last = static_cast<int>(points.size()) - 1;
  const double reach = kTangentReach * tolerance;
  Fitter(points, tolerance, curves)
      .fit(0, last, end_tangent(points, 0, 1, last, reach), end_tangent(points, last, -1, 0, reach));
}

}  // namespace

Vec2 point_on(const CubicBezier& c, double t) {
  const double s = 1.0 - t;
  return s * s * s * c[0] + 3 * s * s * t * c[1] + 3 * s * t * t * c[2] + t * t * t * c[3];
}

Vec2 derivative_on(const CubicBezier& c, double t) {
  const double s = 1.0 - t;
  return 3 * (s * s * (c[1] - c[0]) + 2 * s * t * (c[2] - c[1]) + t * t * (c[3] - c[2]));
}

CubicBezier straight_bezier(const Vec2& from, const Vec2& to) {
  return {from, from + (to - from) / 3.0, to - (to - from) / 3.0, to};
}

std::vector<CubicBezier> fit_beziers(std::span<const Vec2> raw, const FitOptions& options) {
  const std::vector<Vec2> points = without_repeats(raw);
  std::vector<CubicBezier> curves;
  if (points.size() < 2) return curves;
  std::size_t start = 0;
  for (std::size_t i = 1; i < points.size(); ++i) {
    const bool end = i + 1 == points.size();
    if (!end && turn_at(points[i - 1], points[i], points[i + 1]) <= options.corner) continue;
    fit_smooth_run(std::span(points).subspan(start, i - start + 1), options.tolerance, curves);
    start = i;
  }
  return curves;
}

std::vector<CubicBezier> fit_closed_beziers(std::span<const Vec2> raw, const FitOptions& options) {
  std::vector<Vec2> ring = without_repeats(raw);
  while (ring.size() > 1 && (ring.back() - ring.front()).squaredNorm() <= 1e-12) ring.pop_back();
  const std::size_t n = ring.size();
  if (n < 3) return {};
  std::size_t sharp = 0, flat = 0;
  double sharpest = 0.0, flattest = 4.0;
  for (std::size_t i = 0; i < n; ++i) {
    const double turn = turn_at(ring[(i + n - 1) % n], ring[i], ring[(i + 1) % n]);
    if (turn > sharpest) sharpest = turn, sharp = i;
    if (turn < flattest) flattest = turn, flat = i;
  }
  const bool cornered = sharpest > options.corner;
  std::rotate(ring.begin(), ring.begin() + static_cast<std::ptrdiff_t>(cornered ? sharp : flat), ring.end());
  ring.push_back(ring.front());
  if (cornered) return fit_beziers(ring, options);
  // No corner at all: the seam lies where it is straightest, and both its handles share one direction.
  std::vector<CubicBezier> curves;
  const Vec2 through = (ring[1] - ring[n - 1]).normalized();
  Fitter(ring, options.tolerance, curves).fit(0, static_cast<int>(n), through, -through);
  return curves;
}

}  // namespace ramify
