// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/growth/figure.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "ramify/core/error.h"
#include "ramify/growth/figure_curves.h"
#include "ramify/image/filter.h"
#include "ramify/skeleton/thickness.h"

namespace ramify {
namespace {

constexpr double kPixelsAPoint = 90.0;  // of the shape; 003 draws "Bridges 2025" with about 80 and 270
constexpr int kMostOwnPoints = 6000;    // when their number is ours to choose
constexpr double kTwig = 0.15;          // width of the last twigs in spaces between points
constexpr double kWidestInShape = 0.8;  // of the distance to the shape's border, for half the width (ALGORITHMS 10-7)
constexpr double kThinnestRadius = 0.25;  // px

double space_between(double area, std::size_t points) { return std::sqrt(area / std::max<std::size_t>(1, points)); }

// As many points on the border as leave four tenths of a space between them.
int border_count(const Mask& region, double space) {
  int border = 0;
  for (int y = 0; y < region.height(); ++y) {
    for (int x = 0; x < region.width(); ++x) {
      const auto open = [&](int dx, int dy) { return !region.contains(x + dx, y + dy) || !region(x + dx, y + dy); };
      border += region(x, y) && (open(-1, 0) || open(1, 0) || open(0, -1) || open(0, 1));
    }
  }
  return static_cast<int>(border / (0.4 * space));
}

// "x,y"; nothing for the words.
std::optional<Vec2> start_point(const std::string& start) {
  const std::size_t comma = start.find(',');
  double x = 0, y = 0;
  if (comma != std::string::npos && parse_number(start.substr(0, comma), x) && parse_number(start.substr(comma + 1), y)) return Vec2(x, y);
  for (const char* word : {"bottom", "top", "left", "right", "centre"}) {
    if (start == word) return std::nullopt;
  }
  throw OptionError("start", "'" + printable(start, 60) + "'", "expected bottom, top, left, right, centre or x,y in px");
}

// The cell of every island in which its tree starts: as far as possible to the named side, there in the middle.
std::vector<int> start_cells(const FigureCells& cells, const LabelImage& island, int islands, const std::string& start) {
  const std::optional<Vec2> point = start_point(start);
  std::vector<Vec2> low(static_cast<std::size_t>(islands), Vec2(1e9, 1e9)), high(static_cast<std::size_t>(islands), Vec2(-1e9, -1e9));
  const auto island_of = [&](const Vec2& p) { return island.clamped(static_cast<int>(std::lround(p.x())), static_cast<int>(std::lround(p.y()))); };
  for (const Vec2& p : cells.sites) {
    const int i = island_of(p);
    if (i != kNone) low[i] = low[i].cwiseMin(p), high[i] = high[i].cwiseMax(p);
  }
  std::vector<int> best(static_cast<std::size_t>(islands), kNone);
  std::vector<double> least(static_cast<std::size_t>(islands), 1e300);
  for (std::size_t k = 0; k < cells.sites.size(); ++k) {
    const Vec2& p = cells.sites[k];
    const int i = island_of(p);
    if (i == kNone) continue;
    const Vec2 middle = 0.5 * (low[i] + high[i]), off = (p - middle).cwiseAbs();
    double cost = off.norm();
    if (point) cost = (p - *point).norm();
    else if (start == "bottom") cost = -p.y() + 0.3 * off.x();
    else if (start == "top") cost = p.y() + 0.3 * off.x();
    else if (start == "left") cost = p.x() + 0.3 * off.y();
    else if (start == "right") cost = -p.x() + 0.3 * off.y();
    if (cost < least[i]) least[i] = cost, best[i] = static_cast<int>(k);
  }
  std::vector<int> out;
  for (const int cell : best) {
    if (cell != kNone) out.push_back(cell);
  }
  return out;
}

PointGraph cell_graph(const FigureCells& cells, FigureTree tree, const Rng& rng) {
  std::vector<Vec3> points;
  for (const Vec2& p : cells.sites) points.emplace_back(p.x(), p.y(), 0.0);
  PointGraph graph = voronoi_graph(points, {cells.label.pixels().begin(), cells.label.pixels().end()}, cells.label.width(), cells.label.height());
  const std::uint64_t seed = rng.child("tree").next();
  if (tree == FigureTree::Random) return with_hashed_costs(std::move(graph), seed, 1.0, 10.0);
  if (tree != FigureTree::Steps) return graph;
  // All edges count the same; a hash decides between ways of equal many, so that no front shows (ALGORITHMS 10-5).
  for (int i = 0; i < graph.count(); ++i) {
    for (int k = graph.first[i]; k < graph.first[i + 1]; ++k) {
      const int j = graph.neighbor[k];
      graph.cost[k] = static_cast<float>(1.0 + 0.01 * hash01(seed, static_cast<std::uint64_t>(std::min(i, j)), static_cast<std::uint64_t>(std::max(i, j))));
    }
  }
  return graph;
}

// A rooted tree over the cells.
struct CellTree {
  std::vector<int> parents;
  std::vector<std::vector<int>> children;  // the one with most leaves first
  std::vector<int> order;                  // parents before children; reached cells only
  std::vector<int> leaves;                 // below each cell, itself included when it is one
  std::vector<double> way;                 // px from the root
};

CellTree make_tree(const FigureCells& cells, std::vector<int> parents, const std::vector<int>& roots) {
  const std::size_t n = cells.sites.size();
  CellTree tree{std::move(parents), std::vector<std::vector<int>>(n), roots, std::vector<int>(n, 0), std::vector<double>(n, 0.0)};
  for (std::size_t i = 0; i < n; ++i) {
    if (tree.parents[i] != kNone) tree.children[static_cast<std::size_t>(tree.parents[i])].push_back(static_cast<int>(i));
  }
  for (std::size_t k = 0; k < tree.order.size(); ++k) {
    const int cell = tree.order[k];
    for (const int child : tree.children[static_cast<std::size_t>(cell)]) {
      tree.way[child] = tree.way[cell] + (cells.sites[child] - cells.sites[cell]).norm();
      tree.order.push_back(child);
    }
  }
  for (auto cell = tree.order.rbegin(); cell != tree.order.rend(); ++cell) {
    tree.leaves[*cell] = std::max(1, tree.leaves[*cell]);
    if (tree.parents[*cell] != kNone) tree.leaves[tree.parents[*cell]] += tree.leaves[*cell];
  }
  for (std::vector<int>& children : tree.children) {
    std::stable_sort(children.begin(), children.end(), [&](int a, int b) { return tree.leaves[a] > tree.leaves[b]; });
  }
  return tree;
}

// Half the width of the line into every cell.
std::vector<double> cell_radii(const CellTree& tree, const FigureOptions& options, double thinnest) {
  std::vector<double> radii(tree.parents.size(), 0.5 * thinnest);
  double longest = 1e-9;
  int most = 1;
  for (const int cell : tree.order) longest = std::max(longest, tree.way[cell]), most = std::max(most, tree.leaves[cell]);
  for (const int cell : tree.order) {
    const double thick = std::pow(tree.leaves[cell], 1.0 / options.exponent), trunk = std::pow(most, 1.0 / options.exponent);
    radii[cell] *= options.thickness == FigureThickness::Descendants ? thick : 1.0 + (trunk - 1.0) * (1.0 - tree.way[cell] / longest);
  }
  return radii;
}

// Appends the lines of all cells.
class FigureBuilder {
 public:
  FigureBuilder(const FigureCells& cells, const CellTree& tree, std::vector<double> radii, const Mask& inside, const FigureOptions& options)
      : cells_(cells), tree_(tree), radii_(std::move(radii)), options_(options), pen_(cells, inside, options), skeleton_(cells.label.size()) {
    if (!inside.empty()) room_ = distance_inside(inside);
    portals_ = find_portals(cells.label, cells.sites, tree.parents);
  }

  Skeleton build(const Rng& rng, double twig, const Monitor& monitor) {
    std::vector<int> entry(tree_.parents.size(), kNone);  // node at which the tree comes into the cell
    std::size_t done = 0;
    for (const int cell : tree_.order) {
      if (++done % 256 == 0) monitor.report(static_cast<double>(done) / static_cast<double>(tree_.order.size()));
      const Portal& from = portals_[cell];
      if (tree_.parents[cell] == kNone) entry[cell] = append(from.middle, radii_[cell], kNone);
      const std::vector<int>& children = tree_.children[cell];
      for (const int child : children) {
        const bool main = child == children.front();
        const double start = main ? radii_[cell] : std::min(radii_[cell], radii_[child]);
        entry[child] = draw(cell, entry[cell], start, portals_[child].middle, portals_[child].inward, radii_[child]);
      }
      const bool leaf = children.empty();
      if (tree_.parents[cell] != kNone && (leaf || rng.child("fullness", static_cast<std::uint64_t>(cell)).uniform() < options_.fullness)) {
        draw(cell, entry[cell], leaf ? radii_[cell] : std::min(radii_[cell], twig), cells_.sites[cell], Vec2::Zero(), 0.7 * twig);
      }
    }
    even_out_widths();
    return std::move(skeleton_);
  }

  int straightened() const { return pen_.straightened(); }

 private:
  // Where the shape is narrow lines are thin. They narrow slowly before such a place and swell slowly behind it, so that
  // no knots are seen.
  void even_out_widths() {
    constexpr double kNarrowing = 0.1, kSwelling = 0.03;  // px of half the width over a px of way
    std::vector<int> continuation(static_cast<std::size_t>(skeleton_.count()), kNone);
    for (int i = skeleton_.count() - 1; i >= 0; --i) {
      if (skeleton_[i].parent != kNone) continuation[skeleton_[i].parent] = i;  // the lowest index stays
    }
    for (int i = skeleton_.count() - 1; i >= 0; --i) {
      const int next = continuation[i];
      if (next == kNone) continue;
      const double way = (skeleton_[i].xy() - skeleton_[next].xy()).norm();
      skeleton_.set_radius(i, std::min(skeleton_[i].radius, skeleton_[next].radius + kNarrowing * way));
    }
    for (int i = 0; i < skeleton_.count(); ++i) {
      const int parent = skeleton_[i].parent;
      if (parent == kNone) continue;
      const double way = (skeleton_[i].xy() - skeleton_[parent].xy()).norm();
      skeleton_.set_radius(i, std::min(skeleton_[i].radius, skeleton_[parent].radius + kSwelling * way));
    }
  }

  // Returns the node at its end.
  int draw(int cell, int parent, double start, const Vec2& to, const Vec2& in, double end) {
    const Vec2 from = skeleton_[parent].xy();
    const std::vector<Vec2> points = pen_.line(cell, from, portals_[cell].inward, to, in);
    int node = parent;
    for (std::size_t i = 1; i < points.size(); ++i) {
      const double t = static_cast<double>(i) / static_cast<double>(points.size() - 1);
      node = append(points[i], start + t * (end - start), node);
    }
    return node;
  }

  int append(const Vec2& p, double radius, int parent) {
    if (!room_.empty()) {
      const double room = room_.clamped(static_cast<int>(std::lround(p.x())), static_cast<int>(std::lround(p.y())));
      radius = std::min(radius, kWidestInShape * room);
    }
    Node node;
    node.position = Vec3(p.x(), p.y(), 0.0);
    node.radius = std::max(kThinnestRadius, radius);
    node.parent = parent;
    return skeleton_.append(node);
  }

  const FigureCells& cells_;
  const CellTree& tree_;
  std::vector<double> radii_;
  const FigureOptions& options_;
  FigurePen pen_;
  ScalarImage room_;  // px to the shape's border
  std::vector<Portal> portals_;
  Skeleton skeleton_;
};

}  // namespace

std::vector<OptionField> describe(FigureOptions& o) {
  return {number("points", o.points, 0, 1000000, "N", "Cells, each with a twig: the density of the tree; 0 = one for about 90 px of the shape."),
          number("evenness", o.evenness, 0, 100, "N", "Rounds that spread the points evenly; 0 = ragged."),
          choice("cells", o.cells, {"geodesic", "euclidean"}, "geodesic keeps inside the shape; euclidean is the paper's, for comparison."),
          number("border-points", o.border_points, 0, 1000000, "N", "Points on the border (euclidean cells); 0 = as dense as the others."),
          choice("join", o.join, {"apart", "bridges"}, "A tree for every part of the shape, or one tree over bridges."),
          number("bridge", o.bridge, 0, 1000, "px", "Width of the bridges; 0 = from the space between points."),
          choice("tree", o.tree, {"steps", "shortest", "random", "minimal"}, "Which spanning tree: fewest steps, shortest ways, random costs, least length."),
          text("start", o.start, "Where trees start: bottom, top, left, right, centre or \"x,y\" in px."),
          choice("lines", o.lines, {"curved", "straight"}, "Curves, or straight lines from border to border."),
          number("curl", o.curl, 0, 0.8, "", "How far curves swing."),
          number("fullness", o.fullness, 0, 1, "", "Share of the inner cells with a twig of their own."),
          choice("thickness", o.thickness, {"descendants", "distance"}, "Width by the twigs a branch bears, or by the way from the start."),
          number("exponent", o.exponent, 1, 10, "", "width^exponent adds up where branches meet; larger = thinner trunks."),
          number("thinnest", o.thinnest, 0, 1000, "px", "Width of the last twigs; 0 = from the space between points.")};
}

FilledFigure grow_figure(const Mask& shape, const FigureOptions& options, const Rng& rng, const Monitor& monitor) {
  start_point(options.start);
  FilledFigure figure;
  figure.region = shape;
  double area = 0.0;
  for (const std::uint8_t v : shape.pixels()) area += v != 0;
  const int points = options.points > 0 ? options.points : std::clamp(static_cast<int>(area / kPixelsAPoint), 12, kMostOwnPoints);
  std::vector<FigureIsland> islands = find_islands(figure.region, points, monitor);
  if (options.join == FigureJoin::Bridges && islands.size() > 1) {
    figure.region = bridged(figure.region, options.bridge > 0.0 ? options.bridge : 0.25 * space_between(area, static_cast<std::size_t>(points)));
    islands = find_islands(figure.region, points, monitor);
  }
  const bool euclidean = options.cells == FigureCellKind::Euclidean;
  const int border = options.border_points > 0 ? options.border_points : border_count(figure.region, space_between(area, static_cast<std::size_t>(points)));
  const Monitor part = monitor.stage("cells", 0.0, 0.6);
  const FigureCells cells = euclidean ? euclidean_cells(figure.region, islands, options.evenness, border, rng, part)
                                      : geodesic_cells(figure.region, islands, options.evenness, rng, part);
  int count = 0;
  const LabelImage island = label_components(figure.region, false, count);
  const std::vector<int> roots = start_cells(cells, island, count, options.start);
  const PointGraph graph = cell_graph(cells, options.tree, rng);
  PlanOptions plan_options;
  if (options.tree == FigureTree::Minimal) plan_options.metric.metric = Metric::Full;
  const Plan plan = plan_paths(graph, roots, plan_options, monitor);
  std::vector<int> parents;
  for (int i = 0; i < graph.count(); ++i) parents.push_back(path_parent(plan, graph, i));
  const CellTree tree = make_tree(cells, std::move(parents), roots);
  const double thinnest = options.thinnest > 0.0 ? options.thinnest : std::max(0.6, kTwig * space_between(area, cells.sites.size()));
  const Mask inside = euclidean ? Mask() : figure.region;  // lines may leave the shape in the paper's mode
  FigureBuilder builder(cells, tree, cell_radii(tree, options, thinnest), inside, options);
  figure.skeleton = builder.build(rng, 0.5 * thinnest, monitor.stage("lines", 0.6, 1.0));
  figure.cell = cells.label;
  figure.sites = cells.sites;
  figure.parents = tree.parents;
  figure.islands = static_cast<int>(islands.size());
  figure.reached = static_cast<int>(tree.order.size());
  figure.straightened = builder.straightened();
  if (figure.reached < static_cast<int>(cells.sites.size())) {
    monitor.note(std::to_string(cells.sites.size() - tree.order.size()) + " of " + std::to_string(cells.sites.size()) +
                 " cells are cut off from the tree; geodesic cells never are");
  }
  return figure;
}

}  // namespace ramify
