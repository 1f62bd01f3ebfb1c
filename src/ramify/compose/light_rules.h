// SPDX-License-Identifier: GPL-3.0-or-later
// The constants by which light is copied from branch to branch (PICTURES 12.3), one set for each way of compositing.
#pragma once

#include "ramify/compose/compose.h"

namespace ramify {

struct LightRules {
  double surround_factor = 2.0;  // s = r + clamp(factor r, 8, cap) px
  double surround_cap = 40.0;    // px
  double spacing = 0.6;          // centres are (s1 + s2) times this apart
  double tip_fade = 2.0;         // an open end fades over tip_fade * (1 + 1.2 r) px
  double floor = -0.06;          // layer values below are noise or foreign
  double hue = 0.0;              // cost of a change of colour between neighbours, per |log ratio|
  double weak = 0.15;            // branch stretches below this share of the median level are not copied
  int candidates = 6;            // sources kept for every fragment
};
LightRules light_rules(CompositeMode mode);

}  // namespace ramify
