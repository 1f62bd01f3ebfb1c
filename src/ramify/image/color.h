// SPDX-License-Identifier: GPL-3.0-or-later
// Colour: sRGB transfer curve (IEC 61966-2-1), luminance, CIE Lab (D65 white).
#pragma once

#include "ramify/image/image.h"

namespace ramify {

// Extended to all reals: negative values mirror, values above 1 go on along the power curve.
float linear_from_srgb(float encoded);
float srgb_from_linear(float linear);
ColorImage linear_from_srgb(const ColorImage& image);
ColorImage srgb_from_linear(const ColorImage& image);

// Rec. 709 luma of the encoded values: 0.2126 r + 0.7152 g + 0.0722 b.
inline float luma(const Rgb& c) { return 0.2126f * c.r + 0.7152f * c.g + 0.0722f * c.b; }
ScalarImage luma(const ColorImage& image);

// L 0..100, a and b about -128..127; the channels of the returned Rgb are L, a, b.
Rgb lab_from_srgb(const Rgb& color);
Rgb srgb_from_lab(const Rgb& lab);
ColorImage lab_from_srgb(const ColorImage& image);

// CIE 1976 difference of two Lab colours.
float delta_e(const Rgb& lab_a, const Rgb& lab_b);

ScalarImage channel(const ColorImage& image, int index);
ColorImage merge_channels(const ScalarImage& r, const ScalarImage& g, const ScalarImage& b);

}  // namespace ramify
