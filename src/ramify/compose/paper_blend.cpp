// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/compose/paper_blend.h"

#include <algorithm>

#include "ramify/image/poisson.h"

namespace ramify {
namespace {

// The Poisson problem of one fragment on its rectangle and one pixel around it.
struct Problem {
  ColorImage values;
  Mask unknown;
  bool any = false;
};

Problem fragment_problem(const PasteCost& cost, const LabelImage& owner, const ColorImage& result, const Mask& placed,
                         const SeamMove& box, bool free_rims) {
  Problem p;
  p.values = ColorImage(box.right - box.left, box.bottom - box.top);
  p.unknown = Mask(p.values.size(), kAbsentPixel);
  for (int y = 0; y < p.values.height(); ++y) {
    for (int x = 0; x < p.values.width(); ++x) {
      const int cx = box.left + x, cy = box.top + y;
      const Rgb* own = cost.color(box.label, cx, cy);
      if (owner(cx, cy) == box.label) {
        p.unknown(x, y) = 255;
        p.values(x, y) = *own;
        p.any = true;
      } else if (placed(cx, cy)) {
        p.unknown(x, y) = 0;
        p.values(x, y) = result(cx, cy);
      } else if (own && !free_rims) {
        p.unknown(x, y) = 0;
        p.values(x, y) = *own;
      }
    }
  }
  return p;
}

ColorGradients own_gradients(const PasteCost& cost, const SeamMove& box) {
  ColorGradients g{ColorImage(box.right - box.left, box.bottom - box.top), ColorImage(box.right - box.left, box.bottom - box.top)};
  for (int y = box.top; y < box.bottom; ++y) {
    for (int x = box.left; x < box.right; ++x) {
      const Rgb* here = cost.color(box.label, x, y);
      const Rgb* right = x + 1 < box.right ? cost.color(box.label, x + 1, y) : nullptr;
      const Rgb* down = y + 1 < box.bottom ? cost.color(box.label, x, y + 1) : nullptr;
      if (here && right) g.right(x - box.left, y - box.top) = *right - *here;
      if (here && down) g.down(x - box.left, y - box.top) = *down - *here;
    }
  }
  return g;
}

}  // namespace

ColorImage blend_in_order(const PasteCost& cost, const LabelImage& owner, const ColorImage& picture, bool free_rims,
                          const Monitor& monitor) {
  ColorImage result = picture;
  Mask placed(picture.size());
  const std::vector<SeamMove> moves = cost.moves();
  for (std::size_t i = 0; i < moves.size(); ++i) {
    monitor.report(static_cast<double>(i) / static_cast<double>(moves.size()));
    const SeamMove& box = moves[i];
    const Problem problem = fragment_problem(cost, owner, result, placed, box, free_rims);
    if (!problem.any) continue;
    const ColorImage solved = solve_poisson(problem.values, problem.unknown, own_gradients(cost, box), monitor);
    for (int y = box.top; y < box.bottom; ++y) {
      for (int x = box.left; x < box.right; ++x) {
        if (owner(x, y) != box.label) continue;
        result(x, y) = solved(x - box.left, y - box.top);
        placed(x, y) = 255;
      }
    }
  }
  return result;
}

}  // namespace ramify
