// SPDX-License-Identifier: GPL-3.0-or-later
// Copies of small patches within one picture (ALGORITHMS 7.4a), searched exactly: mean and standard deviation of a copy
// must agree before its pixels are compared.
#include <algorithm>
#include <cmath>
#include <numeric>

#include "ramify/core/parallel.h"
#include "ramify/image/color.h"
#include "ramify/report/picture_figures.h"

namespace ramify {
namespace {

constexpr int kSide = 9;                  // px, of a patch
constexpr int kArea = kSide * kSide;
constexpr float kTextured = 6.0f / 255.0f;
constexpr float kNear = 0.1f;             // r.m.s. difference of a copy, in s.d.
constexpr int kBatch = 50;                // queries between two looks at the monitor

struct Patch {
  float mean = 0.0f, deviation = 0.0f;
  int x = 0, y = 0;  // its corner
};

std::vector<Patch> textured_patches(const ScalarImage& light) {
  const int columns = light.width() - kSide + 1, rows = light.height() - kSide + 1;
  std::vector<Patch> all(static_cast<std::size_t>(std::max(columns, 0)) * static_cast<std::size_t>(std::max(rows, 0)));
  if (all.empty()) return all;
  parallel_for(rows, [&](int y) {
    std::vector<double> sums(light.width(), 0.0), squares(light.width(), 0.0);  // of the nine rows of every column
    for (int x = 0; x < light.width(); ++x) {
      for (int k = 0; k < kSide; ++k) {
        const double v = light(x, y + k);
        sums[x] += v, squares[x] += v * v;
      }
    }
    for (int x = 0; x < columns; ++x) {
      double sum = 0.0, square = 0.0;
      for (int k = 0; k < kSide; ++k) sum += sums[x + k], square += squares[x + k];
      const double mean = sum / kArea, variance = std::max(0.0, square / kArea - mean * mean);
      all[static_cast<std::size_t>(y) * columns + x] = {static_cast<float>(mean), static_cast<float>(std::sqrt(variance)), x, y};
    }
  });
  std::erase_if(all, [](const Patch& p) { return !(p.deviation > kTextured); });
  std::sort(all.begin(), all.end(), [](const Patch& a, const Patch& b) {
    return a.mean != b.mean ? a.mean < b.mean : a.y != b.y ? a.y < b.y : a.x < b.x;
  });
  return all;
}

bool is_copy(const ScalarImage& light, const Patch& a, const Patch& b) {
  const float limit = kNear * kNear * a.deviation * a.deviation * kArea;
  float sum = 0.0f;
  for (int j = 0; j < kSide; ++j) {
    const float* p = light.row(a.y + j) + a.x;
    const float* q = light.row(b.y + j) + b.x;
    for (int i = 0; i < kSide; ++i) sum += (p[i] - q[i]) * (p[i] - q[i]);
    if (sum > limit) return false;
  }
  return true;
}

bool has_copy(const ScalarImage& light, const std::vector<Patch>& patches, const Patch& query) {
  const float reach = kNear * query.deviation;  // |difference of means| and of s.d. are at most the r.m.s. difference
  auto it = std::lower_bound(patches.begin(), patches.end(), query.mean - reach,
                             [](const Patch& p, float mean) { return p.mean < mean; });
  for (; it != patches.end() && it->mean <= query.mean + reach; ++it) {
    if (std::abs(it->deviation - query.deviation) > reach) continue;
    if (std::max(std::abs(it->x - query.x), std::abs(it->y - query.y)) <= kSide) continue;
    if (is_copy(light, query, *it)) return true;
  }
  return false;
}

}  // namespace

double measure_repetition(const ColorImage& color, Rng rng, const Monitor& monitor, int queries) {
  const ScalarImage light = luma(color);
  const std::vector<Patch> patches = textured_patches(light);
  if (patches.empty()) return 0.0;
  std::vector<std::uint8_t> copied(static_cast<std::size_t>(queries), 0);
  for (int start = 0; start < queries; start += kBatch) {
    monitor.report(static_cast<double>(start) / queries);
    parallel_for(std::min(kBatch, queries - start), [&](int k) {
      Rng own = rng.child("query", static_cast<std::uint64_t>(start + k));
      copied[start + k] = has_copy(light, patches, patches[own.below(static_cast<int>(patches.size()))]);
    });
  }
  return std::accumulate(copied.begin(), copied.end(), 0.0) / queries;
}

}  // namespace ramify
