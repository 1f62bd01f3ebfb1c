// SPDX-License-Identifier: GPL-3.0-or-later
// The far glow of a flash: light scattered by air and lens far beyond the width in which fragments are copied. It is a
// sum of Gaussian blurs of the core's light, with non-negative weights per colour channel fitted on the photo
// (PICTURES 12.3-5), so it can be taken off the old course and put round the new one.
#pragma once

#include <array>
#include <vector>

#include "ramify/image/image.h"

namespace ramify {

inline constexpr std::array<double, 3> kGlowSigmas{10.0, 20.0, 40.0};  // px

struct GlowModel {
  std::array<std::array<double, 3>, 3> weights{};  // [channel][sigma], >= 0; all zero = no glow
};

// core: linear light inside the branches, 0 elsewhere. light: all the light the branches add (linear). Least squares
// over every fourth pixel, weighted; the weight must be 0 on the branches themselves.
GlowModel fit_glow(const ColorImage& core, const ColorImage& light, const ScalarImage& weight);

// Linear light of the glow round `core`.
ColorImage render_glow(const GlowModel& model, const ColorImage& core);

// Factors >= 0, one for each of at most 8 glows, so that their weighted sum is nearest to `light` (linear) where
// `weight` is not 0; what the picture does not tell stays 1.
std::vector<double> fit_gains(const std::vector<ColorImage>& glows, const ColorImage& light, const ScalarImage& weight);

}  // namespace ramify
