// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/compose/candidate.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "ramify/core/parallel.h"
#include "ramify/core/rounding.h"
#include "ramify/geometry/registration.h"

namespace ramify {
namespace {

constexpr std::size_t kShapeSurvivors = 120;  // go on to the dearer terms
constexpr std::size_t kKept = 24;
constexpr std::size_t kCompared = 1200;
constexpr std::size_t kEnough = 60;           // candidates of nearly the same width
constexpr double kLitTurn = 25.0 * kPi / 180;  // rad, by which light from one side may turn unseen (PICTURES 8)
constexpr std::ptrdiff_t kEnoughUpright = 24;  // candidates turned less, for which no other width is looked at
constexpr std::ptrdiff_t kFewUpright = 4;      // fewer leave no choice
constexpr int kDiscGrid = 9;                   // disagreement is sampled on 19 x 19 points

Vec2 mirrored(const Vec2& v, bool mirror) { return mirror ? Vec2(-v.x(), v.y()) : v; }

BranchShape shape_of(const Fragment& f, bool mirror, bool backwards) {
  BranchShape shape;
  shape.count = f.shape.size();
  for (std::size_t l = 0; l < shape.count; ++l) {
    const ShapeSample& sample = f.shape[paired_sample(f, backwards, l)];
    shape.points[l] = mirrored(sample.offset, mirror);
    shape.radii[l] = sample.radius;
  }
  return shape;
}

// Widths that differ by more than a quarter are met half by scaling; finer differences are left to the bending.
double scale_for(const Fragment& source, const Fragment& target) {
  const double ratio = target.branch_radius / source.branch_radius;
  return ratio > 0.8 && ratio < 1.25 ? 1.0 : std::clamp(ratio, 0.67, 1.5);
}

// Equation 1 of paper 002 per sample, in units of the disc radius. omega_S: 2 in the paper.
SourceCandidate compare_shapes(const BranchShape& source, const BranchShape& target, double scale, double radius, double omega) {
  SourceCandidate candidate;
  candidate.scale = scale;
  std::array<Vec2, 17> scaled;
  for (std::size_t l = 0; l < source.count; ++l) scaled[l] = scale * source.points[l];
  const Alignment alignment =
      align_rotation(std::span(scaled.data(), source.count), std::span(target.points.data(), target.count));
  double sum = alignment.residual;
  for (std::size_t l = 0; l < source.count; ++l) {
    const double d = scale * source.radii[l] - target.radii[l];
    sum += omega * d * d;
  }
  candidate.angle = alignment.angle;
  candidate.shape = sum / (static_cast<double>(source.count) * radius * radius);
  return candidate;
}

bool is_banned(const CandidateContext& context, const Fragment& source, const Fragment& target) {
  if (context.options.leave_out <= 0.0) return false;
  const double reach = context.options.leave_out * target.radius;
  const Vec2 corner(context.library.lab.width() - 1, context.library.lab.height() - 1);
  for (int mirror = 0; mirror < 4; ++mirror) {
    Vec2 home = target.centre;
    if (mirror & 1) home.x() = corner.x() - home.x();
    if (mirror & 2) home.y() = corner.y() - home.y();
    if ((source.centre - home).norm() < reach) return true;
  }
  return false;
}

bool same_kind(const Fragment& source, const Fragment& target, bool any_end) {
  return source.kind == target.kind && (any_end || source.tip == target.tip) &&
         source.shape.size() == target.shape.size();
}

// Cost of a source apart from its shape: another scale of grain, faintness.
double fitness_cost(const CandidateContext& context, const SourceCandidate& c) {
  const double faint = context.shapes[c.source].faintness, log_scale = c.scale == 1.0 ? 0.0 : std::log(c.scale);
  return 0.2 * log_scale * log_scale + context.options.contrast_weight * faint * faint;
}

// A share of them, another one for every target: more than kCompared sources differ by a few pixels only.
std::vector<int> thinned(const CandidateContext& context, const std::vector<int>& sources, int target_index) {
  if (sources.size() <= kCompared) return sources;
  const double share = static_cast<double>(kCompared) / static_cast<double>(sources.size());
  std::vector<int> kept;
  for (const int j : sources) {
    if (hash01(context.seed, target_index, j, 1) < share) kept.push_back(j);
  }
  return kept;
}

// The sources of the target's kind, with the difference of the logarithms of their widths.
std::vector<std::pair<double, int>> sources_of_kind(const CandidateContext& context, const Fragment& target,
                                                    bool any_end) {
  std::vector<std::pair<double, int>> all;
  for (std::size_t j = 0; j < context.shapes.size(); ++j) {
    const Fragment& source = context.library.fragments[j];
    if (!same_kind(source, target, any_end) || is_banned(context, source, target)) continue;
    all.emplace_back(std::abs(context.shapes[j].log_radius - std::log(target.branch_radius + 1.0)), static_cast<int>(j));
  }
  return all;
}

// All ways to lay the sources on the target. Where light decides nothing is mirrored, but a branch may be entered from
// its other end: what runs down the page serves what runs up, without being turned.
std::vector<SourceCandidate> lay_on(const CandidateContext& context, const Fragment& target,
                                    const std::vector<int>& sources) {
  const PlacementOptions& options = context.options;
  const bool shaded = is_shaded(context.library) && !options.paper_greedy;
  const double omega = options.paper_greedy ? 2.0 : 1.0;
  const BranchShape wanted = shape_of(target, false, false);
  std::vector<SourceCandidate> found;
  for (const int j : sources) {
    const Fragment& source = context.library.fragments[j];
    const auto lay = [&](const BranchShape& shape, bool mirror, bool backwards) {
      SourceCandidate c = compare_shapes(shape, wanted, scale_for(source, target), target.radius, omega);
      c.source = j;
      c.mirrored = mirror;
      c.backwards = backwards;
      c.cost = c.shape + (options.paper_greedy ? 0.0 : fitness_cost(context, c));
      found.push_back(c);
    };
    lay(context.shapes[j].straight, false, false);
    if (options.mirror && !is_shaded(context.library))
      lay(context.shapes[j].mirrored, true, source.kind == FragmentKind::Bank);
    if (shaded && source.kind == FragmentKind::Along && !source.tip) lay(context.shapes[j].backwards, false, true);
  }
  return found;
}

// Candidates of nearly the target's width; the limits widen until there are enough. Light from one side betrays what
// was turned: where it decides, sources of another width come before any that are turned more than a little, and that
// limit gives way only where the photo has next to nothing that lies as the target does.
std::vector<SourceCandidate> match_shapes(const CandidateContext& context, const Fragment& target, int target_index,
                                          bool any_end) {
  const bool upright = is_shaded(context.library) && !context.options.paper_greedy;
  const std::vector<std::pair<double, int>> all = sources_of_kind(context, target, any_end);
  std::vector<SourceCandidate> found;
  const double turn = upright ? kLitTurn : 2.0 * kPi;
  for (const double limit : {0.25, 0.5, 1.0, 3.0, 1e9}) {
    std::vector<int> sources;
    for (const auto& [difference, source] : all) {
      if (difference <= limit) sources.push_back(source);
    }
    found = lay_on(context, target, thinned(context, sources, target_index));
    const auto turned = [&](const SourceCandidate& c) { return std::abs(c.angle) > turn; };
    const std::ptrdiff_t left =
        std::count_if(found.begin(), found.end(), [&](const SourceCandidate& c) { return !turned(c); });
    const bool last = sources.size() == all.size();
    if (last && left < kFewUpright) return found;
    if (last || (upright ? left >= kEnoughUpright : sources.size() * 2 >= kEnough)) {
      std::erase_if(found, turned);
      return found;
    }
  }
  return found;
}

// Sorted by cost; those of equal cost keep their order.
void keep_best(std::vector<SourceCandidate>& candidates, std::size_t count) {
  std::vector<std::pair<double, std::size_t>> order(candidates.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = {candidates[i].cost, i};
  count = std::min(count, order.size());
  std::partial_sort(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(count), order.end());
  std::vector<SourceCandidate> best;
  best.reserve(count);
  for (std::size_t k = 0; k < count; ++k) best.push_back(candidates[order[k].second]);
  candidates = std::move(best);
}

// A point of the target's disc, on the canvas.
struct DiscPoint {
  Vec2 offset;     // px from the centre
  float distance;  // px to the branch, signed
};
std::vector<DiscPoint> disc_points(const CandidateContext& context, const Fragment& target) {
  std::vector<DiscPoint> points;
  for (int gy = -kDiscGrid; gy <= kDiscGrid; ++gy) {
    for (int gx = -kDiscGrid; gx <= kDiscGrid; ++gx) {
      if (gx * gx + gy * gy > kDiscGrid * kDiscGrid) continue;
      const Vec2 offset = target.radius / kDiscGrid * Vec2(gx, gy);
      const int x = round_to_int(target.centre.x() + offset.x()), y = round_to_int(target.centre.y() + offset.y());
      if (context.field.signed_distance.contains(x, y)) points.push_back({offset, context.field.signed_distance(x, y)});
    }
  }
  return points;
}

// Share of the disc where one has a branch and the other has none; places the photo does not have count as well. Where
// it is sure to be more than `most`, some share above that.
double mask_disagreement(const FragmentLibrary& library, const std::vector<DiscPoint>& points, const SourceCandidate& c,
                         double most) {
  if (points.empty()) return 1.0;
  const Fragment& source = library.fragments[c.source];
  const double count = static_cast<double>(points.size()), most_bad = most * count + 0.5;
  double bad = 0.0;
  for (const auto& [offset, b] : points) {
    const Vec2 p = source.centre + photo_offset(c, offset);
    const int u = round_to_int(p.x()), v = round_to_int(p.y());
    if (!library.lab.contains(u, v) || library.unusable(u, v)) {
      bad += 1.0;
    } else {
      const float a = library.field.signed_distance(u, v);
      if ((a > 0) != (b > 0) && (std::abs(a) > 1 || std::abs(b) > 1)) {
        bad += 1.0;
      } else if (b > 2 && library.shadow(u, v)) {
        bad += 0.5;
      }
    }
    if (bad > most_bad) break;
  }
  return bad / count;
}

double tone_difference(const CandidateContext& context, const Fragment& target, const Fragment& source) {
  if (context.canvas_low.empty() || target.kind == FragmentKind::Interior) return 0.0;
  auto at = [](const ColorImage& image, const Vec2& p) {
    return image.clamped(round_to_int(p.x()), round_to_int(p.y()));
  };
  const Rgb d = at(context.canvas_low, target.centre) - at(context.photo_low, source.centre);
  return (d.r * d.r + d.g * d.g + d.b * d.b) / 100.0;
}

// Adds what takes long to find: other branches in the disc, another tone, the seed's whim. Only the best kKept are
// wanted, so that the disc of those which cannot be among them is not looked at to its end.
void add_dear_terms(const CandidateContext& context, const Fragment& target, int target_index,
                    std::vector<SourceCandidate>& candidates) {
  const PlacementOptions& options = context.options;
  struct Rest {
    double least;  // cost, were there no disagreement
    double tone, whim;
    std::size_t index;
  };
  std::vector<Rest> rest;
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    const SourceCandidate& c = candidates[i];
    const double u = hash01(context.seed, target_index, 4 * c.source + 2 * c.backwards + c.mirrored);
    const double tone = options.colour_weight * tone_difference(context, target, context.library.fragments[c.source]);
    const double whim = options.variation * -std::log(-std::log(u * 0.999 + 0.0005));
    rest.push_back({c.cost + tone - whim, tone, whim, i});
  }
  std::sort(rest.begin(), rest.end(),
            [](const Rest& a, const Rest& b) { return a.least != b.least ? a.least < b.least : a.index < b.index; });
  const std::vector<DiscPoint> points = disc_points(context, target);
  std::vector<double> best;  // costs of the best kKept so far, a heap with the worst on top
  for (const Rest& r : rest) {
    SourceCandidate& c = candidates[r.index];
    constexpr double kSure = 1e-9;  // more than sums differ by their order
    const bool full = best.size() == kKept;
    const double spare = full ? best.front() - r.least + kSure * (1.0 + std::abs(best.front()))
                              : std::numeric_limits<double>::infinity();
    const double most = options.mask_weight > 0.0 ? std::max(0.0, spare / options.mask_weight)
                                                  : std::numeric_limits<double>::infinity();
    c.disagreement = spare < 0.0 ? 1.0 : mask_disagreement(context.library, points, c, most);
    c.cost += options.mask_weight * c.disagreement;
    c.cost += r.tone;
    c.cost -= r.whim;
    if (spare < 0.0) c.cost = std::numeric_limits<double>::infinity();
    best.push_back(c.cost);
    std::push_heap(best.begin(), best.end());
    if (best.size() > kKept) std::pop_heap(best.begin(), best.end()), best.pop_back();
  }
}

}  // namespace

Vec2 photo_offset(const SourceCandidate& candidate, const Vec2& canvas_offset) {
  const Vec2 turned(candidate.cosine * canvas_offset.x() + candidate.sine * canvas_offset.y(),
                    candidate.cosine * canvas_offset.y() - candidate.sine * canvas_offset.x());
  return mirrored(turned / candidate.scale, candidate.mirrored);
}

CandidateContext::CandidateContext(const FragmentLibrary& photo_library, const BranchField& canvas_field,
                                   const PlacementOptions& choices)
    : library(photo_library), field(canvas_field), options(choices), shapes(photo_library.fragments.size()) {
  parallel_for(
      static_cast<int>(shapes.size()),
      [&](int j) {
        const Fragment& f = library.fragments[j];
        const double usual = usual_contrast(library, f.branch_radius);
        const bool bank = f.kind == FragmentKind::Bank;  // mirrored, it runs backwards: the branch stays on its side
        shapes[j] = {shape_of(f, false, false), shape_of(f, true, bank), shape_of(f, false, true),
                     std::log(f.branch_radius + 1.0),
                     usual > 0.0 && f.kind < FragmentKind::Bank ? std::max(0.0, 0.9 - f.contrast / usual) : 0.0};
      },
      64);
}

std::vector<SourceCandidate> rank_candidates(const CandidateContext& context, const Fragment& target, int target_index) {
  std::vector<SourceCandidate> candidates = match_shapes(context, target, target_index, false);
  // A photo without a single free end: the branch is cut off where it has to end.
  if (candidates.empty() && target.kind == FragmentKind::Along)
    candidates = match_shapes(context, target, target_index, true);
  keep_best(candidates, kShapeSurvivors);
  for (SourceCandidate& c : candidates) {
    c.cosine = std::cos(c.angle);
    c.sine = std::sin(c.angle);
  }
  if (context.options.paper_greedy) return candidates;
  add_dear_terms(context, target, target_index, candidates);
  keep_best(candidates, kKept);
  return candidates;
}

double overlap_difference(const FragmentLibrary& library, const ColorImage& photo, const Fragment& target_a,
                          const SourceCandidate& a, const Fragment& target_b, const SourceCandidate& b) {
  const Vec2 way = target_b.centre - target_a.centre;
  const double distance = way.norm(), ra = target_a.radius, rb = target_b.radius;
  if (distance < 1e-6 || distance >= ra + rb) return 0.0;
  const Vec2 along = way / distance, across = perpendicular(along);
  const double middle = (distance * distance + ra * ra - rb * rb) / (2.0 * distance);
  const double half_height = std::sqrt(std::max(1.0, ra * ra - middle * middle));
  const double depth = std::min(ra, distance) - std::max(distance - rb, 0.0);
  Rgb mean;
  double sum = 0.0;
  int count = 0;
  for (int i = -4; i <= 4; ++i) {
    for (int k = -1; k <= 1; ++k) {
      const Vec2 w = target_a.centre + (middle + 0.15 * k * depth) * along + (half_height * i / 4.5) * across;
      const Vec2 p = library.fragments[a.source].centre + photo_offset(a, w - target_a.centre);
      const Vec2 q = library.fragments[b.source].centre + photo_offset(b, w - target_b.centre);
      const int px = round_to_int(p.x()), py = round_to_int(p.y());
      const int qx = round_to_int(q.x()), qy = round_to_int(q.y());
      if (!photo.contains(px, py) || !photo.contains(qx, qy)) continue;
      const Rgb d = photo(px, py) - photo(qx, qy);
      mean = mean + d;
      sum += d.r * d.r + d.g * d.g + d.b * d.b;
      ++count;
    }
  }
  if (count == 0) return 500.0;
  mean = 1.0f / static_cast<float>(count) * mean;
  return sum / count - 0.7 * (mean.r * mean.r + mean.g * mean.g + mean.b * mean.b);
}

}  // namespace ramify
