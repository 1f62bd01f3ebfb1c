// SPDX-License-Identifier: GPL-3.0-or-later
// How bright light looks, in pixels and in SVG alike. Private to this layer.
#pragma once

#include <cmath>

namespace ramify {

// Light of strength 1 is all but white, as in a photo of lightning, and nothing is brighter than white: 0..1, linear.
inline float exposed(float light) { return 1.0f - std::exp(-3.0f * light); }

}  // namespace ramify
