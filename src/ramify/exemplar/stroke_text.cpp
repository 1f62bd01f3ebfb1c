// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/exemplar/stroke_text.h"

#include <sstream>

#include "ramify/core/error.h"
#include "ramify/core/options.h"

namespace ramify {
namespace {

std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> pieces;
  std::string piece;
  std::istringstream in(text);
  while (std::getline(in, piece, separator)) pieces.push_back(piece);
  return pieces;
}

bool blank(const std::string& text) { return text.find_first_not_of(" \t\r\n") == std::string::npos; }

}  // namespace

std::vector<Vec2> parse_points(const std::string& option, const std::string& text) {
  std::vector<Vec2> points;
  std::istringstream in(text);
  for (std::string word; in >> word;) {
    const auto comma = word.find(',');
    Vec2 p;
    if (comma == std::string::npos || !parse_number(word.substr(0, comma), p.x()) ||
        !parse_number(word.substr(comma + 1), p.y())) {
      throw OptionError(option, printable(word, 40), "not a point; write x,y in pixels, points separated by blanks");
    }
    points.push_back(p);
  }
  return points;
}

std::vector<std::vector<Vec2>> parse_strokes(const std::string& option, const std::string& text) {
  std::vector<std::vector<Vec2>> strokes;
  for (const std::string& piece : split(text, ';')) {
    if (blank(piece)) continue;
    strokes.push_back(parse_points(option, piece));
    if (strokes.back().size() < 2) throw OptionError(option, printable(piece, 40), "a stroke needs two points or more");
  }
  return strokes;
}

std::vector<WideStroke> parse_wide_strokes(const std::string& option, const std::string& text) {
  std::vector<WideStroke> strokes;
  for (const std::string& piece : split(text, ';')) {
    if (blank(piece)) continue;
    WideStroke stroke;
    std::istringstream in(piece);
    for (std::string word; in >> word;) {
      const auto first = word.find(','), second = first == std::string::npos ? first : word.find(',', first + 1);
      stroke.points.push_back(parse_points(option, word.substr(0, second)).front());
      if (second == std::string::npos) continue;
      double radius = 0.0;
      if (!parse_number(word.substr(second + 1), radius) || !(radius > 0.0)) {
        throw OptionError(option, printable(word, 40), "not a point; write x,y or x,y,radius in pixels");
      }
      stroke.radii.push_back(radius);
    }
    if (stroke.points.size() < 2) throw OptionError(option, printable(piece, 40), "a stroke needs two points or more");
    if (!stroke.radii.empty() && stroke.radii.size() != stroke.points.size()) {
      throw OptionError(option, printable(piece, 40), "give a stroke's radius at all of its points or at none");
    }
    strokes.push_back(std::move(stroke));
  }
  return strokes;
}

std::vector<Region> parse_regions(const std::string& option, const std::string& text) {
  static const std::vector<std::string> names{"ignore", "outside", "keep", "landmark", "habitat"};
  std::vector<Region> regions;
  for (const std::string& piece : split(text, ';')) {
    if (blank(piece)) continue;
    const auto colon = piece.find(':');
    std::string role = colon == std::string::npos ? "" : piece.substr(0, colon);
    role.erase(0, role.find_first_not_of(" \t\r\n"));
    Region region;
    std::size_t k = 0;
    while (k < names.size() && names[k] != role) ++k;
    if (k == names.size()) {
      throw OptionError(option, printable(piece, 40), "start a region with ignore:, outside:, keep:, landmark: or habitat:");
    }
    region.role = static_cast<RegionRole>(k);
    region.polygon = parse_points(option, piece.substr(colon + 1));
    if (region.polygon.size() < 3) throw OptionError(option, printable(piece, 40), "a polygon needs three points or more");
    regions.push_back(std::move(region));
  }
  return regions;
}

}  // namespace ramify
