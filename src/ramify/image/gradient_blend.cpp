// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/image/gradient_blend.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "ramify/core/parallel.h"

namespace ramify {
namespace {

// One level of the pyramid: (sum of weights to neighbours + screen) m - sum of weight m_q = rhs on the hole's pixels.
// Neighbours outside the hole count as m = 0, neighbours outside the picture do not count (free border).
struct Level {
  Mask hole;
  ColorImage rhs, m;
  float screen = 0.0f;
  std::vector<std::array<int, 2>> span;  // of every row: the hole lies in [first, second)

  void find_spans() {
    span.resize(static_cast<std::size_t>(hole.height()));
    for (int y = 0; y < hole.height(); ++y) {
      int first = 0, last = hole.width();
      while (first < last && !hole(first, y)) ++first;
      while (last > first && !hole(last - 1, y)) --last;
      span[y] = {first, last};
    }
  }
  // Rows that are worth a thread.
  int grain() const { return std::max(16, (1 << 14) / std::max(1, hole.width())); }
};

// f(x, neighbours, weight) for the hole's pixels of a row from `from` on, every `step`; what the neighbours add to the
// right side is summed right, left, below, above.
template <class F>
void for_each_open(const Level& level, int y, int from, int step, const F& f) {
  const int w = level.hole.width();
  const std::uint8_t* open = level.hole.row(y);
  const Rgb *row = level.m.row(y), *rhs = level.rhs.row(y);
  const Rgb* above = y > 0 ? level.m.row(y - 1) : nullptr;
  const Rgb* below = y + 1 < level.hole.height() ? level.m.row(y + 1) : nullptr;
  const float inner = level.screen + 1.0f + 1.0f + 1.0f + 1.0f;
  for (int x = from; x < level.span[y][1]; x += step) {
    if (!open[x]) continue;
    if (above && below && x > 0 && x + 1 < w) {
      f(x, rhs[x] + row[x + 1] + row[x - 1] + below[x] + above[x], inner);
      continue;
    }
    Rgb sum = rhs[x];
    float weight = level.screen;
    if (x + 1 < w) weight += 1.0f, sum = sum + row[x + 1];
    if (x > 0) weight += 1.0f, sum = sum + row[x - 1];
    if (below) weight += 1.0f, sum = sum + below[x];
    if (above) weight += 1.0f, sum = sum + above[x];
    f(x, sum, weight);
  }
}

// Red-black Gauss-Seidel: pixels of one colour do not touch, so rows may run in any order.
void smooth(Level& level, int rounds) {
  for (int half = 0; half < 2 * rounds; ++half) {
    parallel_for(
        level.hole.height(),
        [&](int y) {
          const int first = level.span[y][0];
          Rgb* row = level.m.row(y);
          for_each_open(level, y, first + ((first + y + half) & 1), 2, [&](int x, const Rgb& sum, float weight) {
            if (weight > 0.0f) row[x] = (1.0f / weight) * sum;
          });
        },
        level.grain());
  }
}

Level coarser(const Level& fine) {
  Level coarse;
  const int w = (fine.hole.width() + 1) / 2, h = (fine.hole.height() + 1) / 2;
  coarse.hole = Mask(w, h, 0);
  coarse.rhs = ColorImage(w, h);
  coarse.m = ColorImage(w, h);
  coarse.screen = 4.0f * fine.screen;
  parallel_for(
      h,
      [&](int y) {
        Rgb* to = coarse.rhs.row(y);
        std::vector<std::uint8_t> open(static_cast<std::size_t>(w), 0);
        for (int v = 2 * y; v < std::min(2 * y + 2, fine.hole.height()); ++v) {
          const Rgb* here = fine.m.row(v);
          for_each_open(fine, v, fine.span[v][0], 1, [&](int x, const Rgb& sum, float weight) {
            to[x / 2] = to[x / 2] + (sum - weight * here[x]);
            ++open[static_cast<std::size_t>(x / 2)];
          });
        }
        const int high = std::min(2, fine.hole.height() - 2 * y);
        for (int x = 0; x < w; ++x) {
          const int all = high * std::min(2, fine.hole.width() - 2 * x);
          // A block with a fixed pixel is fixed as a whole: the correction near the rim is left to the fine level.
          const bool whole = open[static_cast<std::size_t>(x)] == all;
          coarse.hole(x, y) = whole ? 255 : 0;
          to[x] = whole ? (4.0f / all) * to[x] : Rgb{};
        }
      },
      coarse.grain());
  coarse.find_spans();
  return coarse;
}

// m += the coarse correction, bilinear.
void add_correction(Level& fine, const Level& coarse) {
  parallel_for(
      fine.hole.height(),
      [&](int y) {
        for (int x = fine.span[y][0]; x < fine.span[y][1]; ++x) {
          if (!fine.hole(x, y)) continue;
          const int cx = x / 2, cy = y / 2, nx = cx + (x % 2 ? 1 : -1), ny = cy + (y % 2 ? 1 : -1);
          fine.m(x, y) = fine.m(x, y) + 0.5625f * coarse.m.clamped(cx, cy) + 0.1875f * coarse.m.clamped(nx, cy) +
                         0.1875f * coarse.m.clamped(cx, ny) + 0.0625f * coarse.m.clamped(nx, ny);
        }
      },
      fine.grain());
}

void v_cycle(Level& level) {
  constexpr int kRounds = 2, kSmallest = 4;
  if (std::min(level.hole.width(), level.hole.height()) <= kSmallest) {
    smooth(level, 30);
    return;
  }
  smooth(level, kRounds);
  Level coarse = coarser(level);
  // Residuals of four pixels stand on one coarse pixel whose neighbours are two fine pixels away: the sum of the four
  // is the right side there.
  v_cycle(coarse);
  add_correction(level, coarse);
  smooth(level, kRounds);
}

}  // namespace

ColorImage solve_blend(const BlendProblem& problem, const Monitor& monitor) {
  Level level;
  level.hole = problem.hole;
  level.m = ColorImage(problem.hole.size());
  level.rhs = ColorImage(problem.hole.size());
  level.screen = static_cast<float>(problem.screen);
  level.find_spans();
  const int w = level.hole.width(), h = level.hole.height();
  parallel_for(
      h,
      [&](int y) {
        for (int x = level.span[y][0]; x < level.span[y][1]; ++x) {
          if (!level.hole(x, y)) continue;
          Rgb f{};
          if (x + 1 < w) f = f - problem.offset_right(x, y);
          if (y + 1 < h) f = f - problem.offset_down(x, y);
          if (x > 0) f = f + problem.offset_right(x - 1, y);
          if (y > 0) f = f + problem.offset_down(x, y - 1);
          if (!problem.tone.empty()) f = f + level.screen * problem.tone(x, y);
          level.rhs(x, y) = f;
        }
      },
      16);
  constexpr int kCycles = 5;
  for (int i = 0; i < kCycles; ++i) {
    v_cycle(level);
    monitor.report((i + 1.0) / kCycles);
  }
  return std::move(level.m);
}

ColorImage membrane(const ColorImage& image, const Mask& hole, const Monitor& monitor) {
  BlendProblem problem;
  problem.hole = hole;
  problem.offset_right = ColorImage(image.size());
  problem.offset_down = ColorImage(image.size());
  const auto known = [&](int x, int y) { return hole(x, y) ? Rgb{} : image(x, y); };
  // In the hole the present picture is black: offsets at the rim are the full steps, with the known side fixed at zero.
  parallel_for(
      image.height(),
      [&](int y) {
        for (int x = 0; x < image.width(); ++x) {
          if (x + 1 < image.width() && hole(x, y) != hole(x + 1, y))
            problem.offset_right(x, y) = -1.0f * (known(x + 1, y) - known(x, y));
          if (y + 1 < image.height() && hole(x, y) != hole(x, y + 1))
            problem.offset_down(x, y) = -1.0f * (known(x, y + 1) - known(x, y));
        }
      },
      32);
  ColorImage out = image;
  const ColorImage m = solve_blend(problem, monitor);
  for (std::size_t i = 0; i < out.pixels().size(); ++i) {
    if (hole.pixels()[i]) out.pixels()[i] = m.pixels()[i];
  }
  return out;
}

}  // namespace ramify
