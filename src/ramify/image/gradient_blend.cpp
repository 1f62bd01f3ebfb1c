// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/image/gradient_blend.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "ramify/core/parallel.h"

namespace ramify {
namespace {

// One level of the pyramid: (sum of weights to neighbours + screen) m - sum of weight m_q = rhs on the hole's pixels.
// Neighbours outside the hole count as m = 0, neighbours outside the picture do not count (free border).
struct Level {
  Mask hole;
  ColorImage rhs, m;
  float screen = 0.0f;
};

constexpr std::array<std::array<int, 2>, 4> kNeighbours{{{1, 0}, {-1, 0}, {0, 1}, {0, -1}}};

// Red-black Gauss-Seidel: pixels of one colour do not touch, so rows may run in any order.
void smooth(Level& level, int rounds) {
  const int w = level.hole.width(), h = level.hole.height();
  for (int half = 0; half < 2 * rounds; ++half) {
    parallel_for(h, [&](int y) {
      for (int x = (y + half) & 1; x < w; x += 2) {
        if (!level.hole(x, y)) continue;
        Rgb sum = level.rhs(x, y);
        float weight = level.screen;
        for (const auto& [dx, dy] : kNeighbours) {
          if (!level.hole.contains(x + dx, y + dy)) continue;
          weight += 1.0f;
          sum = sum + level.m(x + dx, y + dy);
        }
        if (weight > 0.0f) level.m(x, y) = (1.0f / weight) * sum;
      }
    }, 16);
  }
}

Rgb residual(const Level& level, int x, int y) {
  Rgb r = level.rhs(x, y);
  const Rgb here = level.m(x, y);
  float weight = level.screen;
  for (const auto& [dx, dy] : kNeighbours) {
    if (!level.hole.contains(x + dx, y + dy)) continue;
    weight += 1.0f;
    r = r + level.m(x + dx, y + dy);
  }
  return r - weight * here;
}

Level coarser(const Level& fine) {
  Level coarse;
  const int w = (fine.hole.width() + 1) / 2, h = (fine.hole.height() + 1) / 2;
  coarse.hole = Mask(w, h, 0);
  coarse.rhs = ColorImage(w, h);
  coarse.m = ColorImage(w, h);
  coarse.screen = 4.0f * fine.screen;
  parallel_for(h, [&](int y) {
    for (int x = 0; x < w; ++x) {
      int open = 0, all = 0;
      Rgb sum{};
      for (int k = 0; k < 4; ++k) {
        const int u = 2 * x + k % 2, v = 2 * y + k / 2;
        if (!fine.hole.contains(u, v)) continue;
        ++all;
        if (fine.hole(u, v)) sum = sum + residual(fine, u, v), ++open;
      }
      // A block with a fixed pixel is fixed as a whole: the correction near the rim is left to the fine level.
      if (open < all) continue;
      coarse.hole(x, y) = 255;
      coarse.rhs(x, y) = (4.0f / all) * sum;
    }
  }, 16);
  return coarse;
}

// m += the coarse correction, bilinear.
void add_correction(Level& fine, const Level& coarse) {
  parallel_for(fine.hole.height(), [&](int y) {
    for (int x = 0; x < fine.hole.width(); ++x) {
      if (!fine.hole(x, y)) continue;
      const int cx = x / 2, cy = y / 2, nx = cx + (x % 2 ? 1 : -1), ny = cy + (y % 2 ? 1 : -1);
      fine.m(x, y) = fine.m(x, y) + 0.5625f * coarse.m.clamped(cx, cy) + 0.1875f * coarse.m.clamped(nx, cy) +
                     0.1875f * coarse.m.clamped(cx, ny) + 0.0625f * coarse.m.clamped(nx, ny);
    }
  }, 16);
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
  const int w = level.hole.width(), h = level.hole.height();
  parallel_for(h, [&](int y) {
    for (int x = 0; x < w; ++x) {
      if (!level.hole(x, y)) continue;
      Rgb f{};
      if (x + 1 < w) f = f - problem.offset_right(x, y);
      if (y + 1 < h) f = f - problem.offset_down(x, y);
      if (x > 0) f = f + problem.offset_right(x - 1, y);
      if (y > 0) f = f + problem.offset_down(x, y - 1);
      if (!problem.tone.empty()) f = f + level.screen * problem.tone(x, y);
      level.rhs(x, y) = f;
    }
  }, 16);
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
  for (int y = 0; y < image.height(); ++y) {
    for (int x = 0; x < image.width(); ++x) {
      if (x + 1 < image.width() && hole(x, y) != hole(x + 1, y)) problem.offset_right(x, y) = known(x + 1, y) - known(x, y);
      if (y + 1 < image.height() && hole(x, y) != hole(x, y + 1)) problem.offset_down(x, y) = known(x, y + 1) - known(x, y);
    }
  }
  // In the hole the present picture is black: offsets at the rim are the full steps, with the known side fixed at zero.
  for (int y = 0; y < image.height(); ++y) {
    for (int x = 0; x < image.width(); ++x) {
      problem.offset_right(x, y) = -1.0f * problem.offset_right(x, y);
      problem.offset_down(x, y) = -1.0f * problem.offset_down(x, y);
    }
  }
  ColorImage out = image;
  const ColorImage m = solve_blend(problem, monitor);
  for (std::size_t i = 0; i < out.pixels().size(); ++i) {
    if (hole.pixels()[i]) out.pixels()[i] = m.pixels()[i];
  }
  return out;
}

}  // namespace ramify
