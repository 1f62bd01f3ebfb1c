// SPDX-License-Identifier: GPL-3.0-or-later
// Lays the photo's light along new branches: fragment after fragment within a branch, and of two branches at one pixel
// the stronger (PICTURES 12.3-7).
#pragma once

#include <vector>

#include "ramify/compose/light_source.h"
#include "ramify/core/monitor.h"
#include "ramify/core/random.h"

namespace ramify {

struct WovenLight {
  ColorImage value;      // of the layer, on the new canvas
  ScalarImage window;    // 0..1, how much of the copy was laid, open ends faded
  LabelImage owner;      // fragment index, kNone where nothing is laid
  VectorImage source;    // photo px every pixel comes from, NaN where nothing is laid
  int fragments = 0;
};

// targets must have their levels. leave_out: px, sources nearer than this to their own place are banned.
WovenLight weave_light(const LightSource& source, const LightLayer& layer, const std::vector<Strand>& targets, Size size,
                       const LightRules& rules, double leave_out, Rng rng, const Monitor& monitor);

}  // namespace ramify
