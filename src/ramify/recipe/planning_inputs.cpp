// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/recipe/planning_inputs.h"

#include <algorithm>
#include <cmath>
#include <fstream>

#include "ramify/core/error.h"
#include "ramify/core/options.h"
#include "ramify/geometry/svg_path.h"
#include "ramify/image/filter.h"
#include "ramify/recipe/exemplar_source.h"
#include "ramify/skeleton/skeleton_io.h"

namespace ramify {
namespace {

constexpr double kMostPoints = 1e7;

bool ends_with(const std::string& text, const std::string& end) {
  if (text.size() < end.size()) return false;
  return std::equal(end.begin(), end.end(), text.end() - static_cast<std::ptrdiff_t>(end.size()),
                    [](char a, char b) { return a == (b >= 'A' && b <= 'Z' ? b - 'A' + 'a' : b); });
}

std::vector<std::string> split(const std::string& line) {
  std::vector<std::string> out;
  std::string word;
  for (const char c : line + " ") {
    if (c == ',' || c == ';' || c == ' ' || c == '\t' || c == '\r') {
      if (!word.empty()) out.push_back(word);
      word.clear();
    } else {
      word += c;
    }
  }
  return out;
}

// Every node that the segment passes, by steps of less than a node.
void mark_segment(const Lattice& lattice, const Vec2& a, const Vec2& b, double pitch, std::vector<std::uint8_t>& marked) {
  const int steps = 1 + static_cast<int>(std::min(1e6, 2.0 * (b - a).norm() / pitch));
  for (int i = 0; i <= steps; ++i) {
    const Vec2 p = a + (b - a) * (static_cast<double>(i) / steps);
    const int x = static_cast<int>(std::floor((p.x() + 0.5) / pitch)), y = static_cast<int>(std::floor((p.y() + 0.5) / pitch));
    if (lattice.contains(x, y)) marked[static_cast<std::size_t>(lattice.node(x, y))] = 1;
  }
}

}  // namespace

int node_of_point(const Lattice& lattice, const Vec2& point, double pitch, const std::string& option) {
  const double x = std::floor((point.x() + 0.5) / pitch), y = std::floor((point.y() + 0.5) / pitch);
  if (!(x >= 0.0 && y >= 0.0 && x < lattice.width && y < lattice.height)) {
    throw OptionError(option, number_text(point.x()) + "," + number_text(point.y()),
                      "lies outside the canvas of " + number_text(lattice.width * pitch) + "x" + number_text(lattice.height * pitch) + " px");
  }
  return lattice.node(static_cast<int>(x), static_cast<int>(y));
}

Vec2 point_of_node(const Lattice& lattice, int node, double pitch) {
  return {(node % lattice.width + 0.5) * pitch - 0.5, (node / lattice.width + 0.5) * pitch - 0.5};
}

std::vector<Vec2> read_points(const std::string& path) {
  std::ifstream file(path);
  if (!file) throw InputError(printable(path, 300), "cannot be opened");
  std::vector<Vec2> out;
  std::string line;
  bool heading_allowed = true;
  for (int number = 1; std::getline(file, line); ++number) {
    const std::vector<std::string> words = split(line);
    if (words.empty() || words[0][0] == '#') continue;
    Vec2 point;
    if (words.size() >= 2 && parse_number(words[0], point.x()) && parse_number(words[1], point.y())) {
      out.push_back(point);
    } else if (!heading_allowed) {
      throw InputError(printable(path, 300) + ":" + std::to_string(number), "expected \"x,y\" in px, found '" + printable(line, 60) + "'");
    }
    heading_allowed = false;
    if (static_cast<double>(out.size()) > kMostPoints) throw LimitError(printable(path, 300) + " holds more than 1e7 points");
  }
  if (out.empty()) throw InputError(printable(path, 300), "holds no point; expected lines of \"x,y\" in px");
  return out;
}

std::vector<Vec2> read_dots(const std::string& path, const LoadLimits& limits) {
  Mask mask = load_mask(path, limits);
  for (std::uint8_t& pixel : mask.pixels()) pixel = pixel > 127 ? 255 : 0;
  int count = 0;
  const LabelImage labels = label_components(mask, true, count);
  if (count == 0) throw InputError(printable(path, 300), "shows no white dot; expected one for every endpoint");
  std::vector<Vec2> sums(static_cast<std::size_t>(count), Vec2::Zero());
  std::vector<int> pixels(static_cast<std::size_t>(count), 0);
  for (int y = 0; y < mask.height(); ++y) {
    for (int x = 0; x < mask.width(); ++x) {
      if (labels(x, y) == kNone) continue;
      sums[static_cast<std::size_t>(labels(x, y))] += Vec2(x, y);
      ++pixels[static_cast<std::size_t>(labels(x, y))];
    }
  }
  for (std::size_t i = 0; i < sums.size(); ++i) sums[i] /= pixels[i];
  return sums;
}

std::vector<std::uint8_t> nodes_of_mask(const Mask& mask, const Lattice& lattice, double pitch) {
  std::vector<std::uint8_t> out(static_cast<std::size_t>(lattice.count()));
  for (int node = 0; node < lattice.count(); ++node) {
    const Vec2 p = point_of_node(lattice, node, pitch);
    out[static_cast<std::size_t>(node)] = mask.clamped(static_cast<int>(std::lround(p.x())), static_cast<int>(std::lround(p.y()))) > 127 ? 1 : 0;
  }
  return out;
}

std::vector<int> read_generator(const std::string& path, const Lattice& lattice, double pitch, const LoadLimits& limits) {
  std::vector<std::uint8_t> marked(static_cast<std::size_t>(lattice.count()), 0);
  if (ends_with(path, ".swc") || ends_with(path, ".svg") || ends_with(path, ".geojson") || is_json_file(path)) {
    const Skeleton skeleton = load_skeleton(path).skeleton;
    for (const Node& node : skeleton.nodes()) {
      mark_segment(lattice, node.parent == kNone ? node.xy() : skeleton[node.parent].xy(), node.xy(), pitch, marked);
    }
  } else {
    marked = nodes_of_mask(load_mask(path, limits), lattice, pitch);
  }
  std::vector<int> out;
  for (int node = 0; node < lattice.count(); ++node) {
    if (marked[static_cast<std::size_t>(node)] != 0 && is_allowed(lattice, node)) out.push_back(node);
  }
  if (out.empty()) throw InputError(printable(path, 300), "no part of the generator lies where paths may run");
  return out;
}

std::vector<int> middles_of_pieces(const Lattice& lattice) {
  Mask allowed(lattice.width, lattice.height, 0);
  for (int node = 0; node < lattice.count(); ++node) allowed.pixels()[static_cast<std::size_t>(node)] = is_allowed(lattice, node) ? 255 : 0;
  int count = 0;
  const LabelImage labels = label_components(allowed, lattice.connectivity == Connectivity::Plane8 && lattice.cut_corners, count);
  std::vector<Vec2> middles(static_cast<std::size_t>(count), Vec2::Zero());
  std::vector<int> sizes(static_cast<std::size_t>(count), 0);
  const auto label_of = [&](int node) { return labels.pixels()[static_cast<std::size_t>(node)]; };
  for (int node = 0; node < lattice.count(); ++node) {
    if (label_of(node) == kNone) continue;
    middles[static_cast<std::size_t>(label_of(node))] += point_of_node(lattice, node, 1.0);
    ++sizes[static_cast<std::size_t>(label_of(node))];
  }
  std::vector<int> best(static_cast<std::size_t>(count), kNone);
  std::vector<double> distance(static_cast<std::size_t>(count), 0.0);
  for (int node = 0; node < lattice.count(); ++node) {
    if (label_of(node) == kNone) continue;
    const auto i = static_cast<std::size_t>(label_of(node));
    const double d = (point_of_node(lattice, node, 1.0) - middles[i] / sizes[i]).squaredNorm();
    if (best[i] != kNone && d >= distance[i]) continue;
    best[i] = node;
    distance[i] = d;
  }
  return best;
}

}  // namespace ramify
