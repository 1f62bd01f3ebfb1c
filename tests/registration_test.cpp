// SPDX-License-Identifier: GPL-3.0-or-later
#include <Eigen/Dense>
#include <catch2/catch.hpp>

#include "ramify/core/random.h"
#include "ramify/geometry/registration.h"
#include "ramify/geometry/thin_plate.h"

using namespace ramify;

namespace {

std::vector<Vec2> random_points(int count, double range, std::uint64_t seed) {
  Rng rng(seed);
  std::vector<Vec2> points;
  for (int i = 0; i < count; ++i) points.emplace_back(rng.uniform(-range, range), rng.uniform(-range, range));
  return points;
}

}  // namespace

TEST_CASE("a turned point set is turned back exactly") {
  for (int trial = 0; trial < 100; ++trial) {
    Rng rng(trial);
    const double angle = rng.uniform(-kPi, kPi);
    const std::vector<Vec2> from = random_points(7, 20.0, trial);
    std::vector<Vec2> to;
    for (const Vec2& p : from) to.push_back(rotated(p, angle));
    const Alignment a = align_rotation(from, to);
    CHECK(std::abs(wrap_angle(a.angle - angle)) < 1e-9);
    CHECK(a.residual < 1e-6);
  }
}

TEST_CASE("no other angle leaves a smaller residual") {
  for (int trial = 0; trial < 50; ++trial) {
    const std::vector<Vec2> from = random_points(6, 10.0, trial), to = random_points(6, 10.0, 1000 + trial);
    const Alignment a = align_rotation(from, to);
    auto residual = [&](double angle) {
      double sum = 0.0;
      for (std::size_t l = 0; l < from.size(); ++l) sum += (rotated(from[l], angle) - to[l]).squaredNorm();
      return sum;
    };
    CHECK(residual(a.angle) == Approx(a.residual));
    for (int k = 0; k < 360; ++k) CHECK(residual(k * kPi / 180) >= a.residual - 1e-9);
  }
}

TEST_CASE("a thin plate passes through its points and keeps affine fields") {
  const std::vector<Vec2> points = random_points(15, 50.0, 4), values = random_points(15, 5.0, 5);
  const ThinPlate plate(points, values, 50.0, 0.0);
  for (std::size_t i = 0; i < points.size(); ++i) CHECK((plate(points[i]) - values[i]).norm() < 1e-6);
  std::vector<Vec2> affine;
  for (const Vec2& p : points) affine.emplace_back(3 + 0.2 * p.x() - 0.1 * p.y(), -1 + 0.05 * p.x() + 0.3 * p.y());
  const ThinPlate flat(points, affine, 50.0, 1e-3);
  for (const Vec2& p : random_points(30, 80.0, 6)) {
    CHECK((flat(p) - Vec2(3 + 0.2 * p.x() - 0.1 * p.y(), -1 + 0.05 * p.x() + 0.3 * p.y())).norm() < 1e-6);
  }
}

TEST_CASE("a thin plate bends less than any disturbed one through the same points") {
  // Adding any field that is 0 at the points must not lower the bending energy: compare with the plate through extra
  // points that are moved off the optimum. Energy = weights' phi weights, from a direct dense solve.
  const std::vector<Vec2> points = random_points(10, 1.0, 7), values = random_points(10, 0.3, 8);
  auto energy = [](const std::vector<Vec2>& p, const std::vector<Vec2>& v) {
    const int n = static_cast<int>(p.size());
    Eigen::MatrixXd k(n, n), q(n, 3), m = Eigen::MatrixXd::Zero(n + 3, n + 3), b = Eigen::MatrixXd::Zero(n + 3, 2);
    for (int i = 0; i < n; ++i) {
      for (int j = 0; j < n; ++j) {
        const double r = (p[i] - p[j]).norm();
        k(i, j) = r > 0 ? r * r * std::log(r) : 0.0;
      }
      q.row(i) << 1.0, p[i].x(), p[i].y();
      b.row(i) = v[i].transpose();
    }
    m << k, q, q.transpose(), Eigen::MatrixXd::Zero(3, 3);
    const Eigen::MatrixXd w = m.fullPivHouseholderQr().solve(b).topRows(n);
    return (w.transpose() * k * w).trace();
  };
  const ThinPlate plate(points, values, 1.0, 0.0);
  const double least = energy(points, values);
  for (int trial = 0; trial < 20; ++trial) {
    std::vector<Vec2> more = points, wanted = values;
    Rng rng(trial);
    more.emplace_back(rng.uniform(-1, 1), rng.uniform(-1, 1));
    wanted.push_back(plate(more.back()));
    CHECK(energy(more, wanted) == Approx(least).epsilon(1e-6));
    wanted.back() += Vec2(0.05, -0.02);
    CHECK(energy(more, wanted) > least);
  }
}

TEST_CASE("a grid warp interpolates and measures folding") {
  WarpGrid warp{Vec2(-3, 2), 2.0, 6, 5, {}};
  for (int y = 0; y < 5; ++y) {
    for (int x = 0; x < 6; ++x) {
      const Vec2 p = warp.origin + 2.0 * Vec2(x, y);
      warp.values.emplace_back(2 * p.x() + p.y() + 7, 0.5 * p.y() - 1);
    }
  }
  for (const Vec2& p : random_points(20, 30.0, 9)) {
    CHECK((warp(p) - Vec2(2 * p.x() + p.y() + 7, 0.5 * p.y() - 1)).norm() < 1e-9);
  }
  const JacobianRange range = measure_jacobian(warp, {0, 5}, 100.0);
  CHECK(range.low == Approx(1.0));
  CHECK(range.high == Approx(1.0));
  warp.values[8] = warp.values[6];
  CHECK(measure_jacobian(warp, {0, 5}, 100.0).low < 0.0);
}

TEST_CASE("two points make no plate") {
  const std::vector<Vec2> points = {{0, 0}, {1, 1}}, values = {{0, 0}, {1, 0}};
  CHECK_THROWS_AS(ThinPlate(points, values, 1.0, 0.0), std::invalid_argument);
}
