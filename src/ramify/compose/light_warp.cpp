// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/compose/light_warp.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace ramify {
namespace {

constexpr int kRowPoints = 11;
constexpr int kRingPoints = 8;
constexpr double kRing = 1.3;          // radius of the ring of fixed points, in s
constexpr double kSmoothing = 1e-3;    // of the thin plate, in units of s^2
constexpr int kGridStep = 4;           // px
constexpr double kLeastArea = 0.4, kMostArea = 2.5;  // photo area per canvas area (PICTURES 12.1-5)
constexpr double kDamping = 0.6;       // of the bend, until it stays within these
constexpr int kDampings = 5;

double kernel(const Vec2& d) {
  const double q = d.squaredNorm();
  return q > 1e-12 ? 0.5 * q * std::log(q) : 0.0;
}

Vec2 ring_point(int k, double s) { return kRing * s * direction_of(k * kPi / 4.0); }

}  // namespace

PatchBox patch_box(const Strand& target, int sample, const LightRules& rules) {
  PatchBox box;
  box.centre = target.points[sample];
  box.s = surround_radius(target.radii[sample], rules.surround_factor, rules.surround_cap);
  const int half = static_cast<int>(std::ceil(box.s)) + 1;
  box.x0 = static_cast<int>(std::floor(box.centre.x())) - half;
  box.y0 = static_cast<int>(std::floor(box.centre.y())) - half;
  box.size = 2 * half + 1;
  return box;
}

LightWarp::LightWarp(const Strand& target, int sample, const PatchBox& box) : box_(box) {
  for (int k = 0; k < kRowPoints; ++k) {
    const int wanted = static_cast<int>(std::lround(box.s * (2.0 * k / (kRowPoints - 1) - 1.0)));
    const int step = std::clamp(sample + wanted, target.first, target.count() - 1) - sample;
    if (steps_.empty() || step != steps_.back()) steps_.push_back(step);
  }
  for (const double side : {0.0, 1.0, -1.0}) {
    for (const int step : steps_) {
      const int t = sample + step;
      controls_.push_back(target.points[t] - box.centre + side * (target.radii[t] + 1.0) * target.normals[t]);
    }
  }
  for (int k = 0; k < kRingPoints; ++k) controls_.push_back(ring_point(k, box.s));

  const int m = static_cast<int>(controls_.size());
  Eigen::MatrixXd system = Eigen::MatrixXd::Zero(m + 3, m + 3);
  for (int i = 0; i < m; ++i) {
    for (int j = 0; j < m; ++j) system(i, j) = kernel((controls_[i] - controls_[j]) / box.s);
    system(i, i) += kSmoothing;
    const Eigen::RowVector3d affine(1.0, controls_[i].x() / box.s, controls_[i].y() / box.s);
    system.block<1, 3>(i, m) = affine;
    system.block<3, 1>(m, i) = affine.transpose();
  }
  Eigen::MatrixXd right = Eigen::MatrixXd::Zero(m + 3, m);
  right.topRows(m).setIdentity();
  const Eigen::MatrixXd weights_from_controls = system.partialPivLu().solve(right);
  grid_ = (box.size - 1) / kGridStep + 2;
  Eigen::MatrixXd basis(grid_ * grid_, m + 3);
  for (int j = 0; j < grid_; ++j) {
    for (int i = 0; i < grid_; ++i) {
      const Vec2 p = Vec2(box.x0 + kGridStep * i, box.y0 + kGridStep * j) - box.centre;
      for (int k = 0; k < m; ++k) basis(j * grid_ + i, k) = kernel((p - controls_[k]) / box.s);
      basis.block<1, 3>(j * grid_ + i, m) = Eigen::RowVector3d(1.0, p.x() / box.s, p.y() / box.s);
    }
  }
  nodes_from_controls_ = basis * weights_from_controls;
}

bool LightWarp::folds(const Eigen::MatrixXd& nodes, const Eigen::Matrix2d& photo_from_target) const {
  const double rigid = photo_from_target.determinant();
  for (int j = 0; j + 1 < grid_; ++j) {
    for (int i = 0; i + 1 < grid_; ++i) {
      const Vec2 p = Vec2(box_.x0 + kGridStep * (i + 0.5), box_.y0 + kGridStep * (j + 0.5)) - box_.centre;
      if (p.norm() > 0.8 * box_.s) continue;
      const int k = j * grid_ + i;
      Eigen::Matrix2d jacobian = photo_from_target;
      jacobian.col(0) += (nodes.row(k + 1) - nodes.row(k)).transpose() / kGridStep;
      jacobian.col(1) += (nodes.row(k + grid_) - nodes.row(k)).transpose() / kGridStep;
      const double area = jacobian.determinant() * rigid;
      if (area < kLeastArea || area > kMostArea) return true;
    }
  }
  return false;
}

std::vector<Eigen::Vector2f> LightWarp::photo_from_canvas(const LightSource& source, const LightMatch& match) const {
  const SourceSpot& spot = source.spots[match.spot];
  const Strand& strand = source.strands[spot.strand];
  const Vec2 centre = strand.points[spot.sample];
  const double mirror = spot.mirrored ? -1.0 : 1.0;
  Eigen::Matrix2d photo_from_target = Eigen::Rotation2Dd(-match.angle).toRotationMatrix();
  photo_from_target.row(0) *= mirror;

  const int row = static_cast<int>(steps_.size()), m = static_cast<int>(controls_.size());
  Eigen::MatrixXd displacement = Eigen::MatrixXd::Zero(m, 2);
  for (int k = 0; k < row; ++k) {
    const int t = std::clamp(spot.sample + steps_[k], 0, strand.count() - 1);
    const Vec2 bank = mirror * (strand.radii[t] + 1.0) * strand.normals[t];
    for (int side = 0; side < 3; ++side) {
      const Vec2 aim = strand.points[t] - centre + (side == 0 ? 0.0 : side == 1 ? 1.0 : -1.0) * bank;
      displacement.row(side * row + k) = (aim - photo_from_target * controls_[side * row + k]).transpose();
    }
  }
  Eigen::MatrixXd nodes = nodes_from_controls_ * displacement;
  for (int tries = 0; tries < kDampings && folds(nodes, photo_from_target); ++tries) nodes *= kDamping;

  std::vector<Eigen::Vector2f> out(static_cast<std::size_t>(box_.size) * box_.size);
  for (int y = 0; y < box_.size; ++y) {
    for (int x = 0; x < box_.size; ++x) {
      const int i = x / kGridStep, j = y / kGridStep, node = j * grid_ + i;
      const double u = static_cast<double>(x % kGridStep) / kGridStep, v = static_cast<double>(y % kGridStep) / kGridStep;
      const Vec2 d = ((1 - v) * ((1 - u) * nodes.row(node) + u * nodes.row(node + 1)) +
                      v * ((1 - u) * nodes.row(node + grid_) + u * nodes.row(node + grid_ + 1))).transpose();
      const Vec2 p = centre + photo_from_target * (Vec2(box_.x0 + x, box_.y0 + y) - box_.centre) + d;
      out[static_cast<std::size_t>(y) * box_.size + x] = p.cast<float>();
    }
  }
  return out;
}

}  // namespace ramify
