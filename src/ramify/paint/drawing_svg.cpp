// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <set>

#include "ramify/core/options.h"
#include "ramify/paint/drawing.h"

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

std::string blur_id(double sigma) {
  std::string id = "blur" + number_text(std::round(sigma * 100.0) / 100.0);
  std::replace(id.begin(), id.end(), '.', '_');
  return id;
}

std::string definitions(const Drawing& drawing) {
  std::set<double> sigmas;
  for (const Layer& layer : drawing.layers) {
    if (layer.blur > 0.0) sigmas.insert(layer.blur);
  }
  if (sigmas.empty()) return "";
  std::string out = "<defs>\n";
  for (const double sigma : sigmas) {
    out += "<filter id=\"" + blur_id(sigma) + "\" filterUnits=\"userSpaceOnUse\" x=\"0\" y=\"0\" width=\"" +
           std::to_string(drawing.size.width) + "\" height=\"" + std::to_string(drawing.size.height) +
           "\"><feGaussianBlur stdDeviation=\"" + number_text(std::round(sigma * 100.0) / 100.0) + "\"/></filter>\n";
  }
  return out + "</defs>\n";
}

std::string layer_group(const Layer& layer, int index) {
  const bool one_color = std::all_of(layer.shapes.begin(), layer.shapes.end(),
                                     [&](const Shape& shape) { return shape.color == layer.shapes.front().color; });
  std::string out = "<g id=\"layer" + std::to_string(index + 1) + "\" inkscape:groupmode=\"layer\" inkscape:label=\"" +
                    layer.name + "\"";
  if (one_color && !layer.shapes.empty()) out += " fill=\"" + hex_color(layer.shapes.front().color) + "\"";
  if (layer.blend == Blend::Add) out += " style=\"mix-blend-mode:screen\"";
  if (layer.opacity < 1.0) out += " opacity=\"" + number_text(std::round(1000.0 * layer.opacity) / 1000.0) + "\"";
  if (layer.blur > 0.0) out += " filter=\"url(#" + blur_id(layer.blur) + ")\"";
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
  for (std::size_t i = 0; i < drawing.layers.size(); ++i) out += layer_group(drawing.layers[i], static_cast<int>(i));
  return out + "</svg>\n";
}

std::string recipe_of_svg(const std::string& svg) {
  const std::size_t open = svg.find(kRecipeOpen);
  if (open == std::string::npos) return "";
  const std::size_t begin = open + sizeof kRecipeOpen - 1, end = svg.find(kRecipeClose, begin);
  return end == std::string::npos ? "" : unescaped(svg.substr(begin, end - begin));
}

}  // namespace ramify
