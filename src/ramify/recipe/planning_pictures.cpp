// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/recipe/planning_pictures.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "ramify/graph/plan.h"
#include "ramify/image/image_io.h"

namespace ramify {
namespace {

constexpr int kContours = 16;
const Rgb kPaper{1.0f, 1.0f, 1.0f}, kInk{0.1f, 0.1f, 0.1f}, kSeed{0.1f, 0.55f, 0.2f}, kEnd{0.85f, 0.1f, 0.1f};

void dot(ColorImage& picture, int node, double radius, const Rgb& color) {
  const int cx = node % picture.width(), cy = node / picture.width(), reach = static_cast<int>(std::ceil(radius));
  for (int y = std::max(0, cy - reach); y <= std::min(picture.height() - 1, cy + reach); ++y) {
    for (int x = std::max(0, cx - reach); x <= std::min(picture.width() - 1, cx + reach); ++x) {
      if (std::hypot(x - cx, y - cy) <= radius) picture(x, y) = color;
    }
  }
}

// The rank of every reached node in the order of the search, 0..1; -1 elsewhere.
ScalarImage search_order(const Plan& plan, const Lattice& lattice) {
  std::vector<int> order;
  for (int node = 0; node < lattice.count(); ++node) {
    if (is_reached(plan, node)) order.push_back(node);
  }
  const bool sums = plan.metric.metric != Metric::Power;
  std::sort(order.begin(), order.end(), [&](int a, int b) {
    const double cost_a = path_cost(plan, a), cost_b = path_cost(plan, b);
    if (cost_a != cost_b) return cost_a < cost_b;
    const double sum_a = sums ? path_sum(plan, a) : 0.0, sum_b = sums ? path_sum(plan, b) : 0.0;
    return sum_a != sum_b ? sum_a < sum_b : a < b;
  });
  ScalarImage out(lattice.width, lattice.height, -1.0f);
  for (std::size_t i = 0; i < order.size(); ++i) {
    out.pixels()[static_cast<std::size_t>(order[i])] = static_cast<float>(i) / static_cast<float>(order.size());
  }
  return out;
}

}  // namespace

ColorImage contour_picture(const Lattice& lattice, const std::vector<int>& sources, const MetricOptions& metric, const Monitor& monitor) {
  PlanOptions options;
  options.metric = metric;
  const ScalarImage order = search_order(plan_paths(lattice, sources, options, monitor), lattice);
  const auto band = [&](int x, int y) { return static_cast<int>(std::floor(kContours * order.clamped(x, y))); };
  ColorImage out(order.size());
  for (int y = 0; y < order.height(); ++y) {
    for (int x = 0; x < order.width(); ++x) {
      if (order(x, y) < 0.0f) continue;
      const bool line = band(x, y) < band(x + 1, y) || band(x, y) < band(x, y + 1) || band(x, y) < band(x - 1, y) || band(x, y) < band(x, y - 1);
      const float level = (1.0f - 0.8f * order(x, y)) * (line ? 0.45f : 1.0f);
      out(x, y) = {level, level, level};
    }
  }
  for (const int source : sources) dot(out, source, 0.006 * std::max(order.width(), order.height()), kSeed);
  return out;
}

ColorImage round_picture(const Structure& structure, Size size, int round, bool done) {
  ColorImage out(size, kPaper);
  const double line = 0.0014 * std::max(size.width, size.height), mark = 0.004 * std::max(size.width, size.height);
  const PathForest& forest = structure.forest;
  const auto round_of = [&](std::size_t i) { return structure.rounds[static_cast<std::size_t>(forest.paths[i])]; };
  const int first = forest.nodes.front();
  for (std::size_t i = 0; i < forest.nodes.size(); ++i) {
    if (round_of(i) < round || (done && round_of(i) == round)) dot(out, forest.nodes[i], line, done ? kInk : kSeed);
  }
  if (done) return out;
  if (round == 0) dot(out, first, 2.0 * mark, kSeed);
  for (const int end : structure.endpoints) {
    const auto i = static_cast<std::size_t>(end);
    if (round_of(i) == round) dot(out, forest.nodes[i], mark, kEnd);
  }
  return out;
}

void save_stylize_intermediates(const std::string& folder, const StylizedPicture& made, const MetricOptions& metric, const Monitor& monitor) {
  if (!made.importance.empty()) save_scalar(folder + "/importance.tiff", made.importance);
  if (made.threshold > 0.0) {
    Mask allowed;
    if (!made.lattice.allowed.empty()) {
      allowed = Mask(made.lattice.width, made.lattice.height);
      allowed.pixels() = made.lattice.allowed;
    }
    StippleOptions options = made.stipples;
    options.keep_cost = true;
    save_scalar(folder + "/stipple_cost.tiff", stipple(made.importance, allowed, made.roots, made.threshold, options, monitor).cost);
  }
  save_endpoints(folder, made.lattice, made.endpoints, 1.0);
  save_lattice_fields(folder, made.lattice, made.roots, metric, monitor);
  save_image(folder + "/contours.png", contour_picture(made.lattice, made.roots, metric, monitor));
  const Size size{made.lattice.width, made.lattice.height};
  const std::vector<int>& rounds = made.structure.rounds;
  const int last = rounds.empty() ? -1 : *std::max_element(rounds.begin(), rounds.end());
  for (int round = 0; round <= last; ++round) {
    const std::string name = std::to_string(round) + ".png";
    save_image(folder + "/seed_" + name, round_picture(made.structure, size, round, false));
    save_image(folder + "/drawn_" + name, round_picture(made.structure, size, round, true));
  }
}

}  // namespace ramify
