// SPDX-License-Identifier: GPL-3.0-or-later
// What the branches of a photo do to the plate behind them, as a picture that can be cut up and laid elsewhere
// (PICTURES 6, 12.3-4 and 5): light they add (emit) or light they take away, as -log of the transmission (absorb).
#pragma once

#include "ramify/compose/compose.h"
#include "ramify/compose/light_glow.h"
#include "ramify/compose/light_strand.h"
#include "ramify/image/image.h"

namespace ramify {

struct LightLayer {
  CompositeMode mode = CompositeMode::Absorb;  // Emit or Absorb
  bool brighter = false;  // absorb only: the branches are brighter than the plate, the layer is +log(photo / plate)
  ColorImage value;       // strength, larger = more branch; emit: linear light without the far glow, >= 0
  ScalarImage opaque;     // emit: 0..1, how much of what is behind is not seen through a burnt-out core; absorb: empty
  ColorImage glow;        // emit: the photo's far glow, linear; absorb: empty
  GlowModel glow_model;   // emit
  ScalarImage inside;     // absorb: 1 where the value holds the photo's own grain (in the plate's hole), 0 outside it
  std::vector<std::pair<double, double>>
      gain_of_radius;     // emit: how strongly branches glow by their radius (px, ascending), about 1
  ScalarImage glow_gain;  // emit: how much more or less than the model the photo glows there, about 1
};

// photo and plate: sRGB, of one size; strands: the photo's own. Where the plate equals the photo the layer is zero.
LightLayer make_light_layer(const ColorImage& photo, const ColorImage& plate, const std::vector<Strand>& strands,
                            CompositeMode mode, bool brighter);

// How much of a core's own glow goes with it: all of it on the strands' centre lines, none beyond their rims. Soft, for
// where a new branch glows more than the one it was copied from, the difference appears outside the core alone and would
// outline it.
ScalarImage kept_glow_share(const std::vector<Strand>& strands, Size size);

// 1 within the strands' radius, 0 outside, softened by 0.7 px.
ScalarImage core_share(const std::vector<Strand>& strands, Size size);

// A new picture (sRGB, 0..1): the background with `value` laid on. Emit: `core` is the linear light inside the new
// branches, round which the far glow is drawn, `inside` is 1 in the new cores, whose value holds most of the glow, and
// `opaque` hides the background. Absorb: `core` and `opaque` are empty and `inside` says where the value brings its own
// grain, so that the background's is calmed there instead of being seen through it.
ColorImage apply_light(const LightLayer& layer, const ColorImage& background, const ColorImage& value,
                       const ColorImage& core, const ScalarImage& inside, const ScalarImage& opaque);

}  // namespace ramify
