// SPDX-License-Identifier: GPL-3.0-or-later
// What each style makes of strokes. Private to this layer.
#pragma once

#include "ramify/paint/paint.h"

namespace ramify {

// A stroke's outline as a shape of few curves; no loops for a stroke that is not born yet.
Shape stroke_shape(const Stroke& stroke, const Rgb& color, double tolerance, double grow = 0.0);

// `strokes` are the scene's at this moment of its growth, `front` is how far growth has come, px.
std::vector<Layer> ink_layers(const PaintScene& scene, const std::vector<Stroke>& strokes, const Monitor& monitor);
std::vector<Layer> vine_layers(const PaintScene& scene, const std::vector<Stroke>& strokes, double front, const Monitor& monitor);
std::vector<Layer> woodcut_layers(const PaintScene& scene, const std::vector<Stroke>& strokes, const Monitor& monitor);
std::vector<Layer> watercolor_layers(const PaintScene& scene, const std::vector<Stroke>& strokes, const Monitor& monitor);
std::vector<Layer> lightning_layers(const PaintScene& scene, const std::vector<Stroke>& strokes, const Monitor& monitor);

}  // namespace ramify
