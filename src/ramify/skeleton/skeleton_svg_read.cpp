// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>

#include "ramify/core/error.h"
#include "ramify/core/options.h"
#include "ramify/geometry/segment.h"
#include "ramify/geometry/svg_path.h"
#include "ramify/skeleton/assemble.h"
#include "ramify/skeleton/skeleton_io.h"

namespace ramify {
namespace {

constexpr double kFarthest = 1e7;  // px

std::vector<double> numbers(const std::string& text) {
  std::vector<double> values;
  for (std::size_t at = 0; (at = text.find_first_not_of(' ', at)) != std::string::npos;) {
    const std::size_t end = std::min(text.find(' ', at), text.size());
    double value = 0.0;
    if (!parse_number(text.substr(at, end - at), value)) return {};
    values.push_back(value);
    at = end;
  }
  return values;
}

// One node list entry per number, or false when a file of ours was edited so that its data no longer fit its points.
struct OwnBranch {
  std::vector<int> nodes;
  std::vector<double> radii;
  int parent = kNone;
};
bool own_branch(const SvgPath& path, OwnBranch& branch) {
  const auto nodes = numbers(path.data("nodes")), radii = numbers(path.data("radii")), parent = numbers(path.data("parent"));
  branch = {};
  if (parent.size() == 1) branch.parent = static_cast<int>(parent[0]);
  const std::size_t lead = parent.size();  // the parent's node in front
  if (lead > 1 || nodes.empty() || radii.size() != nodes.size() || path.points.size() != nodes.size() + lead) return false;
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    if (!(nodes[k] >= 0.0 && nodes[k] < 1e9) || !(radii[k] > 0.0 && radii[k] < kFarthest)) return false;
    branch.nodes.push_back(static_cast<int>(nodes[k]));
  }
  branch.radii = radii;
  return true;
}

// A file of ours, whole: every node of 0 … n-1 once. Otherwise false, and the paths are read like anybody's.
bool read_own(const SvgDrawing& drawing, Skeleton& skeleton) {
  std::vector<LooseNode> nodes;
  std::vector<bool> known;
  OwnBranch branch;
  for (const SvgPath& path : drawing.paths) {
    if (!path.stroked || !path.data("loop").empty()) continue;
    if (!own_branch(path, branch)) return false;
    const std::size_t lead = path.points.size() - branch.nodes.size();
    for (std::size_t k = 0; k < branch.nodes.size(); ++k) {
      const std::size_t index = static_cast<std::size_t>(branch.nodes[k]);
      if (index >= 100'000'000 || (index < known.size() && known[index])) return false;
      if (index >= known.size()) known.resize(index + 1, false), nodes.resize(index + 1);
      known[index] = true;
      nodes[index].position = {path.points[k + lead].x(), path.points[k + lead].y(), 0.0};
      nodes[index].radius = branch.radii[k];
      nodes[index].parent = k > 0 ? branch.nodes[k - 1] : branch.parent;
    }
  }
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (!known[i] || nodes[i].parent >= static_cast<int>(i)) return false;
  }
  skeleton = assemble_skeleton(nodes, drawing.size, ContinuationRule::AsListed).skeleton;
  for (const SvgPath& path : drawing.paths) {
    const auto ends = numbers(path.data("loop"));
    const auto valid = [&](double e) { return e >= 0.0 && e < skeleton.count(); };
    if (ends.size() == 2 && valid(ends[0]) && valid(ends[1]) && ends[0] != ends[1]) {
      skeleton.loop_links.emplace_back(static_cast<int>(ends[0]), static_cast<int>(ends[1]));
    }
  }
  return true;
}

// Half the stroke's width; for a path of ours that was edited the mean of the radii it had; 1 px when neither is known.
double path_radius(const SvgPath& path) {
  const auto radii = numbers(path.data("radii"));
  double mean = 0.0;
  for (const double r : radii) mean += r / static_cast<double>(radii.size());
  const double radius = mean > 0.0 ? mean : 0.5 * path.stroke_width;
  return radius > 0.0 ? std::min(radius, kFarthest) : 1.0;
}

// The node of `nodes` that a path starting at `start` springs from: the nearest within its radius (at least 1 px).
int find_parent(const std::vector<LooseNode>& nodes, const Vec2& start) {
  int best = kNone;
  double nearest = 0.0;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const double distance = (nodes[i].position.head<2>() - start).norm();
    if (distance <= std::max(1.0, nodes[i].radius) && (best == kNone || distance < nearest)) {
      best = static_cast<int>(i), nearest = distance;
    }
  }
  return best;
}

constexpr std::size_t kMostForeignWork = 2'000'000'000;  // comparisons of path starts with nodes

}  // namespace

LoadedSkeleton parse_svg_skeleton(std::string_view text, const std::string& name) {
  const SvgDrawing drawing = parse_svg(text, name);
  LoadedSkeleton loaded;
  if (read_own(drawing, loaded.skeleton) && !loaded.skeleton.empty()) return loaded;
  std::vector<LooseNode> nodes;
  std::size_t work = 0;
  int filled = 0;
  for (const SvgPath& path : drawing.paths) {
    if (!path.stroked) {
      ++filled;
      continue;
    }
    if (!path.data("loop").empty()) continue;
    if ((work += nodes.size()) > kMostForeignWork) throw LimitError(name + ": too many paths");
    const int parent = path.points.empty() ? kNone : find_parent(nodes, path.points.front());
    const double radius = path_radius(path);
    int last = parent;
    for (std::size_t k = parent == kNone ? 0 : 1; k < path.points.size(); ++k) {
      nodes.push_back({{path.points[k].x(), path.points[k].y(), 0.0}, radius, last, 0});
      last = static_cast<int>(nodes.size()) - 1;
    }
  }
  if (nodes.empty()) throw InputError(name, "no stroked path in this SVG" + std::string(filled > 0 ? " (only filled ones)" : ""));
  loaded.notes.push_back("read as a drawing: each path is a branch, half its stroke width the radius");
  if (filled > 0) loaded.notes.push_back(std::to_string(filled) + " paths without stroke were left out");
  loaded.skeleton = assemble_skeleton(nodes, drawing.size, ContinuationRule::AsListed).skeleton;
  return loaded;
}

}  // namespace ramify
