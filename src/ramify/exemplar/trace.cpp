// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/exemplar/trace.h"

#include <algorithm>
#include <cmath>

#include "ramify/core/error.h"
#include "ramify/core/parallel.h"
#include "ramify/exemplar/line_finder.h"
#include "ramify/exemplar/photo_surround.h"
#include "ramify/exemplar/region_map.h"
#include "ramify/exemplar/stroke_text.h"
#include "ramify/exemplar/trace_graph.h"
#include "ramify/exemplar/trace_landmark.h"
#include "ramify/exemplar/trace_net.h"
#include "ramify/exemplar/trace_tree.h"
#include "ramify/exemplar/traced_line.h"
#include "ramify/exemplar/width_probe.h"
#include "ramify/image/filter.h"
#include "ramify/skeleton/skeletonize.h"

namespace ramify {
namespace {

constexpr double kSnap = 8.0;       // px, how far a given point may be moved to the ridge (ALGORITHMS 3.1-4)
constexpr double kAttach = 16.0;    // px, strokes starting or ending this near to another one join it
constexpr double kLandmarkCut = 0.35; // of a found landmark's radius: there branches start
constexpr double kRimFade = 5.0;      // px: along a field's rim the light fades, which is no line
constexpr double kStaircase = 2.0;  // px, smoothing that removes the pixel staircase (PICTURES 10)

Mask excluded_pixels(const Photo& photo, const std::vector<Region>& regions) {
  const Image<std::uint8_t> map = region_map(regions, photo.color.size(), photo.alpha);
  Mask excluded(photo.color.size());
  for (std::size_t i = 0; i < map.pixels().size(); ++i) {
    const auto role = static_cast<RegionRole>(map.pixels()[i]);
    excluded.pixels()[i] = role == RegionRole::Habitat || role == RegionRole::Landmark ? 0 : 255;
  }
  return excluded;
}

void draw_path(Mask& lines, const std::vector<Pixel>& path) {
  for (const Pixel& p : path) lines(p.x, p.y) = 255;
}

// The polygon through the points, pixel by pixel.
std::vector<Pixel> straight_path(const std::vector<Vec2>& points, Size size) {
  std::vector<Pixel> path;
  for (const Vec2& p : evenly_spaced(points, 0.5)) {
    const Pixel q{std::clamp(static_cast<int>(std::lround(p.x())), 0, size.width - 1),
                  std::clamp(static_cast<int>(std::lround(p.y())), 0, size.height - 1)};
    if (path.empty() || !(path.back() == q)) path.push_back(q);
  }
  return path;
}

// The drawn pixel nearest to p within kAttach px, or p: strokes that start or end at another stroke join it.
Vec2 attached(const Mask& drawn, const Vec2& p) {
  Vec2 best = p;
  double nearest = kAttach;
  const int cx = static_cast<int>(std::lround(p.x())), cy = static_cast<int>(std::lround(p.y()));
  for (int y = cy - static_cast<int>(kAttach); y <= cy + static_cast<int>(kAttach); ++y) {
    for (int x = cx - static_cast<int>(kAttach); x <= cx + static_cast<int>(kAttach); ++x) {
      const double away = std::hypot(x - p.x(), y - p.y());
      if (!drawn.contains(x, y) || !drawn(x, y) || away >= nearest) continue;
      nearest = away;
      best = Vec2(x, y);
    }
  }
  return best;
}

Mask strokes_as_lines(const RidgeEvidence& evidence, const LatticeCosts& costs, const TraceOptions& options,
                      const Monitor& monitor) {
  Mask drawn(evidence.picture.size());
  for (std::vector<Vec2> stroke : parse_strokes("through", options.through)) {
    const Vec2 first = attached(drawn, stroke.front()), last = attached(drawn, stroke.back());
    if (first != stroke.front()) stroke.insert(stroke.begin(), first);
    if (last != stroke.back()) stroke.push_back(last);
    draw_path(drawn, options.straight ? straight_path(stroke, drawn.size())
                                      : live_wire(evidence, costs, stroke, kSnap, drawn, monitor));
  }
  return drawn;
}

// Lines drawn over each other, one pixel wide again.
Mask united(const Mask& a, const Mask& b, const RidgeEvidence& evidence) {
  Mask both(a.size());
  for (std::size_t i = 0; i < both.pixels().size(); ++i) both.pixels()[i] = a.pixels()[i] || b.pixels()[i] ? 255 : 0;
  return thin_along_crests(both, evidence.field.sato, both);
}

// How sure we are of an edge: mean strength over the strength that starts a line; thick masks and strokes count 1.
double confidence_of(const TraceEdge& edge, const RidgeEvidence& e, const Mask& drawn) {
  double sum = 0.0;
  for (const Vec2& p : edge.line) {
    const int x = static_cast<int>(std::lround(p.x())), y = static_cast<int>(std::lround(p.y()));
    const bool sure = e.thick.clamped(x, y) || drawn.clamped(x, y);
    sum += sure ? 1.0 : std::min(1.0, e.field.strength.clamped(x, y) / e.high);
  }
  return sum / static_cast<double>(edge.line.size());
}

double mean_strength(const TraceEdge& edge, const RidgeEvidence& e) {
  double sum = 0.0;
  for (const Vec2& p : edge.line) {
    sum += e.field.strength.clamped(static_cast<int>(std::lround(p.x())), static_cast<int>(std::lround(p.y())));
  }
  return sum / static_cast<double>(edge.line.size());
}

// Edges that hold no ridge of their own: closed gaps of the domain, rims.
TraceGraph without_weak_edges(const TraceGraph& graph, const RidgeEvidence& e, const Mask& drawn) {
  TraceGraph kept{graph.nodes, {}};
  for (TraceEdge edge : graph.edges) {
    edge.confidence = confidence_of(edge, e, drawn);
    if (edge.confidence >= 1.2 * e.low / e.high || line_length(edge.line) < 4.0) kept.edges.push_back(std::move(edge));
  }
  return kept;
}

// Radii near a junction are those a little way off: there the profile sees the other branches (ALGORITHMS 3.2-6).
void clear_junction_ends(TraceEdge& edge, bool from_junction, bool to_junction) {
  const int n = static_cast<int>(edge.radii.size());
  for (const bool at_from : {true, false}) {
    if (!(at_from ? from_junction : to_junction)) continue;
    const auto at = [&](int i) { return at_from ? i : n - 1 - i; };
    int clear = 0;
    while (clear < n / 3 && (edge.line[at(clear)] - edge.line[at(0)]).norm() < 1.5 * edge.radii[at(clear)] + 2.0) ++clear;
    for (int i = 0; i < clear; ++i) edge.radii[at(i)] = edge.radii[at(clear)];
  }
}

// Smooth centre line and radii of one edge. Inside thick masks the distance to the bank is exact and stays.
void measure_edge(TraceEdge& edge, const RidgeEvidence& e, const TraceOptions& options) {
  edge.line = smoothed(evenly_spaced(edge.line, 1.0), kStaircase);
  const int n = static_cast<int>(edge.line.size());
  std::vector<double> prior;
  std::vector<bool> thick;
  for (const Vec2& p : edge.line) {
    const int x = static_cast<int>(std::lround(p.x())), y = static_cast<int>(std::lround(p.y()));
    prior.push_back(std::max<double>(0.5, e.radius.clamped(x, y)));
    thick.push_back(e.thick.clamped(x, y) != 0);
  }
  prior = smoothed(prior, 2.0);
  WidthProbeOptions probe;
  probe.bright = e.bright;
  probe.glow = e.glow;
  probe.max_radius = std::max(2.0, 1.6 * options.max_radius);
  const ProbedLine probed = probe_widths(e.picture, edge.line, prior, probe);
  std::vector<Vec2> line = edge.line;
  edge.radii = prior;
  for (int i = 0; i < n; ++i) {
    if (thick[i]) continue;
    edge.radii[i] = probed.radii[i];
    if (i > 0 && i + 1 < n) line[i] = probed.points[i];
  }
  edge.line = smoothed(line, kStaircase);
  edge.radii = smoothed(edge.radii, 3.0);
}

void measure_graph(TraceGraph& graph, const RidgeEvidence& evidence, const TraceOptions& options) {
  const auto incident = graph.edges_of_nodes();
  parallel_for(static_cast<int>(graph.edges.size()), [&](int i) {
    TraceEdge& edge = graph.edges[i];
    measure_edge(edge, evidence, options);
    clear_junction_ends(edge, incident[edge.from].size() > 2, incident[edge.to].size() > 2);
  });
}

// Measured lines of the photo.
TraceGraph traced_graph(const Photo& photo, const RidgeEvidence& evidence, const Mask& excluded,
                        const TraceOptions& options, const Monitor& monitor) {
  const LatticeCosts costs = live_wire_costs(evidence);
  const Monitor lines_monitor = monitor.stage("lines", 0.5, 0.8);
  const bool strokes = !options.through.empty(), by_itself = !strokes || options.automatic;
  Mask drawn(photo.color.size()), lines(photo.color.size());
  if (strokes) drawn = strokes_as_lines(evidence, costs, options, lines_monitor);
  if (by_itself) {
    lines = find_lines(evidence, excluded, options, lines_monitor);
    if (options.gap > 0.0) lines = bridge_gaps(evidence, costs, lines, options.gap, lines_monitor);
  }
  lines = united(lines, drawn, evidence);
  const Monitor graph_monitor = monitor.stage("widths", 0.8, 0.95);
  PruneOptions prune;
  prune.min_component = by_itself ? options.min_length : 0.0;
  prune.weak_spur = options.min_length;
  TraceGraph graph = pruned(without_weak_edges(graph_from_lines(lines), evidence, drawn), evidence.radius, prune);
  if (by_itself) {
    for (TraceEdge& e : graph.edges) e.strength = mean_strength(e, evidence);
    graph = pruned(without_net(graph), evidence.radius, prune);
  }
  if (graph.edges.empty()) {
    throw InputError(photo.name, "no branches found; try --polarity, --sensitivity, --max-radius, or give points with "
                                 "--through");
  }
  for (TraceEdge& e : graph.edges) e.confidence = confidence_of(e, evidence, drawn);
  measure_graph(graph, evidence, options);
  graph_monitor.report(1.0);
  return graph;
}

// Branches that start within a found landmark, around its middle: further inside they overlap.
Annotation rooted_on(const Landmark& landmark, const TraceGraph& graph, Size size, std::vector<Region>& regions) {
  std::vector<int> ends;
  const TraceGraph cut = cut_at(graph, landmark.centre, kLandmarkCut * landmark.radius, ends);
  TreeOptions tree;
  for (const int end : ends) tree.roots.push_back(cut.nodes[end]);
  regions.push_back({RegionRole::Landmark, outline_of(landmark)});
  return annotation_from_graph(cut, size, tree);
}

// Points about half a radius apart; junctions, links and ends stay.
Annotation thinned_out(const Annotation& full) {
  Annotation out = full;
  std::vector<std::vector<bool>> needed;
  for (const auto& b : full.branches) needed.emplace_back(b.points.size(), false);
  for (std::size_t b = 0; b < full.branches.size(); ++b) {
    needed[b].front() = needed[b].back() = true;
    if (const auto& p = full.branches[b].parent) needed[p->branch][p->point] = true;
  }
  for (const auto& [a, c] : full.links) needed[a.branch][a.point] = needed[c.branch][c.point] = true;
  std::vector<std::vector<int>> fresh(full.branches.size());
  for (std::size_t b = 0; b < full.branches.size(); ++b) {
    const AnnotatedBranch& from = full.branches[b];
    AnnotatedBranch& to = out.branches[b];
    to.points.clear();
    to.radii.clear();
    double since = 0.0;
    for (std::size_t i = 0; i < from.points.size(); ++i) {
      if (i > 0) since += (from.points[i] - from.points[i - 1]).norm();
      if (needed[b][i] || since >= std::clamp(0.5 * from.radii[i], 2.0, 6.0)) {
        to.points.push_back(from.points[i]);
        to.radii.push_back(from.radii[i]);
        since = 0.0;
      }
      fresh[b].push_back(static_cast<int>(to.points.size()) - 1);
    }
  }
  const auto moved = [&](BranchPoint& p) { p.point = fresh[p.branch][p.point]; };
  for (auto& b : out.branches) {
    if (b.parent) moved(*b.parent);
  }
  for (auto& [a, c] : out.links) {
    moved(a);
    moved(c);
  }
  return out;
}

// Single wide readings beside junctions and knots are not the branch's width: radii may leave the median of their
// neighbourhood by a third only.
void calm_radii(Annotation& annotation) {
  for (AnnotatedBranch& b : annotation.branches) {
    const std::vector<double> measured = b.radii;
    const int n = static_cast<int>(measured.size());
    for (int i = 0; i < n; ++i) {
      const int half = 8 + static_cast<int>(2.0 * std::min(measured[i], 30.0));
      std::vector<double> near(measured.begin() + std::max(0, i - half), measured.begin() + std::min(n, i + half + 1));
      const auto middle = near.begin() + static_cast<std::ptrdiff_t>(near.size() / 2);
      std::nth_element(near.begin(), middle, near.end());
      b.radii[i] = std::clamp(measured[i], 0.67 * *middle, 1.33 * *middle);
    }
    b.radii = smoothed(b.radii, 2.0);
  }
}

void sign_annotation(Annotation& annotation, const Photo& photo, const RidgeEvidence& evidence) {
  annotation.photo_file = photo.name;
  annotation.photo_sha256 = photo.sha256;
  annotation.photo_size = photo.color.size();
  const Polarity polarity = evidence.glow ? Polarity::Glow : evidence.bright ? Polarity::Bright : Polarity::Dark;
  for (AnnotatedBranch& b : annotation.branches) b.polarity = polarity;
}

}  // namespace

std::vector<OptionField> describe(TraceOptions& o) {
  return {
      choice("mode", o.mode, {"auto", "ridge", "mask"}, "How branches are found: ridges, a two-class mask, or both."),
      choice("polarity", o.polarity, {"auto", "dark", "bright", "glow"}, "Branches against their surround."),
      choice("channel", o.channel, {"auto", "L", "a", "b", "R", "G", "B", "pca1", "pca2"},
             "Colour channel in which branches stand out."),
      number("min-radius", o.min_radius, 0.5, 100.0, "px", "Half width of the thinnest branches."),
      number("max-radius", o.max_radius, 0.5, 1000.0, "px", "Half width of the thickest branches found as ridges."),
      number("sensitivity", o.sensitivity, 0.05, 20.0, "", "More finds fainter branches."),
      number("min-length", o.min_length, 1.0, 10000.0, "px", "Shorter pieces are dropped."),
      number("gap", o.gap, 0.0, 50.0, "radii", "Interruptions up to this long are bridged."),
      flag("flatten", o.flatten, "Even out slow changes of tone and contrast first."),
      text("through", o.through, "Strokes to follow by live wire: \"x,y x,y; x,y x,y\" in px."),
      flag("automatic", o.automatic, "With --through: find the other branches as well."),
      flag("straight", o.straight, "With --through: follow the points alone, not the picture."),
      text("root", o.root, "Where the structure starts: \"x,y\" in px, or several points."),
      flag("find-regions", o.find_regions,
           "Without --regions: take a black surround for outside, and within it a spot where thick branches meet for a landmark."),
      text("regions", o.regions, "Polygons \"outside: x,y x,y x,y; keep: …; ignore: …; landmark: …\" in px."),
  };
}

Annotation trace_photo(const Photo& photo, const TraceOptions& options, const Monitor& monitor) {
  const CancelScope scope(monitor);
  TraceOptions checked = options;
  check_options(describe(checked));
  std::vector<Region> regions = parse_regions("regions", options.regions);
  const bool by_itself = options.through.empty() || options.automatic;
  const bool find_regions = options.find_regions && regions.empty() && by_itself;
  if (find_regions) {
    if (auto surround = dark_surround(photo.color)) regions.push_back(std::move(*surround));
  }
  Mask excluded = excluded_pixels(photo, regions);
  if (find_regions && !regions.empty()) excluded = dilate(excluded, kRimFade);
  const RidgeEvidence evidence =
      gather_evidence(photo.color, excluded, options, monitor.stage("ridges", 0.0, 0.5));
  const TraceGraph graph = traced_graph(photo, evidence, excluded, options, monitor);
  TreeOptions tree;
  tree.roots = parse_points("root", options.root);
  if (tree.roots.empty() && !by_itself) tree.roots = {parse_strokes("through", options.through).front().front()};
  const Monitor branches_monitor = monitor.stage("branches", 0.95, 1.0);
  std::optional<Landmark> landmark;
  const bool field = find_regions && !regions.empty();  // elsewhere clouds and knots of water look like landmarks
  if (field && tree.roots.empty()) landmark = find_landmark(photo.color, graph, excluded, branches_monitor);
  Annotation annotation = landmark ? rooted_on(*landmark, graph, photo.color.size(), regions)
                                   : annotation_from_graph(graph, photo.color.size(), tree);
  calm_radii(annotation);
  annotation = thinned_out(annotation);
  sign_annotation(annotation, photo, evidence);
  annotation.regions = std::move(regions);
  return annotation;
}

Annotation remeasure_widths(const Photo& photo, const Annotation& annotation, const TraceOptions& options,
                            const Monitor& monitor) {
  const CancelScope scope(monitor);
  const RidgeEvidence evidence = gather_evidence(photo.color, excluded_pixels(photo, annotation.regions), options,
                                                 monitor.stage("ridges", 0.0, 0.7));
  Annotation out = annotation;
  WidthProbeOptions probe;
  probe.bright = evidence.bright;
  probe.glow = evidence.glow;
  for (AnnotatedBranch& branch : out.branches) {
    monitor.check();
    for (const double r : branch.radii) probe.max_radius = std::max(probe.max_radius, 2.0 * r);
    if (branch.points.size() < 3) continue;
    const ProbedLine probed = probe_widths(evidence.picture, branch.points, branch.radii, probe);
    for (std::size_t i = 0; i < branch.points.size(); ++i) {
      branch.radii[i] = probed.radii[i];
      if (i > 0 && i + 1 < branch.points.size()) branch.points[i] = probed.points[i];
    }
  }
  return out;
}

}  // namespace ramify
