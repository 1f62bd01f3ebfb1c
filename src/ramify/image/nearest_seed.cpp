// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/image/nearest_seed.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "ramify/core/parallel.h"

namespace ramify {
namespace {

constexpr int kFarRow = 1 << 28;

// For every pixel the row of the nearest seed of its column, or one far away. Rows are walked so that memory is read in
// order.
void nearest_in_columns(const LabelImage& seed_at, Image<std::int32_t>& row_of) {
  const int width = seed_at.width(), height = seed_at.height();
  constexpr int kStrip = 256;  // columns
  parallel_for((width + kStrip - 1) / kStrip, [&](int strip) {
    const int x0 = strip * kStrip, count = std::min(width, x0 + kStrip) - x0;
    std::vector<std::int32_t> last(static_cast<std::size_t>(count), -kFarRow);
    for (int y = 0; y < height; ++y) {
      const std::int32_t* seeds = seed_at.row(y) + x0;
      std::int32_t* rows = row_of.row(y) + x0;
      for (int i = 0; i < count; ++i) rows[i] = last[i] = seeds[i] != kNone ? y : last[i];
    }
    std::fill(last.begin(), last.end(), kFarRow);
    for (int y = height - 1; y >= 0; --y) {
      const std::int32_t* seeds = seed_at.row(y) + x0;
      std::int32_t* rows = row_of.row(y) + x0;
      for (int i = 0; i < count; ++i) {
        last[i] = seeds[i] != kNone ? y : last[i];
        rows[i] = last[i] - y < y - rows[i] ? last[i] : rows[i];
      }
    }
  });
}

// The lower envelope of a row's parabolas: the column each comes from, its height there in squared px, and where it
// becomes the lowest.
struct Envelope {
  explicit Envelope(int width) : column(width), height(width), from(width), half_inverse(width + 1, 0.0) {
    for (int d = 1; d <= width; ++d) half_inverse[d] = 0.5 / d;
  }

  void add(int x, double own) {
    double start = -1e18;
    while (count > 0) {
      const int c = column[count - 1];
      // Where both are equally high: ((own + x^2) - (height + c^2)) / (2 (x - c)).
      start = (own - height[count - 1]) * half_inverse[x - c] + 0.5 * (x + c);
      if (start > from[count - 1]) break;
      --count;
      start = -1e18;
    }
    column[count] = x;
    height[count] = own;
    from[count] = start;
    ++count;
  }

  std::vector<int> column;
  std::vector<double> height, from, half_inverse;
  int count = 0;
};

}  // namespace

LabelImage nearest_seeds(const std::vector<std::pair<int, int>>& seeds, Size size) {
  LabelImage seed_at(size, kNone), out(size, kNone);
  if (seeds.empty()) return out;
  for (int i = static_cast<int>(seeds.size()) - 1; i >= 0; --i) seed_at(seeds[i].first, seeds[i].second) = i;
  Image<std::int32_t> row_of(size);
  nearest_in_columns(seed_at, row_of);
  constexpr int kRows = 32;
  parallel_for((size.height + kRows - 1) / kRows, [&](int strip) {
    Envelope envelope(size.width);
    for (int y = strip * kRows; y < std::min(size.height, (strip + 1) * kRows); ++y) {
      const std::int32_t* rows = row_of.row(y);
      envelope.count = 0;
      for (int x = 0; x < size.width; ++x) {
        const double dy = rows[x] - y;
        if (std::abs(rows[x]) < kFarRow) envelope.add(x, dy * dy);
      }
      int k = 0;
      for (int x = 0; x < size.width;) {
        while (k + 1 < envelope.count && envelope.from[k + 1] <= x) ++k;
        const int until = k + 1 < envelope.count ? std::min(size.width, static_cast<int>(std::ceil(envelope.from[k + 1]))) : size.width;
        const int column = envelope.column[k];
        std::fill(out.row(y) + x, out.row(y) + until, seed_at(column, rows[column]));
        x = until;
      }
    }
  });
  return out;
}

}  // namespace ramify
