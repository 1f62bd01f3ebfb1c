// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/report/structure_figures.h"

#include <algorithm>
#include <cmath>

namespace ramify {
namespace {

constexpr double kHeadingCounts = 0.3;  // strength from which an order has a direction of its own (PICTURES 1)
constexpr double kHeadingLength = 0.02; // share of the length an order needs on both sides to be judged
constexpr double kNovel = 0.15;         // overlap above chance that still counts as new (PICTURES 10)

std::string percent(double share) { return std::to_string(static_cast<int>(std::lround(100.0 * share))) + " %"; }

double degrees(double angle) { return angle * 180.0 / kPi; }

// Plots show angles in degrees.
void add_histogram(const std::string& label, const std::string& unit, HistogramPair pair, StructureComparison& out) {
  const bool angle = unit == "rad";
  for (ShareHistogram* h : {&pair.first, &pair.second}) {
    if (angle) h->low = degrees(h->low), h->high = degrees(h->high);
  }
  out.histograms.push_back({label, angle ? "deg" : unit, pair.first, pair.second});
}

void add_distribution(const std::string& key, const std::string& label, const std::string& unit,
                      const std::vector<std::vector<double>>& exemplar, const std::vector<std::vector<double>>& result,
                      Rng rng, StructureComparison& out) {
  const auto a = pooled(exemplar), b = pooled(result);
  const HistogramPair pair = make_histograms(a, b);
  const NoiseFloor floor = noise_floor(exemplar, rng);
  add_histogram(label, unit, pair, out);
  Figure tv{key + "_tv", label + ", total variation", "", {}, total_variation(pair.first, pair.second), floor.total_variation, "", {}};
  out.figures.push_back(judged(tv, 0.0, 2.0 * floor.total_variation, "at most twice the spread"));
  out.figures.push_back({key + "_js", label + ", Jensen-Shannon", "bit", {}, jensen_shannon(pair.first, pair.second),
                         floor.jensen_shannon, "", Verdict::None});
  out.figures.push_back({key + "_emd", label + ", earth mover's distance", unit, {}, earth_movers_distance(a, b),
                         floor.earth_movers, "", Verdict::None});
}

// Both as numbers; judged when the result may differ by at most `share` of the exemplar's.
void add_rate(const std::string& key, const std::string& label, const std::string& unit, double exemplar, double result,
              double share, std::vector<Figure>& figures) {
  Figure figure{key, label, unit, exemplar, result, {}, "", Verdict::None};
  figures.push_back(share > 0.0 ? judged(figure, (1.0 - share) * exemplar, (1.0 + share) * exemplar, "within " + percent(share))
                                : figure);
}

void add_headings(StructureComparison& out) {
  const auto add = [&](const std::string& key, const std::string& label, const Heading& a, const Heading& b) {
    Figure strength{key + "_strength", label + ", strength", "", a.strength, b.strength, {}, "", Verdict::None};
    out.figures.push_back(judged(strength, a.strength - 0.15, a.strength + 0.15, "within 0.15"));
    if (a.strength < kHeadingCounts) return;
    Figure turn{key + "_turn_deg", label + ", off by", "deg", {}, std::abs(degrees(wrap_angle(b.direction - a.direction))), {}, "", {}};
    out.figures.push_back(judged(turn, 0.0, 25.0, "at most 25"));
  };
  add("heading", "direction of all edges", out.exemplar.heading, out.result.heading);
  const std::size_t orders = std::min(out.exemplar.order_headings.size(), out.result.order_headings.size());
  for (std::size_t o = 0; o < orders; ++o) {
    const auto counts = [o](const SkeletonStatistics& side) { return side.order_lengths[o] >= kHeadingLength * side.total_length; };
    if (!counts(out.exemplar) || !counts(out.result)) continue;
    add("heading_order" + std::to_string(o), "direction of order " + std::to_string(o), out.exemplar.order_headings[o],
        out.result.order_headings[o]);
  }
}

void add_shapes(StructureComparison& out) {
  const SkeletonStatistics &a = out.exemplar, &b = out.result;
  auto& figures = out.figures;
  add_rate("furcations_per_1000px", "furcations per 1000 px", "", a.furcations_per_1000px, b.furcations_per_1000px, 0.2, figures);
  add_rate("length_px", "total length", "px", a.total_length, b.total_length, 0.0, figures);
  const std::size_t orders = std::max(a.order_lengths.size(), b.order_lengths.size());
  for (std::size_t o = 0; o < orders; ++o) {
    const auto share = [o](const SkeletonStatistics& s) {
      return o < s.order_lengths.size() && s.total_length > 0.0 ? s.order_lengths[o] / s.total_length : 0.0;
    };
    add_rate("length_share_order" + std::to_string(o), "share of length in order " + std::to_string(o), "", share(a), share(b), 0.0, figures);
  }
  for (std::size_t k = 1; k < std::min(a.strahler_streams.size(), b.strahler_streams.size()); ++k) {
    const auto ratio = [k](const SkeletonStatistics& s) { return static_cast<double>(s.strahler_streams[k - 1]) / s.strahler_streams[k]; };
    add_rate("strahler_ratio_" + std::to_string(k), "Strahler ratio " + std::to_string(k) + " : " + std::to_string(k + 1), "",
             ratio(a), ratio(b), 0.0, figures);
  }
  for (const double q : {0.5, 0.9}) {
    add_rate("tortuosity_" + std::to_string(static_cast<int>(100 * q)), "arc / chord, " + percent(q) + " quantile", "",
             quantile(a.tortuosity, q), quantile(b.tortuosity, q), 0.0, figures);
  }
  add_rate("gap_median_px", "gap between furcations, median", "px", quantile(a.gaps, 0.5), quantile(b.gaps, 0.5), 0.0, figures);
  add_rate("fork_angle_median_deg", "angle of children, median", "deg", degrees(quantile(a.fork_angles, 0.5)),
           degrees(quantile(b.fork_angles, 0.5)), 0.0, figures);
  add_rate("fork_ratio_median", "radius of child / parent, median", "", quantile(a.fork_ratios, 0.5), quantile(b.fork_ratios, 0.5), 0.0, figures);
  Figure box{"box_dimension", "box-counting dimension", "", a.box_dimension, b.box_dimension, {}, "", Verdict::None};
  figures.push_back(judged(box, a.box_dimension - 0.05, a.box_dimension + 0.05, "within 0.05"));
  Figure crossing{"crossings", "crossings", "", a.crossings, b.crossings, {}, "", Verdict::None};
  figures.push_back(judged(crossing, 0.0, 0.0, "none"));
}

// Centre lines on cells of 4 px, on a square that holds both canvases.
constexpr double kCell = 4.0;  // px
struct CellLines {
  int side = 0;
  std::vector<std::uint8_t> hit;
  bool at(int x, int y) const { return x >= 0 && y >= 0 && x < side && y < side && hit[static_cast<std::size_t>(y) * side + x]; }
};

CellLines draw_cells(const Skeleton& skeleton, int side, double turn) {
  CellLines lines{side, std::vector<std::uint8_t>(static_cast<std::size_t>(side) * side, 0)};
  const Vec2 centre(0.5 * skeleton.size.width, 0.5 * skeleton.size.height);
  const double c = std::cos(turn), s = std::sin(turn);
  for (const Node& node : skeleton.nodes()) {
    if (node.parent == kNone) continue;
    const Vec2 a = node.xy(), b = skeleton[node.parent].xy();
    const int steps = static_cast<int>(std::min(1e6, std::ceil((b - a).norm()))) + 1;
    for (int k = 0; k <= steps; ++k) {
      const Vec2 q = a + (b - a) * k / steps - centre;
      const Vec2 p = centre + Vec2(c * q.x() - s * q.y(), s * q.x() + c * q.y());
      const double x = std::floor((p.x() + 0.5) / kCell), y = std::floor((p.y() + 0.5) / kCell);
      if (p.x() < 0 || p.y() < 0 || p.x() >= skeleton.size.width || p.y() >= skeleton.size.height) continue;
      lines.hit[static_cast<std::size_t>(y) * side + static_cast<std::size_t>(x)] = 1;
    }
  }
  return lines;
}

double best_overlap(const CellLines& a, const CellLines& b, int reach) {
  std::vector<std::pair<int, int>> cells;
  for (int y = 0; y < b.side; ++y) {
    for (int x = 0; x < b.side; ++x) {
      if (b.at(x, y)) cells.emplace_back(x, y);
    }
  }
  const auto own = static_cast<double>(std::count(a.hit.begin(), a.hit.end(), 1));
  const int last = b.side - 1;
  int best = 0;
  for (int move = 0; move < 8; ++move) {
    for (int dy = -reach; dy <= reach; ++dy) {
      for (int dx = -reach; dx <= reach; ++dx) {
        int hits = 0;
        for (auto [x, y] : cells) {
          if (move & 1) x = last - x;
          if (move & 2) y = last - y;
          if (move & 4) std::swap(x, y);
          hits += a.at(x + dx, y + dy);
        }
        best = std::max(best, hits);
      }
    }
  }
  return 2.0 * best / std::max(1.0, own + static_cast<double>(cells.size()));
}

}  // namespace

Figure judged(Figure figure, double low, double high, std::string limit) {
  constexpr double kRounding = 1e-12;
  figure.limit = std::move(limit);
  if (!figure.result || std::isnan(*figure.result)) return figure;
  figure.verdict = *figure.result >= low - kRounding && *figure.result <= high + kRounding ? Verdict::Pass : Verdict::Fail;
  return figure;
}

SameStructure measure_same_structure(const Skeleton& a, const Skeleton& b) {
  const int longer = std::max({a.size.width, a.size.height, b.size.width, b.size.height, 1});
  const int side = static_cast<int>(longer / kCell) + 1;
  const int reach = std::max(1, static_cast<int>(0.1 * std::min(a.size.width, a.size.height) / kCell));
  const CellLines first = draw_cells(a, side, 0.0);
  return {best_overlap(first, draw_cells(b, side, 0.0), reach), best_overlap(first, draw_cells(b, side, 0.25 * kPi), reach)};
}

StructureComparison compare_structure(const Skeleton& exemplar, const Skeleton& result, Rng rng) {
  StructureComparison out;
  const double step = comparison_step(exemplar);
  out.exemplar = measure_statistics(exemplar, step);
  out.result = measure_statistics(result, step);
  add_distribution("angle", "turning angle", "rad", out.exemplar.bends.angles, out.result.bends.angles, rng.child("angle"), out);
  add_distribution("radius", "radius", "px", out.exemplar.bends.radii, out.result.bends.radii, rng.child("radius"), out);
  const SkeletonStatistics &a = out.exemplar, &b = out.result;
  if (!a.gaps.empty() && !b.gaps.empty()) add_histogram("gap between furcations", "px", make_histograms(a.gaps, b.gaps), out);
  if (!a.fork_angles.empty() && !b.fork_angles.empty()) {
    add_histogram("angle of children", "rad", make_histograms(a.fork_angles, b.fork_angles), out);
  }
  add_shapes(out);
  add_headings(out);
  if (exemplar.size == result.size) {
    const SameStructure same = measure_same_structure(exemplar, result);
    Figure novel{"same_structure_f1", "overlap with the exemplar's own skeleton", "", {}, same.overlap, same.chance, "", Verdict::None};
    out.figures.push_back(judged(novel, 0.0, same.chance + kNovel, "at most chance + 0.15"));
  }
  return out;
}

}  // namespace ramify
