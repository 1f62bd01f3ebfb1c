// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "ramify/core/options.h"
#include "ramify/image/color.h"
#include "ramify/paint/drawing.h"
#include "ramify/paint/exposure.h"

namespace ramify {
namespace {

constexpr char kRecipeOpen[] = "<ramify:recipe>", kRecipeClose[] = "</ramify:recipe>";

std::string hex_color(const Rgb& color) {
  char text[8];
  const auto level = [](float v) { return static_cast<unsigned>(std::lround(255.0f * std::clamp(v, 0.0f, 1.0f))); };
  std::snprintf(text, sizeof text, "#%02x%02x%02x", level(color.r), level(color.g), level(color.b));
  return text;
}

// Relative path data in hundredths of a pixel, rounded so that the rounding never adds up.
class PathWriter {
 public:
  std::string text;

  void move(const Vec2& p) {
    const auto [x, y] = whole(p);
    text += "M" + number(x) + "," + number(y);
    at_x_ = x, at_y_ = y;
  }
  void curve(const CubicBezier& c) {
    text += "c";
    for (int i = 1; i < 4; ++i) {
      const auto [x, y] = whole(c[i]);
      text += (i > 1 ? " " : "") + number(x - at_x_) + "," + number(y - at_y_);
      if (i == 3) at_x_ = x, at_y_ = y;
    }
  }

 private:
  static std::pair<long, long> whole(const Vec2& p) {
    return {std::lround(100.0 * (p.x() + 0.5)), std::lround(100.0 * (p.y() + 0.5))};
  }
  static std::string number(long hundredths) { return number_text(static_cast<double>(hundredths) / 100.0); }
  long at_x_ = 0, at_y_ = 0;
};

std::string path_element(const Shape& shape, bool own_color) {
  PathWriter path;
  for (const std::vector<CubicBezier>& loop : shape.loops) {
    if (loop.empty()) continue;
    path.move(loop.front()[0]);
    for (const CubicBezier& curve : loop) path.curve(curve);
    path.text += "z";
  }
  if (path.text.empty()) return "";
  std::string out = "<path";
  if (own_color) out += " fill=\"" + hex_color(shape.color) + "\"";
  if (shape.opacity < 1.0) out += " fill-opacity=\"" + number_text(std::round(1000.0 * shape.opacity) / 1000.0) + "\"";
  return out + " d=\"" + path.text + "\"/>\n";
}

float brightest(const Rgb& color) {
  return linear_from_srgb(std::max({color.r, color.g, color.b}));
}

// Light in a file: how strong a layer's brightest light is, and its shapes as strong as that at most. What blur leaves
// of it in the opacity is made as bright as it looks by the layer's filter; the colour keeps the hue of faint light.
double peak_light(const Layer& layer) {
  double peak = 0.0;
  for (const Shape& shape : layer.shapes) peak = std::max(peak, shape.opacity * brightest(shape.color));
  return peak;
}

Shape glowing(const Shape& shape, double peak) {
  Shape out = shape;
  const float most = brightest(shape.color);
  for (int k = 0; k < 3; ++k)
    out.color[k] = most > 0.0f ? srgb_from_linear(linear_from_srgb(shape.color[k]) / most) : 0.0f;
  out.opacity = peak > 0.0 ? shape.opacity * most / peak : 0.0;
  return out;
}

// A shape that is not blurred is as bright as it looks by itself.
Shape shining(const Shape& shape) {
  Shape out = shape;
  const float strength = static_cast<float>(shape.opacity);
  Rgb seen;
  for (int k = 0; k < 3; ++k) seen[k] = srgb_from_linear(exposed(strength * linear_from_srgb(shape.color[k])));
  const float most = std::max({seen.r, seen.g, seen.b});
  out.color = most > 0.0f ? (1.0f / most) * seen : seen;
  out.opacity = most;
  return out;
}

std::string light_id(std::size_t layer) {
  return "light" + std::to_string(layer + 1);
}

// Opacity 0..1 stands for light 0..peak. Its root first, so that the table is fine where light is faint. Where shapes
// of a layer overlap, or layers, SVG adds more than light does; the exponent takes that back (found on four palettes,
// one bolt).
std::string exposure_table(double peak) {
  constexpr int kSteps = 32;
  std::string out;
  for (int i = 0; i <= kSteps; ++i) {
    const double root = static_cast<double>(i) / kSteps;
    const float seen = std::pow(srgb_from_linear(exposed(static_cast<float>(peak * root * root))), 1.3f);
    out += (i > 0 ? " " : "") + number_text(std::round(1e4 * seen) / 1e4);
  }
  return out;
}

std::string definitions(const Drawing& drawing) {
  std::string out;
  for (std::size_t i = 0; i < drawing.layers.size(); ++i) {
    const Layer& layer = drawing.layers[i];
    if (layer.blend != Blend::Add || layer.blur <= 0.0) continue;
    out += "<filter id=\"" + light_id(i) +
           "\" filterUnits=\"userSpaceOnUse\" color-interpolation-filters=\"sRGB\" x=\"0\" y=\"0\" width=\"" +
           std::to_string(drawing.size.width) + "\" height=\"" + std::to_string(drawing.size.height) +
           "\"><feGaussianBlur stdDeviation=\"" + number_text(std::round(layer.blur * 100.0) / 100.0) +
           "\"/><feComponentTransfer><feFuncA type=\"gamma\" "
           "exponent=\"0.5\"/></feComponentTransfer><feComponentTransfer><feFuncA type=\"table\" tableValues=\"" +
           exposure_table(peak_light(layer)) + "\"/></feComponentTransfer></filter>\n";
  }
  return out.empty() ? "" : "<defs>\n" + out + "</defs>\n";
}

std::string layer_group(Layer layer, std::size_t index) {
  if (layer.blend == Blend::Add) {
    const double peak = peak_light(layer);
    for (Shape& shape : layer.shapes) shape = layer.blur > 0.0 ? glowing(shape, peak) : shining(shape);
  }
  const bool one_color = std::all_of(layer.shapes.begin(), layer.shapes.end(),
                                     [&](const Shape& shape) { return shape.color == layer.shapes.front().color; });
  std::string out = "<g id=\"layer" + std::to_string(index + 1) + "\" inkscape:groupmode=\"layer\" inkscape:label=\"" +
                    layer.name + "\"";
  if (one_color && !layer.shapes.empty()) out += " fill=\"" + hex_color(layer.shapes.front().color) + "\"";
  if (layer.blend == Blend::Add) out += " style=\"mix-blend-mode:screen\"";
  if (layer.blend == Blend::Wash) out += " style=\"mix-blend-mode:multiply\"";
  if (layer.opacity < 1.0) out += " opacity=\"" + number_text(std::round(1000.0 * layer.opacity) / 1000.0) + "\"";
  if (layer.blend == Blend::Add && layer.blur > 0.0) out += " filter=\"url(#" + light_id(index) + ")\"";
  out += ">\n";
  for (const Shape& shape : layer.shapes) out += path_element(shape, !one_color);
  return out + "</g>\n";
}

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) out += c == '<' ? "&lt;" : c == '&' ? "&amp;" : c == '>' ? "&gt;" : std::string(1, c);
  return out;
}

std::string unescaped(std::string text) {
  for (const auto& [from, to] : {std::pair{"&lt;", "<"}, std::pair{"&gt;", ">"}, std::pair{"&amp;", "&"}}) {
    for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + 1)) {
      text.replace(at, std::char_traits<char>::length(from), to);
    }
  }
  return text;
}

}  // namespace

int node_count(const Drawing& drawing) {
  std::size_t count = 0;
  for (const Layer& layer : drawing.layers) {
    for (const Shape& shape : layer.shapes) {
      for (const std::vector<CubicBezier>& loop : shape.loops) count += loop.size();
    }
  }
  return static_cast<int>(count);
}

std::string drawing_svg(const Drawing& drawing, double scale, const std::string& recipe) {
  const std::string w = std::to_string(drawing.size.width), h = std::to_string(drawing.size.height);
  std::string out = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<svg xmlns=\"http://www.w3.org/2000/svg\" "
                    "xmlns:inkscape=\"http://www.inkscape.org/namespaces/inkscape\" "
                    "xmlns:ramify=\"https://ramify.invalid/recipe\" width=\"" + number_text(drawing.size.width * scale) +
                    "\" height=\"" + number_text(drawing.size.height * scale) + "\" viewBox=\"0 0 " + w + " " + h + "\">\n";
  if (!recipe.empty()) out += std::string("<metadata>") + kRecipeOpen + escaped(recipe) + kRecipeClose + "</metadata>\n";
  out += definitions(drawing);
  if (drawing.background) {
    out += "<g id=\"background\" inkscape:groupmode=\"layer\" inkscape:label=\"background\"><rect width=\"" + w +
           "\" height=\"" + h + "\" fill=\"" + hex_color(*drawing.background) + "\"/></g>\n";
  }
  for (std::size_t i = 0; i < drawing.layers.size(); ++i) out += layer_group(drawing.layers[i], i);
  return out + "</svg>\n";
}

std::string recipe_of_svg(const std::string& svg) {
  const std::size_t open = svg.find(kRecipeOpen);
  if (open == std::string::npos) return "";
  const std::size_t begin = open + sizeof kRecipeOpen - 1, end = svg.find(kRecipeClose, begin);
  return end == std::string::npos ? "" : unescaped(svg.substr(begin, end - begin));
}

}  // namespace ramify
