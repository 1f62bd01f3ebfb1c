// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/geometry/svg_path.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <pugixml.hpp>

#include "ramify/core/error.h"
#include "ramify/core/options.h"

namespace ramify {
namespace {

constexpr std::size_t kMostBytes = 64u << 20;
constexpr double kFarthest = 1e7;  // px; far beyond any picture, far below where doubles lose pixels
constexpr int kDeepest = 256;
using Affine = Eigen::Affine2d;

// Numbers separated by blanks and commas, up to the first thing that is none. "12px" gives 12.
std::vector<double> leading_numbers(std::string_view text) {
  std::vector<double> values;
  for (std::size_t at = 0; (at = text.find_first_not_of(" \t\r\n,", at)) != std::string_view::npos;) {
    double value = 0.0;
    const auto [end, error] = std::from_chars(text.data() + at, text.data() + text.size(), value);
    if (error != std::errc() || !std::isfinite(value)) break;
    values.push_back(value);
    at = static_cast<std::size_t>(end - text.data());
  }
  return values;
}

Affine one_transform(std::string_view name, const std::vector<double>& v, const std::string& file) {
  const std::size_t n = v.size();
  Affine t = Affine::Identity();
  if (name == "matrix" && n == 6) {
    t.matrix() << v[0], v[2], v[4], v[1], v[3], v[5], 0, 0, 1;
  } else if (name == "translate" && (n == 1 || n == 2)) {
    t.translate(Vec2(v[0], n == 2 ? v[1] : 0.0));
  } else if (name == "scale" && (n == 1 || n == 2)) {
    t.scale(Vec2(v[0], n == 2 ? v[1] : v[0]));
  } else if (name == "rotate" && (n == 1 || n == 3)) {
    const Vec2 centre = n == 3 ? Vec2(v[1], v[2]) : Vec2(Vec2::Zero());
    t.translate(centre).rotate(v[0] * kPi / 180.0).translate(-centre);
  } else if (name == "skewX" && n == 1) {
    t.matrix()(0, 1) = std::tan(v[0] * kPi / 180.0);
  } else if (name == "skewY" && n == 1) {
    t.matrix()(1, 0) = std::tan(v[0] * kPi / 180.0);
  } else {
    throw InputError(file, "the transform '" + printable(std::string(name), 40) + "' cannot be read");
  }
  return t;
}

Affine parse_transform(std::string_view text, const std::string& file) {
  Affine all = Affine::Identity();
  for (std::size_t at = 0; (at = text.find_first_not_of(" \t\r\n,", at)) != std::string_view::npos;) {
    const std::size_t open = text.find('(', at), close = text.find(')', at);
    if (open == std::string_view::npos || close == std::string_view::npos || close < open) {
      throw InputError(file, "the transform '" + printable(std::string(text.substr(at)), 40) + "' cannot be read");
    }
    std::string_view name = text.substr(at, open - at);
    while (!name.empty() && name.back() == ' ') name.remove_suffix(1);
    all = all * one_transform(name, leading_numbers(text.substr(open + 1, close - open - 1)), file);
    at = close + 1;
  }
  return all;
}

// A presentation attribute, or the same property inside style="…", which wins.
std::optional<std::string> property(const pugi::xml_node& node, const std::string& name) {
  const std::string style = node.attribute("style").value();
  for (std::size_t at = style.find(name); at != std::string::npos; at = style.find(name, at + 1)) {
    const std::size_t colon = style.find_first_not_of(' ', at + name.size());
    const bool starts = at == 0 || style[at - 1] == ';' || style[at - 1] == ' ';
    if (!starts || colon == std::string::npos || style[colon] != ':') continue;
    const std::size_t begin = style.find_first_not_of(' ', colon + 1);
    if (begin == std::string::npos) break;
    return style.substr(begin, std::min(style.find(';', begin), style.size()) - begin);
  }
  const pugi::xml_attribute attribute = node.attribute(name.c_str());
  return attribute ? std::optional<std::string>(attribute.value()) : std::nullopt;
}

// What an element hands down to its children.
struct Inherited {
  Affine canvas_from_local = Affine::Identity();
  bool stroked = false;
  double stroke_width = 0.0;  // in the local unit
};

Inherited inherit(const pugi::xml_node& node, Inherited from, const std::string& name) {
  if (const auto transform = node.attribute("transform")) {
    from.canvas_from_local = from.canvas_from_local * parse_transform(transform.value(), name);
  }
  if (const auto stroke = property(node, "stroke")) from.stroked = *stroke != "none" && *stroke != "transparent";
  if (const auto width = property(node, "stroke-width")) {
    const auto values = leading_numbers(*width);
    if (!values.empty() && values[0] >= 0.0) from.stroke_width = values[0];
  }
  return from;
}

void add_paths(const pugi::xml_node& node, const Inherited& own, const std::string& name, SvgDrawing& drawing) {
  SvgPath path;
  path.stroked = own.stroked;
  path.stroke_width = own.stroke_width * std::sqrt(std::abs(own.canvas_from_local.linear().determinant()));
  for (const pugi::xml_attribute& attribute : node.attributes()) {
    const std::string key = attribute.name();
    if (key.rfind("data-", 0) == 0) path.attributes.emplace_back(key.substr(5), attribute.value());
  }
  for (auto& points : parse_path_data(node.attribute("d").value(), name)) {
    for (Vec2& p : points) {
      p = own.canvas_from_local * p - Vec2(0.5, 0.5);
      if (!p.allFinite() || p.cwiseAbs().maxCoeff() > kFarthest) {
        throw InputError(name, "a path runs beyond " + number_text(kFarthest) + " px");
      }
    }
    path.points = std::move(points);
    drawing.paths.push_back(path);
  }
}

// The canvas, and the transform that brings its corner to (0, 0).
Affine read_canvas(const pugi::xml_node& svg, SvgDrawing& drawing) {
  const auto box = leading_numbers(svg.attribute("viewBox").value());
  const auto width = leading_numbers(svg.attribute("width").value());
  const auto height = leading_numbers(svg.attribute("height").value());
  Affine corner = Affine::Identity();
  Vec2 size = Vec2::Zero();
  if (box.size() == 4) {
    corner.translate(-Vec2(box[0], box[1]));
    size = {box[2], box[3]};
  } else if (!width.empty() && !height.empty()) {
    size = {width[0], height[0]};
  }
  const auto side = [](double v) { return static_cast<int>(std::clamp(std::round(v), 0.0, 1e9)); };
  drawing.size = {side(size.x()), side(size.y())};
  return corner;
}

bool is_hidden(std::string_view element) {
  for (const char* skipped : {"defs", "symbol", "clipPath", "mask", "marker", "pattern"}) {
    if (element == skipped) return true;
  }
  return false;
}

std::string_view local_name(const pugi::xml_node& node) {
  const std::string_view name = node.name();
  const std::size_t colon = name.find(':');
  return colon == std::string_view::npos ? name : name.substr(colon + 1);
}

}  // namespace

std::string SvgPath::data(std::string_view name) const {
  for (const auto& [key, value] : attributes) {
    if (key == name) return value;
  }
  return "";
}

SvgDrawing parse_svg(std::string_view text, const std::string& name) {
  if (text.size() > kMostBytes) throw LimitError(name + ": SVG larger than 64 MB");
  pugi::xml_document document;
  // parse_minimal: no entity is expanded but the five of XML; document types and processing instructions are skipped.
  const auto parsed = document.load_buffer(text.data(), text.size(), pugi::parse_minimal | pugi::parse_escapes, pugi::encoding_utf8);
  if (!parsed) {
    const auto before = text.substr(0, std::min<std::size_t>(static_cast<std::size_t>(std::max<std::ptrdiff_t>(parsed.offset, 0)), text.size()));
    const auto line = 1 + std::count(before.begin(), before.end(), '\n');
    throw InputError(name + ":" + std::to_string(line), std::string("malformed XML: ") + parsed.description());
  }
  const pugi::xml_node svg = document.document_element();
  if (local_name(svg) != "svg") throw InputError(name, "this is XML, but no SVG");
  SvgDrawing drawing;
  std::vector<Inherited> stack(1);
  stack[0].canvas_from_local = read_canvas(svg, drawing);
  stack[0] = inherit(svg, stack[0], name);
  // A walk without recursion; stack[k] is what the element at depth k hands down.
  pugi::xml_node node = svg.first_child();
  while (node && node != svg) {
    const bool element = node.type() == pugi::node_element && !is_hidden(local_name(node));
    const Inherited own = element ? inherit(node, stack.back(), name) : stack.back();
    if (element && local_name(node) == "path") add_paths(node, own, name, drawing);
    if (element && node.first_child()) {
      if (static_cast<int>(stack.size()) >= kDeepest) throw LimitError(name + ": elements nested deeper than 256");
      stack.push_back(own);
      node = node.first_child();
      continue;
    }
    while (node != svg && !node.next_sibling()) {
      node = node.parent();
      if (node != svg) stack.pop_back();
    }
    if (node != svg) node = node.next_sibling();
  }
  return drawing;
}

}  // namespace ramify
