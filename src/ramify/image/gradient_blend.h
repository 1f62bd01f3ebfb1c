// SPDX-License-Identifier: GPL-3.0-or-later
// Gradient-domain correction of a hole that was covered patch by patch: steps at seams and at the hole's rim are spread
// out smoothly, and the slow tones are drawn towards given ones (PICTURES 12.1-1). Pixels outside stay as they are.
//
// Solved for the smooth correction m, zero outside the hole:
//   sum over neighbours q of (m_p - m_q - s_pq) + screen (m_p - t_p) = 0,
// where s_pq is what the seam between p and q is off, and t the wanted change of tone; by V-cycles on a pyramid.
#pragma once

#include <functional>

#include "ramify/core/monitor.h"
#include "ramify/image/image.h"

namespace ramify {

struct BlendProblem {
  Mask hole;          // 255 = may change
  ColorImage offset_right;  // s for the edge from (x, y) to (x+1, y): wanted step minus present step; 0 almost everywhere
  ColorImage offset_down;   // the same towards (x, y+1)
  ColorImage tone;          // t, or empty for none
  double screen = 0.0;      // 1/px^2; 1/sqrt(screen) is how far a seam's correction reaches
};

// The correction m; exactly zero outside the hole.
ColorImage solve_blend(const BlendProblem& problem, const Monitor& monitor);

// The smoothest continuation of the picture into the hole (a membrane).
ColorImage membrane(const ColorImage& image, const Mask& hole, const Monitor& monitor);

}  // namespace ramify
