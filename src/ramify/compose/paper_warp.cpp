// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/compose/paper_warp.h"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>

namespace ramify {
namespace {

constexpr double kConstraint = 1e4;  // weight of a constraint against a squared Laplacian

void add_product(std::vector<Eigen::Triplet<double>>& entries, const std::vector<std::pair<int, double>>& row, double weight) {
  for (const auto& [i, a] : row) {
    for (const auto& [j, b] : row) entries.emplace_back(i, j, weight * a * b);
  }
}

}  // namespace

std::vector<Vec2> laplacian_displacements(const WarpGrid& grid, std::span<const Vec2> places,
                                          std::span<const Vec2> displacements) {
  const int n = grid.columns * grid.rows;
  std::vector<Eigen::Triplet<double>> entries;
  Eigen::MatrixXd rhs = Eigen::MatrixXd::Zero(n, 2);
  auto at = [&](int x, int y) { return y * grid.columns + x; };
  for (int y = 0; y < grid.rows; ++y) {
    for (int x = 0; x < grid.columns; ++x) {
      std::vector<std::pair<int, double>> row;
      if (x > 0) row.emplace_back(at(x - 1, y), -1.0);
      if (x + 1 < grid.columns) row.emplace_back(at(x + 1, y), -1.0);
      if (y > 0) row.emplace_back(at(x, y - 1), -1.0);
      if (y + 1 < grid.rows) row.emplace_back(at(x, y + 1), -1.0);
      row.emplace_back(at(x, y), static_cast<double>(row.size()));
      add_product(entries, row, 1.0);
    }
  }
  for (std::size_t l = 0; l < places.size(); ++l) {
    const Vec2 u = (places[l] - grid.origin) / grid.step;
    const int x = std::clamp(static_cast<int>(std::floor(u.x())), 0, grid.columns - 2);
    const int y = std::clamp(static_cast<int>(std::floor(u.y())), 0, grid.rows - 2);
    const double fx = u.x() - x, fy = u.y() - y;
    const std::vector<std::pair<int, double>> row = {{at(x, y), (1 - fx) * (1 - fy)},
                                                     {at(x + 1, y), fx * (1 - fy)},
                                                     {at(x, y + 1), (1 - fx) * fy},
                                                     {at(x + 1, y + 1), fx * fy}};
    add_product(entries, row, kConstraint);
    for (const auto& [i, a] : row) rhs.row(i) += kConstraint * a * displacements[l].transpose();
  }
  Eigen::SparseMatrix<double> matrix(n, n);
  matrix.setFromTriplets(entries.begin(), entries.end());
  const Eigen::MatrixXd solution = Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>>(matrix).solve(rhs);
  std::vector<Vec2> result;
  for (int i = 0; i < n; ++i) result.emplace_back(solution.row(i).transpose());
  return result;
}

}  // namespace ramify
