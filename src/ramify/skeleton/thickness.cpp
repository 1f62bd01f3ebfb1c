// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/skeleton/thickness.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "ramify/core/parallel.h"

namespace ramify {
namespace {

// Lower envelope of the parabolas f(q) + (p - q)^2: one line of the squared distance transform.
void transform_line(const std::vector<double>& f, std::vector<double>& d) {
  const int n = static_cast<int>(f.size());
  std::vector<int> v(f.size());
  std::vector<double> z(f.size() + 1);
  int k = 0;
  v[0] = 0;
  z[0] = -1e300;
  z[1] = 1e300;
  for (int q = 1; q < n; ++q) {
    double s;
    for (;;) {
      s = (f[q] + 1.0 * q * q - f[v[k]] - 1.0 * v[k] * v[k]) / (2.0 * q - 2.0 * v[k]);
      if (s > z[k] || k == 0) break;
      --k;
    }
    if (s <= z[k]) {
      v[k] = q;
    } else {
      v[++k] = q;
      z[k] = s;
    }
    z[k + 1] = 1e300;
  }
  k = 0;
  for (int q = 0; q < n; ++q) {
    while (z[k + 1] < q) ++k;
    d[q] = f[v[k]] + 1.0 * (q - v[k]) * (q - v[k]);
  }
}

}  // namespace

ScalarImage distance_inside(const Mask& mask) {
  const int width = mask.width(), height = mask.height();
  const double far = 1.0 * (width + height) * (width + height);
  Image<double> squared(mask.size());
  parallel_for(width, [&](int x) {
    std::vector<double> f(static_cast<std::size_t>(height)), d(f.size());
    for (int y = 0; y < height; ++y) f[y] = mask(x, y) ? far : 0.0;
    transform_line(f, d);
    for (int y = 0; y < height; ++y) squared(x, y) = d[y];
  }, 32);
  ScalarImage distance(mask.size());
  parallel_for(height, [&](int y) {
    std::vector<double> f(squared.row(y), squared.row(y) + width), d(f.size());
    transform_line(f, d);
    for (int x = 0; x < width; ++x) {
      distance(x, y) = mask(x, y) ? static_cast<float>(std::sqrt(std::min(d[x], far)) - 0.5) : 0.0f;
    }
  }, 32);
  return distance;
}

}  // namespace ramify
