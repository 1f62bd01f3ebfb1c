// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/recipe/planning.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "ramify/core/atomic_file.h"
#include "ramify/core/error.h"
#include "ramify/core/parallel.h"
#include "ramify/exemplar/stroke_text.h"
#include "ramify/image/sample.h"
#include "ramify/paint/lettering.h"
#include "ramify/recipe/planning_inputs.h"

namespace ramify {

std::vector<OptionField> describe(LatticeOptions& o) {
  return {
      number("pitch", o.pitch, 0.05, 1000.0, "px", "From node to node of the lattice that paths run on."),
      choice("connectivity", o.connectivity, {"4", "8"}, "Neighbours of a node."),
      number("roughness", o.roughness, 0.0, 1e6, "", "Random share of weights: r of W = 1 + r u; small is straight, large erratic."),
      flag("edge-weights", o.edge_weights, "Every edge has a random weight of its own, as in the paper."),
      choice("edge-cost", o.edge_cost, {"mean", "target"}, "An edge costs the mean of its nodes, or the node it leads to."),
      choice("diagonal", o.diagonal, {"geometric", "none"}, "Diagonals count with their length, or like other edges."),
      number("upward", o.upward, 0.01, 100.0, "", "Growing up costs so many times as much; 3 for lightning."),
      number("sideways", o.sideways, 0.01, 100.0, "", "Growing to the side costs so many times as much; 1.5 for lightning."),
  };
}

std::vector<OptionField> describe(DendriteRequest& r) {
  std::vector<OptionField> out{
      text("size", r.size, "Canvas WIDTHxHEIGHT in px [the mask's, else 512x512]"),
      text("text", r.letters.text, "Letters that paths run in (UTF-8), \\n between lines, instead of a mask."),
      text("font", r.letters.font, "The text's font: a name such as \"DejaVu Sans:bold\" or a font file."),
      number("text-size", r.letters.text_size, 4, 10000, "px", "Size of the text's em."),
      choice("lines", r.lines, {"paths", "distance", "cells"}, "What is drawn: the paths, lines of equal distance from them, or outlines of what is nearest to each root."),
  };
  for (OptionField& field : describe(r.cost_lines)) out.push_back(field);
  for (OptionField& field : describe(r.aggregate)) out.push_back(field);
  for (OptionField& field : describe(r.lattice)) out.push_back(field);
  for (OptionField& field : describe(r.grow)) out.push_back(field);
  for (OptionField& field : describe(r.thickness)) out.push_back(field);
  return out;
}

std::vector<OptionField> describe(StylizeRequest& r) {
  std::vector<OptionField> out{number("scale", r.scale, 0.0, 100.0, "", "Scale the picture first: more pixels, finer lines; 0 = small ones to 1200 px on the longer side.")};
  out.push_back(flag("tree", r.tree, "A painted tree; a picture hides in its twigs."));
  out.push_back(number("layers", r.layers, 1, 100, "", "Trees on one trunk, in numbered files, to paint over one another."));
  out.push_back(text("size", r.size, "Canvas WIDTHxHEIGHT in px of a tree without a picture [900x1100]"));
  for (OptionField& field : describe(r.importance)) out.push_back(field);
  for (OptionField& field : describe(r.stylize)) out.push_back(field);
  for (OptionField& field : describe(r.thickness)) out.push_back(field);
  for (OptionField& field : describe(r.tree_options)) out.push_back(field);
  return out;
}

namespace {

constexpr double kBytesPerNode = 24.0;  // plan, forest, endpoints
constexpr Size kCanvas{512, 512};  // px, when nothing says otherwise

Size canvas_size(const std::string& text) {
  Size size;
  const char* end = text.data() + text.size();
  const auto width = std::from_chars(text.data(), end, size.width);
  if (width.ec == std::errc() && width.ptr != end && *width.ptr == 'x') {
    const auto height = std::from_chars(width.ptr + 1, end, size.height);
    if (height.ec == std::errc() && height.ptr == end && size.width > 0 && size.height > 0) return size;
  }
  throw OptionError("size", "'" + printable(text, 60) + "'", "expected WIDTHxHEIGHT in px, such as 1600x1076");
}

void check_nodes(double width, double height, const LoadLimits& limits) {
  if (width * height > limits.pixels)
    throw LimitError("the lattice would have " + number_text(width * height) + " nodes and need " +
                     number_text(kBytesPerNode * width * height) +
                     " bytes, more than --limit-pixels allows; make the canvas smaller or --pitch larger");
}

void set_nodes(Lattice& lattice, double width, double height, const LoadLimits& limits) {
  check_nodes(width, height, limits);
  lattice.width = std::max(1, static_cast<int>(std::lround(width)));
  lattice.height = std::max(1, static_cast<int>(std::lround(height)));
}

Lattice load_lattice(const DendriteRequest& request, std::uint64_t seed, const Mask& mask) {
  const LatticeOptions& o = request.lattice;
  Lattice lattice;
  lattice.connectivity = o.connectivity == Neighbours::Four ? Connectivity::Plane4 : Connectivity::Plane8;
  lattice.edge_cost = o.edge_cost;
  lattice.diagonal = o.diagonal;
  lattice.direction_factor = growth_direction_factors(lattice.connectivity, o.upward, o.sideways);
  if (!request.node_weights.empty()) {
    const ScalarImage weights = load_scalar(request.node_weights, request.limits);
    set_nodes(lattice, weights.width(), weights.height(), request.limits);
    lattice.weights = weights.pixels();
  } else {
    const Size canvas = !request.size.empty() ? canvas_size(request.size) : !mask.empty() ? mask.size() : kCanvas;
    set_nodes(lattice, canvas.width / o.pitch, canvas.height / o.pitch, request.limits);
    lattice.weights = HashedWeights{Rng(seed).child("lattice").next(), 1.0, o.roughness, o.edge_weights};
  }
  if (!mask.empty()) {
    lattice.allowed = nodes_of_mask(mask, lattice, o.pitch);
    lattice.cut_corners = false;  // paths keep inside thin strokes
  }
  return lattice;
}

std::vector<int> load_generators(const DendriteRequest& request, const Lattice& lattice) {
  const double pitch = request.lattice.pitch;
  if (!request.roots.empty() && !request.generator.empty()) throw OptionError("roots", "", "has no effect with --generator; give one of them");
  if (!request.generator.empty()) return read_generator(request.generator, lattice, pitch, request.limits);
  std::vector<int> out;
  if (!request.roots.empty()) {
    for (const Vec2& point : parse_points("roots", request.roots)) {
      out.push_back(node_of_point(lattice, point, pitch, "roots"));
      if (!is_allowed(lattice, out.back())) throw OptionError("roots", number_text(point.x()) + "," + number_text(point.y()), "lies where no path may run (--mask is black or the weight not positive)");
    }
    return out;
  }
  const bool lightning = request.grow.placement == EndpointPlacement::Lightning, moss = request.grow.placement == EndpointPlacement::Moss;
  if (!lightning && !moss) return middles_of_pieces(lattice);
  for (int x = 0; x < lattice.width; ++x) {
    const int node = lightning ? lattice.node(lattice.width / 2, 0) : lattice.node(x, lattice.height - 1);
    if (is_allowed(lattice, node)) out.push_back(node);
    if (lightning) break;
  }
  if (out.empty()) throw InputError("the mask", "forbids where this placement starts; give --roots or --generator");
  return out;
}

std::vector<int> load_endpoints(const DendriteRequest& request, const Lattice& lattice) {
  std::vector<int> out;
  if (request.endpoints.empty()) return out;
  const bool picture = request.endpoints.size() > 4 && request.endpoints.compare(request.endpoints.size() - 4, 4, ".csv") != 0;
  for (const Vec2& point : picture ? read_dots(request.endpoints, request.limits) : read_points(request.endpoints)) {
    out.push_back(node_of_point(lattice, point, request.lattice.pitch, "endpoints"));
  }
  return out;
}

}  // namespace

std::vector<std::string> input_files(const DendriteRequest& request) {
  std::vector<std::string> out;
  for (const std::string* file : {&request.mask, &request.node_weights, &request.generator, &request.endpoints}) {
    if (!file->empty()) out.push_back(*file);
  }
  return out;
}

DendriteTarget load_dendrite(const DendriteRequest& request, std::uint64_t seed, const Monitor& monitor) {
  monitor.check();
  Mask mask;
  if (!request.mask.empty()) mask = load_mask(request.mask, request.limits);
  if (!request.letters.text.empty()) mask = text_shape(request.letters, find_font(request.letters.font), request.limits);
  DendriteTarget target;
  target.lattice = load_lattice(request, seed, mask);
  check_lattice(target.lattice);
  target.generators = load_generators(request, target.lattice);
  if (target.generators.empty()) throw InputError(request.mask.empty() ? "the lattice" : printable(request.mask, 300), "leaves no node that paths may use");
  target.endpoints = load_endpoints(request, target.lattice);
  return target;
}

void check_dendrite(const DendriteRequest& request) {
  if (!request.letters.text.empty() && !request.mask.empty()) throw OptionError("text", "'" + printable(request.letters.text, 60) + "'", "has no effect with --mask; give one of them");
  if (request.lines != DendriteLines::Paths && request.grow.refine > 1) throw OptionError("refine", std::to_string(request.grow.refine), "has no effect with --lines; only paths are refined");
  if (request.aggregate.walkers == 0) return;
  if (request.lines != DendriteLines::Paths) throw OptionError("lines", "", "has no effect with --walkers");
  for (const std::string* file : {&request.mask, &request.node_weights, &request.generator, &request.endpoints, &request.roots, &request.letters.text}) {
    if (!file->empty()) throw OptionError("walkers", std::to_string(request.aggregate.walkers), "start around the middle of an empty canvas; '" + printable(*file, 60) + "' would have no effect");
  }
}

Skeleton grow_walkers(const DendriteRequest& request, std::uint64_t seed, const Monitor& monitor) {
  const Size canvas = request.size.empty() ? kCanvas : canvas_size(request.size);
  if (static_cast<double>(canvas.width) * canvas.height > request.limits.pixels) throw LimitError("the canvas has more pixels than --limit-pixels");
  return aggregate_skeleton(grow_aggregate(canvas, request.aggregate, Rng(seed).child("walkers"), monitor), request.thickness.tip);
}

Skeleton dendrite_lines(const DendriteRequest& request, const DendriteTarget& target, const Dendrite& dendrite, const Monitor& monitor) {
  const double pitch = request.lattice.pitch;
  switch (request.lines) {
    case DendriteLines::Distance: return distance_lines(dendrite, pitch, request.cost_lines, monitor);
    case DendriteLines::Cells: return cell_outlines(target.lattice, target.generators, pitch, request.cost_lines.radius, monitor);
    case DendriteLines::Paths: break;
  }
  return dendrite_skeleton(dendrite, pitch, request.thickness);
}

std::vector<std::string> input_files(const StylizeRequest& request) {
  std::vector<std::string> out;
  for (const std::string* file : {&request.picture, &request.mask}) {
    if (!file->empty()) out.push_back(*file);
  }
  return out;
}

namespace {

struct ScaledPicture {
  ColorImage color;
  Mask allowed;        // 1 where paths may run; empty = everywhere
  double scale = 1.0;
};

ScaledPicture load_scaled(const StylizeRequest& request) {
  LoadedImage image = load_image(request.picture, request.limits);
  ScaledPicture out{std::move(image.color), {}, 1.0};
  if (!image.alpha.empty()) {
    const float empty = request.importance.light ? 0.0f : 1.0f;  // of no importance
    const Rgb ground{empty, empty, empty};
    for (std::size_t i = 0; i < out.color.pixels().size(); ++i) {
      const float opacity = image.alpha.pixels()[i] / 255.0f;
      out.color.pixels()[i] = opacity * out.color.pixels()[i] + (1.0f - opacity) * ground;
    }
  }
  if (!request.mask.empty()) out.allowed = load_mask(request.mask, request.limits);
  if (!out.allowed.empty() && out.allowed.size() != out.color.size()) {
    throw InputError(printable(request.mask, 300), "has another size than the picture; both must be the same");
  }
  out.scale = request.scale > 0.0 ? request.scale : std::max(1.0, 1200.0 / std::max(out.color.width(), out.color.height()));
  if (out.scale != 1.0) {
    const double width = std::max(1.0, std::round(out.color.width() * out.scale)), height = std::max(1.0, std::round(out.color.height() * out.scale));
    if (width * height > request.limits.pixels) throw LimitError("the scaled picture would have more pixels than --limit-pixels; lower --scale");
    const Size size{static_cast<int>(width), static_cast<int>(height)};
    out.color = resize(out.color, size);
    if (!out.allowed.empty()) out.allowed = resize_nearest(out.allowed, size);
  }
  for (std::uint8_t& pixel : out.allowed.pixels()) pixel = pixel > 127 ? 1 : 0;
  return out;
}

// size: px of the scaled picture.
std::optional<Vec2> root_of(const StylizeRequest& request, double scale, Size size) {
  if (request.root.empty()) return std::nullopt;
  const std::vector<Vec2> points = parse_points("root", request.root);
  if (points.size() != 1) throw OptionError("root", "'" + printable(request.root, 60) + "'", "expected one point \"x,y\"");
  const Vec2 root = points[0] * scale;
  if (root.x() < 0.0 || root.y() < 0.0 || root.x() > size.width - 0.5 || root.y() > size.height - 0.5) {
    throw OptionError("root", "'" + printable(request.root, 60) + "'", "lies outside the picture of " + std::to_string(std::lround(size.width / scale)) +
                      "x" + std::to_string(std::lround(size.height / scale)) + " px");
  }
  return root;
}

void grow_layers(const StylizeRequest& request, double scale, std::uint64_t seed, const Monitor& monitor, StylizedPicture& out) {
  const Size size = !out.importance.empty() ? out.importance.size() : request.size.empty() ? Size{900, 1100} : canvas_size(request.size);
  check_nodes(size.width, size.height, request.limits);
  std::optional<PictureTree> first;
  for (int i = 0; i < request.layers; ++i) {
    const Monitor part = monitor.stage("tree", static_cast<double>(i) / request.layers, static_cast<double>(i + 1) / request.layers);
    PictureTree tree = grow_picture_tree(out.importance, size, root_of(request, scale, size), first ? &*first : nullptr, request.tree_options,
                                         Rng(seed).child("tree", static_cast<std::uint64_t>(i)), part);
    out.layers.push_back(tree.skeleton);
    if (!first) first = std::move(tree);
  }
  out.lattice = first->lattice;
  const PathForest& forest = first->structure.forest;
  out.roots = {forest.nodes.front()};
  for (const int end : first->structure.endpoints) out.endpoints.push_back(forest.nodes[static_cast<std::size_t>(end)]);
  out.structure = std::move(first->structure);
}

}  // namespace

StylizedPicture stylize_picture(const StylizeRequest& request, std::uint64_t seed, const Monitor& monitor) {
  const CancelScope scope(monitor);
  StylizedPicture out;
  ScaledPicture picture;
  if (!request.picture.empty()) {
    picture = load_scaled(request);
    out.importance = importance_map(picture.color, request.importance);
  }
  if (request.tree) {
    grow_layers(request, picture.scale, seed, monitor.stage("trees", 0.1, 1.0), out);
    return out;
  }
  Stylization made = stylize(out.importance, picture.allowed, root_of(request, picture.scale, out.importance.size()), request.stylize, Rng(seed).child("stylize"),
                             monitor.stage("stylize", 0.1, 0.9));
  out.layers.push_back(emphasize(dendrite_skeleton(made.dendrite, 1.0, {}), out.importance, request.thickness));
  out.roots = {made.dendrite.structure.forest.nodes.front()};
  out.endpoints = std::move(made.endpoints);
  out.lattice = std::move(made.dendrite.lattice);
  out.structure = std::move(made.dendrite.structure);
  out.stipples = made.stipples;
  out.threshold = made.threshold;
  return out;
}

void save_lattice_fields(const std::string& folder, const Lattice& lattice, const std::vector<int>& sources,
                         const MetricOptions& metric, const Monitor& monitor) {
  PlanOptions options;
  options.metric = metric;
  const Plan plan = plan_paths(lattice, sources, options, monitor);
  ScalarImage weights(lattice.width, lattice.height, -1.0f), cost(lattice.width, lattice.height, -1.0f);
  for (int node = 0; node < lattice.count(); ++node) {
    const auto i = static_cast<std::size_t>(node);
    if (is_allowed(lattice, node)) weights.pixels()[i] = static_cast<float>(node_weight(lattice, node));
    if (is_reached(plan, node)) cost.pixels()[i] = static_cast<float>(path_cost(plan, node));
  }
  save_scalar(folder + "/weights.tiff", weights);
  save_scalar(folder + "/cost.tiff", cost);
}

void save_endpoints(const std::string& folder, const Lattice& lattice, const std::vector<int>& endpoints, double pitch) {
  std::string text = "x,y\n";
  for (const int node : endpoints) {
    const Vec2 p = point_of_node(lattice, node, pitch);
    text += number_text(p.x()) + "," + number_text(p.y()) + "\n";
  }
  write_file(folder + "/endpoints.csv", text);
}

}  // namespace ramify
