// SPDX-License-Identifier: GPL-3.0-or-later
// What ties a drawing to the painting it stands in. Private to this layer.
#pragma once

#include <string>

#include "ramify/paint/drawing.h"

namespace ramify {

// A picture's darkest tones as a palette's text, from the trunk outwards: the means of its darkest 1, 4 and 12 % of pixels
// by lightness, the lighter ones already mixed with air.
std::string palette_of_photo(const ColorImage& photo);

// Takes the colours of what is drawn from `fill`, whose corner lies at `shift` in the picture, px.
void fill_drawn(Raster& raster, const ColorImage& fill, const Vec2& shift);

// Blurs colour and opacity, sigma in px.
void soften(Raster& raster, double sigma);

// The drawing laid over a picture of its size.
void lay_over(Raster& raster, const ColorImage& ground);

}  // namespace ramify
