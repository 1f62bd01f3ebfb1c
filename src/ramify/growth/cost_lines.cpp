// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/growth/cost_lines.h"

#include <algorithm>
#include <cmath>

#include "ramify/core/error.h"
#include "ramify/graph/second_nearest.h"
#include "ramify/image/contour.h"

namespace ramify {

std::vector<OptionField> describe(CostLineOptions& o) {
  return {
      number("line-count", o.count, 1, 10000, "", "Lines of equal distance."),
      number("line-reach", o.reach, 0.0, 1e6, "nodes", "How far out the last of them lies; 0 = as far as the canvas goes."),
      number("line-radius", o.radius, 0.05, 1000.0, "px", "Half the width of lines."),
  };
}

namespace {

// Contours of a field that has a rim of `rim` nodes more on every side than the lattice.
void append_contours(Skeleton& out, const ScalarImage& field, float level, int rim, double step, double radius, int tag) {
  for (const Contour& contour : trace_contours(field, level)) {
    if (contour.points.size() < 3) continue;
    std::vector<Vec2> points = contour.points;
    if (contour.closed) points.push_back(points.front());
    Node node;
    node.radius = radius;
    node.tag = tag;
    for (const Vec2& p : points) {
      node.position = Vec3((p.x() - rim + 0.5) * step - 0.5, (p.y() - rim + 0.5) * step - 0.5, 0.0);
      node.parent = out.append(node);
    }
  }
}

Skeleton blank(const Lattice& lattice, double step) {
  return Skeleton(Size{static_cast<int>(std::lround(lattice.width * step)), static_cast<int>(std::lround(lattice.height * step))});
}

}  // namespace

Skeleton distance_lines(const Dendrite& dendrite, double pitch, const CostLineOptions& options, const Monitor& monitor) {
  const Lattice& lattice = dendrite.lattice;
  const Plan plan = plan_paths(lattice, dendrite.structure.forest.nodes, {}, monitor.stage("distances", 0.0, 0.7));
  ScalarImage field(lattice.width, lattice.height);
  float farthest = 0.0f;
  for (int node = 0; node < lattice.count(); ++node) {
    if (is_reached(plan, node)) farthest = std::max(farthest, static_cast<float>(path_cost(plan, node)));
  }
  for (int node = 0; node < lattice.count(); ++node) {
    field.pixels()[static_cast<std::size_t>(node)] = is_reached(plan, node) ? static_cast<float>(path_cost(plan, node)) : 2.0f * farthest + 1.0f;
  }
  const double reach = options.reach > 0.0 ? options.reach * cost_per_node(lattice) : farthest;
  const double step = pitch / dendrite.refine;
  Skeleton out = blank(lattice, step);
  for (int i = 1; i <= options.count; ++i) {
    monitor.report(0.7 + 0.3 * i / options.count);
    append_contours(out, field, static_cast<float>(reach * i / (options.count + 1)), 0, step, options.radius, i);
  }
  if (out.empty()) throw InputError("the dendrite", "is nowhere as far away as the first line; lower --line-reach");
  return out;
}

Skeleton cell_outlines(const Lattice& lattice, const std::vector<int>& generators, double pitch, double radius, const Monitor& monitor) {
  const std::vector<int> generator = connected_generators(lattice, generators);
  const int count = 1 + *std::max_element(generator.begin(), generator.end());
  if (count < 2) throw InputError("the generators", "are one; outlines of cells need several that do not touch");
  const Plan plan = plan_paths(lattice, generators, {}, monitor.stage("plan", 0.0, 0.4));
  const TwoNearest nearest = two_nearest(plan, lattice, generator, monitor.stage("second", 0.4, 0.7));
  Skeleton out = blank(lattice, pitch);
  for (int g = 0; g < count; ++g) {
    monitor.report(0.7 + 0.3 * g / count);
    ScalarImage field(lattice.width + 2, lattice.height + 2, -1e6f);
    for (int node = 0; node < lattice.count(); ++node) {
      const auto i = static_cast<std::size_t>(node);
      if (nearest.own[i] == kNone) continue;
      // Without a second generator (another piece of the lattice) a node lies deep inside.
      const double ahead = std::min(second_cost(nearest, node) - path_cost(plan, node), 1e6);
      field(node % lattice.width + 1, node / lattice.width + 1) = static_cast<float>(nearest.own[i] == g ? std::max(ahead, 1e-6) : -std::max(ahead, 1e-6));
    }
    // On the rim the opposite of what lies inside: the outline then runs along the canvas's very edge.
    for (int x = 1; x <= lattice.width; ++x) {
      field(x, 0) = -std::abs(field(x, 1));
      field(x, lattice.height + 1) = -std::abs(field(x, lattice.height));
    }
    for (int y = 1; y <= lattice.height; ++y) {
      field(0, y) = -std::abs(field(1, y));
      field(lattice.width + 1, y) = -std::abs(field(lattice.width, y));
    }
    append_contours(out, field, 0.0f, 1, pitch, radius, g + 1);
  }
  return out;
}

}  // namespace ramify
