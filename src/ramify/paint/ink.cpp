// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>

#include "ramify/paint/palette.h"
#include "ramify/paint/styles.h"

namespace ramify {

Shape stroke_shape(const Stroke& stroke, const Rgb& color, double tolerance, double grow) {
  Shape out;
  out.color = color;
  const std::vector<Vec2> outline = stroke_outline(stroke, grow);
  if (outline.size() < 3) return out;
  const double widest = *std::max_element(stroke.radii.begin(), stroke.radii.end()) + grow;
  FitOptions fit;
  fit.tolerance = std::min(tolerance, std::max(0.02, 0.2 * widest));
  out.loops.push_back(fit_closed_beziers(outline, fit));
  return out;
}

// One layer for every order, main branches on top: what a side branch begins with lies under its parent.
std::vector<Layer> ink_layers(const PaintScene& scene, const std::vector<Stroke>& strokes, const Monitor& monitor) {
  int deepest = 0;
  for (const Stroke& stroke : strokes) deepest = std::max(deepest, stroke.order);
  std::vector<Layer> layers;
  for (int order = deepest; order >= 0; --order) {
    Layer layer;
    layer.name = "order " + std::to_string(order);
    const Rgb color = color_along(scene.colors, deepest > 0 ? static_cast<double>(order) / deepest : 0.0);
    for (const Stroke& stroke : strokes) {
      monitor.check();
      if (stroke.order != order) continue;
      Shape shape = stroke_shape(stroke, color, scene.options.tolerance);
      if (!shape.loops.empty()) layer.shapes.push_back(std::move(shape));
    }
    if (!layer.shapes.empty()) layers.push_back(std::move(layer));
  }
  return layers;
}

}  // namespace ramify
