// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/exemplar/trace.h"

#include <algorithm>
#include <cmath>

#include "ramify/core/error.h"
#include "ramify/core/parallel.h"
#include "ramify/exemplar/drawn_strokes.h"
#include "ramify/exemplar/line_finder.h"
#include "ramify/exemplar/photo_surround.h"
#include "ramify/exemplar/region_map.h"
#include "ramify/exemplar/stroke_text.h"
#include "ramify/exemplar/trace_cleaning.h"
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

constexpr double kLandmarkCut = 0.35;  // of a found landmark's radius: there branches start
constexpr double kRimFade = 5.0;       // px: along a field's rim the light fades, which is no line
constexpr double kStaircase = 2.0;     // px, smoothing that removes the pixel staircase (PICTURES 10)

Mask excluded_pixels(const Photo& photo, const std::vector<Region>& regions) {
  const Image<std::uint8_t> map = region_map(regions, photo.color.size(), photo.alpha);
  Mask excluded(photo.color.size());
  for (std::size_t i = 0; i < map.pixels().size(); ++i) {
    const auto role = static_cast<RegionRole>(map.pixels()[i]);
    excluded.pixels()[i] = role == RegionRole::Habitat || role == RegionRole::Landmark ? 0 : 255;
  }
  return excluded;
}

Mask joined(Mask a, const Mask& b) {
  for (std::size_t i = 0; i < a.pixels().size(); ++i) a.pixels()[i] = a.pixels()[i] || b.pixels()[i] ? 255 : 0;
  return a;
}

// Lines drawn over each other, one pixel wide again.
Mask united(const Mask& a, const Mask& b, const RidgeEvidence& evidence) {
  const Mask both = joined(a, b);
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
    while (clear < n / 3 && (edge.line[at(clear)] - edge.line[at(0)]).norm() < 1.5 * edge.radii[at(clear)] + 2.0)
      ++clear;
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

// Measured lines of the photo. What wide strokes tell of thickness is added to the evidence.
TraceGraph traced_graph(const Photo& photo, RidgeEvidence& evidence, const Mask& excluded, const TraceOptions& options,
                        const Monitor& monitor) {
  const LatticeCosts costs = live_wire_costs(evidence);
  const Monitor lines_monitor = monitor.stage("lines", 0.5, 0.8);
  const bool strokes = !options.through.empty(), by_itself = !strokes || options.automatic;
  const DrawnStrokes along =
      strokes ? draw_strokes(evidence, costs, options, lines_monitor) : no_strokes(photo.color.size());
  const Mask& drawn = along.lines;
  Mask lines(photo.color.size());
  if (by_itself) {
    leave_out(evidence, along);
    lines = find_lines(evidence, joined(excluded, along.wide), options, lines_monitor);
    if (options.gap > 0.0) lines = bridge_gaps(evidence, costs, lines, options.gap, lines_monitor);
    join_at_banks(lines, along);
  }
  take_in(evidence, along);
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
    throw InputError(photo.name,
                     "no branches found; try --polarity, --sensitivity, --max-radius, or give points with "
                     "--through");
  }
  for (TraceEdge& e : graph.edges) e.confidence = confidence_of(e, evidence, drawn);
  measure_graph(graph, evidence, options);
  graph_monitor.report(1.0);
  return graph;
}

// The radii given at points along a line, in between by distance along it.
std::vector<double> radii_along(const std::vector<Vec2>& line, const WideStroke& given) {
  std::vector<int> at;  // index into the line
  for (const Vec2& p : given.points) {
    int best = at.empty() ? 0 : at.back();
    for (int i = best; i < static_cast<int>(line.size()); ++i) {
      if ((line[i] - p).norm() < (line[best] - p).norm()) best = i;
    }
    at.push_back(best);
  }
  std::vector<double> radii(line.size(), given.radii.front());
  for (std::size_t k = 0; k + 1 < at.size(); ++k) {
    for (int i = at[k]; i < static_cast<int>(line.size()); ++i) {
      const double t = at[k + 1] > at[k] ? std::min(1.0, (i - at[k]) / static_cast<double>(at[k + 1] - at[k])) : 1.0;
      radii[i] = given.radii[k] + t * (given.radii[k + 1] - given.radii[k]);
    }
  }
  return radii;
}

// Strokes of a crown cross, run side by side and end near each other: each is the branch it was drawn as.
Annotation annotation_as_drawn(const RidgeEvidence& evidence, Size size, const TraceOptions& options,
                               const Monitor& monitor) {
  constexpr double kStartsAt = 16.0;  // px from an earlier stroke's rim
  constexpr double kRoot = 4.0;       // px from a given root
  const LatticeCosts costs = live_wire_costs(evidence);
  const std::vector<WideStroke> drawn = parse_wide_strokes("through", options.through);
  const std::vector<Vec2> roots = parse_points("root", options.root);
  std::vector<OwnStroke> strokes;
  for (const WideStroke& stroke : drawn) {
    const std::vector<Vec2>& points = stroke.points;
    OwnStroke own;
    double nearest = kStartsAt;
    const bool root =
        std::any_of(roots.begin(), roots.end(), [&](const Vec2& r) { return (r - points.front()).norm() < kRoot; });
    for (std::size_t s = 0; s < (root ? 0 : strokes.size()); ++s) {
      for (std::size_t i = 0; i < strokes[s].line.size(); ++i) {
        const double away = (strokes[s].line[i] - points.front()).norm() - strokes[s].radii[i];
        if (away < nearest) nearest = away, own.parent = static_cast<int>(s), own.parent_at = static_cast<int>(i);
      }
    }
    TraceEdge edge;
    for (const Pixel& p : draw_stroke(evidence, costs, points, options.straight, {}, monitor))
      edge.line.emplace_back(p.x, p.y);
    if (stroke.radii.empty()) {
      measure_edge(edge, evidence, options);
    } else {
      edge.line = smoothed(evenly_spaced(edge.line, 1.0), kStaircase);
      edge.radii = radii_along(edge.line, stroke);
    }
    own.line = std::move(edge.line);
    own.radii = std::move(edge.radii);
    if (own.parent != kNone) {  // from the parent's middle on
      const Vec2 start = strokes[own.parent].line[own.parent_at];
      const std::vector<Vec2> lead = evenly_spaced({start, own.line.front()}, 1.0);
      own.line.insert(own.line.begin(), lead.begin(), lead.end() - 1);
      own.radii.insert(own.radii.begin(), lead.size() - 1, own.radii.front());
    }
    strokes.push_back(std::move(own));
    monitor.report(static_cast<double>(strokes.size()) / static_cast<double>(drawn.size()));
  }
  return annotation_from_strokes(strokes, size, {});
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
      flag("as-drawn", o.as_drawn,
           "With --through: every stroke is a branch of its own, from the earlier one it starts at (or a --root); "
           "crossings "
           "join nothing, and points may be x,y,radius."),
      flag("straight", o.straight, "With --through: follow the points alone, not the picture."),
      number("banks", o.banks, 0.0, 10000.0, "px",
             "With --through: strokes along branches wider than this are traced by their two banks; 0: never."),
      text("root", o.root, "Where the structure starts: \"x,y\" in px, or several points."),
      flag("find-regions", o.find_regions,
           "Without --regions: take a black surround for outside, and within it a spot where thick branches meet for a "
           "landmark."),
      text("regions", o.regions, "Polygons \"outside: x,y x,y x,y; keep: …; ignore: …; landmark: …\" in px."),
  };
}

namespace {

// Strokes may start a little beyond the frame; farther out a point is a slip of the pen.
void check_points(const std::string& option, const std::vector<Vec2>& points, Size size) {
  constexpr double kBeyond = 16.0;  // px
  for (const Vec2& p : points) {
    if (p.x() >= -kBeyond && p.y() >= -kBeyond && p.x() < size.width + kBeyond && p.y() < size.height + kBeyond) continue;
    throw OptionError(option, "'" + number_text(p.x()) + "," + number_text(p.y()) + "'",
                      "lies outside the photo of " + std::to_string(size.width) + "x" + std::to_string(size.height) + " px");
  }
}

}  // namespace

Annotation trace_photo(const Photo& photo, const TraceOptions& options, const Monitor& monitor) {
  const CancelScope scope(monitor);
  TraceOptions checked = options;
  check_options(describe(checked));
  std::vector<Region> regions = parse_regions("regions", options.regions);
  check_points("root", parse_points("root", options.root), photo.color.size());
  for (const WideStroke& stroke : parse_wide_strokes("through", options.through)) {
    check_points("through", stroke.points, photo.color.size());
  }
  const bool by_itself = options.through.empty() || options.automatic;
  const bool find_regions = options.find_regions && regions.empty() && by_itself;
  if (find_regions) {
    if (auto surround = dark_surround(photo.color)) regions.push_back(std::move(*surround));
  }
  Mask excluded = excluded_pixels(photo, regions);
  if (find_regions && !regions.empty()) excluded = dilate(excluded, kRimFade);
  RidgeEvidence evidence = gather_evidence(photo.color, excluded, options, monitor.stage("ridges", 0.0, 0.5));
  const auto finished = [&](Annotation annotation) {
    calm_radii(annotation);
    annotation = thinned_out(annotation);
    sign_annotation(annotation, photo, evidence);
    annotation.regions = std::move(regions);
    return annotation;
  };
  if (options.as_drawn && !options.through.empty()) {
    return finished(annotation_as_drawn(evidence, photo.color.size(), options, monitor.stage("strokes", 0.5, 1.0)));
  }
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
  if (by_itself) annotation = without_stubs(annotation);
  return finished(std::move(annotation));
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
