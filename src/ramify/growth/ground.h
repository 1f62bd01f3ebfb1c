// SPDX-License-Identifier: GPL-3.0-or-later
// Where growth may go: canvas, outside regions, obstacles and the painted density map (PICTURES 9).
#pragma once

#include "ramify/growth/grow.h"

namespace ramify {

// A painted value up to this is black: nothing may grow there. Between the 8-bit values 8 and 9, so that no rounding decides.
inline constexpr double kBlack = 8.5 / 255.0;

class Ground {
 public:
  // Keeps a reference to the target. Throws InputError when a map's size is not the canvas's or the canvas is empty.
  explicit Ground(const GrowthTarget& target);

  Size size() const { return target_.size; }
  bool painted() const { return !target_.density.empty(); }
  bool on_canvas(const Vec2& point) const;
  bool inside(const Vec2& point) const;   // on the canvas and in no outside region: otherwise growth leaves
  bool blocked(const Vec2& point) const;  // an obstacle or painted black; false off the canvas
  double wanted(const Vec2& point) const; // painted density 0..1; 1 without a map, 0 off the canvas or outside
  double open_area() const { return open_area_; }  // px^2 that are inside and not blocked

 private:
  const GrowthTarget& target_;
  double open_area_ = 0.0;
};

}  // namespace ramify
