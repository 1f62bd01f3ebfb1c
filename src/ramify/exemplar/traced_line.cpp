// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/exemplar/traced_line.h"

#include <algorithm>
#include <cmath>

namespace ramify {
namespace {

// Value i of a list continued beyond its ends by point reflection, so that straight ends stay where they are.
template <class T>
T continued(const std::vector<T>& list, int i) {
  const int n = static_cast<int>(list.size());
  if (i < 0) return T(2.0 * list.front() - list[std::min(-i, n - 1)]);
  if (i >= n) return T(2.0 * list.back() - list[std::max(2 * (n - 1) - i, 0)]);
  return list[i];
}

template <class T>
std::vector<T> gaussian_along(const std::vector<T>& list, double sigma, const T& zero) {
  if (list.size() < 3 || sigma <= 0.0) return list;
  const int half = static_cast<int>(std::ceil(3.0 * sigma));
  std::vector<double> weights;
  double total = 0.0;
  for (int k = -half; k <= half; ++k) {
    weights.push_back(std::exp(-0.5 * k * k / (sigma * sigma)));
    total += weights.back();
  }
  std::vector<T> out;
  for (int i = 0; i < static_cast<int>(list.size()); ++i) {
    T sum = zero;
    for (int k = -half; k <= half; ++k) sum += weights[k + half] / total * continued(list, i + k);
    out.push_back(sum);
  }
  return out;
}

}  // namespace

std::vector<Vec2> evenly_spaced(const std::vector<Vec2>& line, double step) {
  double length = 0.0;
  for (std::size_t i = 1; i < line.size(); ++i) length += (line[i] - line[i - 1]).norm();
  const int pieces = std::max(1, static_cast<int>(std::lround(length / step)));
  std::vector<Vec2> out{line.front()};
  double walked = 0.0;
  std::size_t i = 1;
  for (int k = 1; k < pieces; ++k) {
    const double wanted = length * k / pieces;
    while (i + 1 < line.size() && walked + (line[i] - line[i - 1]).norm() < wanted) {
      walked += (line[i] - line[i - 1]).norm();
      ++i;
    }
    const double piece = (line[i] - line[i - 1]).norm();
    out.push_back(line[i - 1] + (piece > 0.0 ? (wanted - walked) / piece : 0.0) * (line[i] - line[i - 1]));
  }
  out.push_back(line.back());
  return out;
}

std::vector<Vec2> smoothed(const std::vector<Vec2>& line, double sigma) {
  std::vector<Vec2> out = gaussian_along<Vec2>(line, sigma, Vec2::Zero());
  out.front() = line.front();
  out.back() = line.back();
  return out;
}

std::vector<double> smoothed(const std::vector<double>& values, double sigma) {
  if (values.size() < 3 || sigma <= 0.0) return values;
  const int half = static_cast<int>(std::ceil(3.0 * sigma)), n = static_cast<int>(values.size());
  std::vector<double> out;
  for (int i = 0; i < n; ++i) {
    double sum = 0.0, total = 0.0;
    for (int k = std::max(0, i - half); k <= std::min(n - 1, i + half); ++k) {
      const double w = std::exp(-0.5 * (k - i) * (k - i) / (sigma * sigma));
      sum += w * values[k];
      total += w;
    }
    out.push_back(sum / total);
  }
  return out;
}

Vec2 tangent_at(const std::vector<Vec2>& line, int i, int reach) {
  const int n = static_cast<int>(line.size());
  const Vec2 d = line[std::min(i + reach, n - 1)] - line[std::max(i - reach, 0)];
  const double length = d.norm();
  return length > 0.0 ? Vec2(d / length) : Vec2(1.0, 0.0);
}

}  // namespace ramify
