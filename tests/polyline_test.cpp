// SPDX-License-Identifier: GPL-3.0-or-later
#include <catch2/catch.hpp>
#include <cmath>

#include "ramify/core/random.h"
#include "ramify/geometry/polyline.h"
#include "ramify/geometry/segment.h"

using namespace ramify;

namespace {

std::vector<Vec2> circle_arc(double radius, double from, double to, int count) {
  std::vector<Vec2> points;
  for (int i = 0; i <= count; ++i) points.push_back(radius * direction_of(from + (to - from) * i / count));
  return points;
}

std::vector<Vec2> random_walk(Rng& rng, int count) {
  std::vector<Vec2> points{Vec2(0, 0)};
  double heading = 0.0;
  for (int i = 0; i < count; ++i) {
    heading += 0.4 * rng.normal();
    points.push_back(points.back() + rng.uniform(0.2, 3.0) * direction_of(heading));
  }
  return points;
}

}  // namespace

TEST_CASE("arc lengths and points at an arc follow the edges") {
  const std::vector<Vec2> line{{0, 0}, {3, 4}, {3, 4}, {3, 10}};
  CHECK(arc_lengths(line) == std::vector<double>{0, 5, 5, 11});
  CHECK(polyline_length(line) == 11.0);
  const auto arcs = arc_lengths(line);
  CHECK(point_at_arc(line, arcs, 2.5).isApprox(Vec2(1.5, 2)));
  CHECK(point_at_arc(line, arcs, 8).isApprox(Vec2(3, 7)));
  CHECK(point_at_arc(line, arcs, -1) == line.front());
  CHECK(point_at_arc(line, arcs, 99) == line.back());
  const std::vector<double> radii{1, 2, 4, 1};
  CHECK(value_at_arc(radii, arcs, 8) == Approx(2.5));
}

TEST_CASE("degenerate polylines come through") {
  const std::vector<Vec2> none, one{{2, 3}}, same(5, Vec2(2, 3));
  for (const auto& line : {none, one, same}) {
    CHECK(polyline_length(line) == 0.0);
    CHECK(smooth_polyline(line, 2.0) == line);
    for (const double a : turning_angles(line)) CHECK(a == 0.0);
    for (const Vec2& t : tangents(line)) CHECK(t == Vec2::Zero());
    CHECK(resample_chord(line, 1.0).points.size() == std::min<std::size_t>(line.size(), 1));
    CHECK(refine_polyline(line, 1.0).size() == std::min<std::size_t>(line.size(), 1));
  }
  CHECK(resample_arc(one, 1.0).points.size() == 2);
  CHECK(resample_arc(none, 1.0).points.empty());
  CHECK_THROWS_AS(resample_chord(one, 0.0), std::invalid_argument);
  CHECK_THROWS_AS(resample_arc(one, std::nan("")), std::invalid_argument);
}

TEST_CASE("equal arc steps keep both ends and the length") {
  const auto line = circle_arc(50, 0, 2, 4000);
  const SampledPolyline sampled = resample_arc(line, 7.0);
  REQUIRE(sampled.points.size() == 15);  // 100 / 7 rounds to 14 steps
  CHECK(sampled.points.front() == line.front());
  CHECK(sampled.points.back() == line.back());
  for (std::size_t i = 0; i < sampled.points.size(); ++i) {
    CHECK((sampled.points[i] - 50.0 * direction_of(2.0 * i / 14)).norm() < 1e-3);
  }
}

TEST_CASE("constant chords are exact and their turns are those of the circle") {
  const double radius = 40, chord = 5;
  const auto sampled = resample_chord(circle_arc(radius, 0, 3, 20000), chord);
  for (std::size_t i = 1; i < sampled.points.size(); ++i) {
    CHECK((sampled.points[i] - sampled.points[i - 1]).norm() == Approx(chord).epsilon(1e-12));
  }
  const auto turns = turning_angles(sampled.points);
  // A chord h of a circle turns by 2 asin(h / 2R); with y down a growing angle turns clockwise, hence positive.
  for (std::size_t i = 1; i + 1 < turns.size(); ++i) CHECK(turns[i] == Approx(2 * std::asin(chord / (2 * radius))).epsilon(1e-4));
  CHECK(turns.front() == 0.0);
  CHECK(turns.back() == 0.0);
}

TEST_CASE("constant chords hold on any curve and lie on it in order") {
  Rng rng(3);
  for (int trial = 0; trial < 40; ++trial) {
    const auto line = random_walk(rng, 120);
    const auto arcs = arc_lengths(line);
    const double chord = rng.uniform(0.3, 9.0);
    const auto sampled = resample_chord(line, chord);
    for (std::size_t i = 0; i < sampled.points.size(); ++i) {
      CHECK((point_at_arc(line, arcs, sampled.arcs[i]) - sampled.points[i]).norm() < 1e-9);
      if (i == 0) continue;
      CHECK((sampled.points[i] - sampled.points[i - 1]).norm() == Approx(chord).epsilon(1e-9));
      CHECK(sampled.arcs[i] > sampled.arcs[i - 1]);
      // First exit: nothing in between lies outside the circle.
      for (double u = sampled.arcs[i - 1]; u < sampled.arcs[i]; u += 0.1) {
        CHECK((point_at_arc(line, arcs, u) - sampled.points[i - 1]).norm() <= chord + 1e-9);
      }
    }
    // What is dropped is shorter than a chord as the crow flies.
    CHECK((line.back() - sampled.points.back()).norm() < chord);
  }
}

TEST_CASE("smoothing keeps the ends and straight lines and damps waves like a Gaussian") {
  std::vector<Vec2> line, wave;
  for (int i = 0; i <= 400; ++i) {
    line.emplace_back(i * 0.5, 3 + i * 0.25);
    wave.emplace_back(i * 0.5, 0.01 * std::sin(2 * kPi * i * 0.5 / 20));
  }
  const auto straight = smooth_polyline(line, 4.0);
  for (std::size_t i = 0; i < line.size(); ++i) CHECK((straight[i] - line[i]).norm() < 1e-9);
  const auto damped = smooth_polyline(wave, 3.0);
  CHECK(damped.front() == wave.front());
  CHECK(damped.back() == wave.back());
  // A sine of wavelength L is damped by exp(-2 (pi sigma / L)^2).
  CHECK(damped[190].y() / wave[190].y() == Approx(std::exp(-2 * std::pow(kPi * 3.0 / 20, 2))).epsilon(1e-3));
  const std::vector<double> constant(wave.size(), 2.5);
  for (const double v : smooth_values(constant, arc_lengths(wave), 5.0)) CHECK(v == Approx(2.5));
  CHECK(smooth_polyline(wave, 0.0) == wave);
  // Far wider than the curve: the odd continuation has the straight chord as its mean.
  const auto flat = smooth_polyline(circle_arc(10, 0, 1, 50), 1000.0);
  CHECK((flat[25] - 0.5 * (flat.front() + flat.back())).norm() < 0.5);
}

TEST_CASE("the refined curve passes through its points without overshooting wildly") {
  const auto coarse = circle_arc(100, 0, 3, 12);
  const auto fine = refine_polyline(coarse, 1.0);
  for (const Vec2& p : coarse) {
    double nearest = 1e9;
    for (const Vec2& q : fine) nearest = std::min(nearest, (p - q).norm());
    CHECK(nearest < 1e-12);
  }
  const std::size_t inner = fine.size() / 12;
  for (std::size_t i = inner; i + inner < fine.size(); ++i) CHECK(fine[i].norm() == Approx(100).margin(0.1));
  for (std::size_t i = 1; i < fine.size(); ++i) CHECK((fine[i] - fine[i - 1]).norm() < 1.5);
}

TEST_CASE("turning angles and tangents have the documented sign") {
  const std::vector<Vec2> right{{0, 0}, {1, 0}, {1, 1}};  // y is down: this turns clockwise on the screen
  CHECK(turning_angles(right)[1] == Approx(kPi / 2));
  CHECK(tangents(right)[0].isApprox(Vec2(1, 0)));
  CHECK(tangents(right)[1].isApprox(Vec2(1, 1).normalized()));
  CHECK(tangents(right)[2].isApprox(Vec2(0, 1)));
  const std::vector<Vec2> doubled{{0, 0}, {1, 0}, {1, 0}, {2, 0}};
  for (const Vec2& t : tangents(doubled)) CHECK(t.isApprox(Vec2(1, 0)));
}

TEST_CASE("the nearest point is the first of those at the least distance") {
  const std::vector<Vec2> square{{0, 0}, {4, 0}, {4, 4}, {0, 4}, {0, 0}};
  CHECK(nearest_point(square, Vec2(3, 1.5)) == 1);
  CHECK(nearest_point(square, Vec2(-9, 5)) == 3);
  CHECK(nearest_point(square, Vec2(0, 0)) == 0);
  CHECK(nearest_point(square, Vec2(2, 2)) == 0);
  CHECK(nearest_point(std::vector<Vec2>{{7, 7}}, Vec2(0, 0)) == 0);
}

TEST_CASE("simplification stays within its tolerance and drops what is straight") {
  Rng rng(9);
  const auto line = random_walk(rng, 500);
  for (const double tolerance : {0.0, 0.5, 3.0}) {
    const auto kept = simplify_polyline(line, tolerance);
    CHECK(kept.front() == 0);
    CHECK(kept.back() == static_cast<int>(line.size()) - 1);
    for (std::size_t k = 1; k < kept.size(); ++k) {
      for (int i = kept[k - 1]; i <= kept[k]; ++i) {
        CHECK(nearest_on_segment(line[i], line[kept[k - 1]], line[kept[k]]).distance <= tolerance + 1e-9);
      }
    }
  }
  std::vector<Vec2> straight;
  for (int i = 0; i < 100; ++i) straight.emplace_back(i, 2 * i);
  CHECK(simplify_polyline(straight, 0.01) == std::vector<int>{0, 99});
}
