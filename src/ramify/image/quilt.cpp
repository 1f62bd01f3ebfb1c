// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/image/quilt.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <limits>
#include <numeric>

#include "ramify/core/ordered_tasks.h"
#include "ramify/core/parallel.h"
#include "ramify/image/color.h"
#include "ramify/image/filter.h"
#include "ramify/image/quilt_cut.h"
#include "ramify/image/quilt_search.h"
#include "ramify/image/sample.h"

namespace ramify {
namespace {

constexpr int kSmallestPatch = 12;         // px; below, a quilt is noise
constexpr int kFullResolutionHole = 250000;  // px; larger holes are cut at half resolution

struct Box {
  int tx, ty;
  double depth;  // px from its centre to the nearest known pixel
};

// Boxes on a grid of half their side, each wanted because its middle quarter holds pixels to cover.
std::vector<Box> boxes_over(const Mask& wanted, const ScalarImage& depth, int side) {
  const int step = side / 2, w = wanted.width(), h = wanted.height();
  std::vector<Box> boxes;
  for (int cy = 0; cy < h; cy += step) {
    for (int cx = 0; cx < w; cx += step) {
      bool any = false;
      for (int y = cy; y < std::min(h, cy + step) && !any; ++y) {
        const std::uint8_t* row = wanted.row(y);
        any = std::any_of(row + cx, row + std::min(w, cx + step), [](std::uint8_t v) { return v != 0; });
      }
      if (any) boxes.push_back({cx - step / 2, cy - step / 2, depth.clamped(cx + step / 2, cy + step / 2)});
    }
  }
  return boxes;
}

// Groups of boxes that may be worked on at the same time: a box waits for every earlier box it comes near. Boxes are
// ordered from the rim of the hole inwards, rings of one box's width, row by row.
std::vector<std::vector<int>> schedule(const std::vector<Box>& boxes, int side) {
  std::vector<int> order(boxes.size());
  std::iota(order.begin(), order.end(), 0);
  const auto ring = [&](int i) { return std::isfinite(boxes[i].depth) ? static_cast<int>(boxes[i].depth / side) : 0; };
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return ring(a) < ring(b); });
  int reach_x = 0, reach_y = 0;
  for (const Box& b : boxes) reach_x = std::max(reach_x, b.tx + side), reach_y = std::max(reach_y, b.ty + side);
  const int cell = std::max(1, side / 2);
  Image<int> latest(reach_x / cell + 4, reach_y / cell + 4, -1);  // level of the last box on each grid point
  std::vector<std::vector<int>> levels;
  for (const int i : order) {
    const int gx = (boxes[i].tx + side) / cell, gy = (boxes[i].ty + side) / cell;
    int level = 0;
    for (int y = gy - 2; y <= gy + 2; ++y) {
      for (int x = gx - 2; x <= gx + 2; ++x) {
        if (latest.contains(x, y)) level = std::max(level, latest(x, y) + 1);
      }
    }
    if (latest.contains(gx, gy)) latest(gx, gy) = level;
    if (level >= static_cast<int>(levels.size())) levels.resize(level + 1);
    levels[level].push_back(i);
  }
  return levels;
}

// All boxes level by level, and for each of them the earlier ones it must wait for: those it comes near.
std::pair<std::vector<int>, std::vector<std::vector<int>>> in_turn(const std::vector<Box>& boxes,
                                                                   const std::vector<std::vector<int>>& levels,
                                                                   int side) {
  std::vector<int> order;
  std::vector<std::vector<int>> after;
  const int near = 2 * std::max(1, side / 2);
  for (const std::vector<int>& level : levels) {
    const std::size_t earlier = order.size();
    for (const int i : level) {
      std::vector<int>& waits_for = after.emplace_back();
      for (std::size_t k = 0; k < earlier; ++k) {
        const Box &a = boxes[i], &b = boxes[order[k]];
        if (std::abs(a.tx - b.tx) <= near && std::abs(a.ty - b.ty) <= near) waits_for.push_back(static_cast<int>(k));
      }
    }
    order.insert(order.end(), level.begin(), level.end());
  }
  return {order, after};
}

// Covers the wanted pixels with patches of one size.
void cover(const QuiltJob& job, const QuiltOptions& options, const Mask& wanted, const ScalarImage& depth, int side,
           Quilt& quilt, const Rng& rng, const Monitor& monitor) {
  const std::vector<Box> boxes = boxes_over(wanted, depth, side);
  if (boxes.empty()) return;
  const std::vector<std::vector<int>> levels = schedule(boxes, side);
  PatchSearch search(job, options, side);
  const int base = static_cast<int>(quilt.patches.size());
  quilt.patches.resize(base + boxes.size());
  // Places are chosen level by level: how often one is in use is known between them only.
  for (std::size_t l = 0; l < levels.size(); ++l) {
    parallel_for(static_cast<int>(levels[l].size()), [&](int k) {
      monitor.check();
      const int i = levels[l][k], index = base + i;
      quilt.patches[index] = search.choose(quilt, boxes[i].tx, boxes[i].ty, rng.child("patch", index));
      expand_patch(job, quilt, index);
    });
    for (const int i : levels[l]) search.use(quilt.patches[base + i]);
    monitor.report((l + 1.0) / levels.size() / options.sweeps);
  }
  if (options.sweeps == 1) return;
  const auto [order, after] = in_turn(boxes, levels, side);
  for (int sweep = 1; sweep < options.sweeps; ++sweep) {
    std::atomic<int> ended = 0;
    run_in_order(after, [&, sweep, &turns = order](int k) {
      expand_patch(job, quilt, base + turns[static_cast<std::size_t>(k)]);
      monitor.report((sweep + static_cast<double>(++ended) / static_cast<double>(turns.size())) / options.sweeps);
    });
  }
}

// Pixels of the hole that show nothing yet, or something forbidden; those labels are taken back.
Mask take_back(const QuiltJob& job, Quilt& quilt, int& count) {
  Mask open(job.hole.size(), 0);
  count = 0;
  for (int y = 0; y < open.height(); ++y) {
    for (int x = 0; x < open.width(); ++x) {
      if (!job.hole(x, y)) continue;
      int& label = quilt.label(x, y);
      if (label != kNone && job.forbidden(quilt.patches[label].source_x(x), quilt.patches[label].source_y(y))) label = kNone;
      if (label == kNone) open(x, y) = 255, ++count;
    }
  }
  return open;
}

int even_side(double side) {
  constexpr int unit = 2 * PatchSearch::kCells;
  return std::max(unit, static_cast<int>(std::lround(side / unit)) * unit);
}

Quilt quilt_at_this_size(const QuiltJob& job, const QuiltOptions& options, const Rng& rng, const Monitor& monitor) {
  Quilt quilt;
  quilt.label = LabelImage(job.hole.size(), kNone);
  const ScalarImage depth = distance_to(invert(job.hole));
  int limit = std::min(job.source.width(), job.source.height());
  int side = even_side(std::min<double>(options.patch, limit));
  while (side > limit && side > 2 * PatchSearch::kCells) side -= 2 * PatchSearch::kCells;
  Mask wanted = job.hole;
  double from = 0.0;
  for (int pass = 0, open = 1; open > 0; ++pass) {
    const double to = from + 0.6 * (1.0 - from);
    QuiltOptions now = options;
    if (pass > 0) now.tries = std::max(120, options.tries / 2);
    cover(job, now, wanted, depth, side, quilt, rng.child("pass", pass), monitor.stage("quilt", from, to));
    wanted = take_back(job, quilt, open);
    from = to;
    if (side <= std::max(kSmallestPatch, 2 * PatchSearch::kCells)) break;
    side = even_side(side / 2.0);
  }
  return quilt;
}

Mask shrink(const Mask& mask) {
  Mask out((mask.width() + 1) / 2, (mask.height() + 1) / 2, 0);
  for (int y = 0; y < mask.height(); ++y) {
    for (int x = 0; x < mask.width(); ++x) {
      if (mask(x, y)) out(x / 2, y / 2) = 255;
    }
  }
  return out;
}

template <class T>
Image<T> shrink_mean(const Image<T>& image, Size size) {
  Image<T> out(size);
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      out(x, y) = 0.25f * (image.clamped(2 * x, 2 * y) + image.clamped(2 * x + 1, 2 * y) +
                           image.clamped(2 * x, 2 * y + 1) + image.clamped(2 * x + 1, 2 * y + 1));
    }
  }
  return out;
}

Image<Rgb> shrink_known(const ColorImage& image, const Mask& hole, Size size) {
  ColorImage out(size);
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      Rgb sum{};
      int count = 0;
      for (int k = 0; k < 4; ++k) {
        const int u = std::min(2 * x + k % 2, image.width() - 1), v = std::min(2 * y + k / 2, image.height() - 1);
        if (!hole(u, v)) sum = sum + image(u, v), ++count;
      }
      if (count) out(x, y) = (1.0f / count) * sum;
    }
  }
  return out;
}

// The last odd row and column of the photo are left out, so that every reduced pixel stands for four whole ones.
QuiltJob halved(const QuiltJob& job) {
  QuiltJob half;
  const Size source{job.source.width() / 2, job.source.height() / 2};
  half.source = shrink_mean(job.source, source);
  half.forbidden = crop(shrink(job.forbidden), 0, 0, source.width, source.height);
  if (!job.precious.empty()) half.precious = crop(shrink(job.precious), 0, 0, source.width, source.height);
  half.hole = shrink(job.hole);
  half.canvas = shrink_known(job.canvas, job.hole, half.hole.size());
  for (const GuideChannel& guide : job.guides) {
    half.guides.push_back({shrink_mean(guide.source, source), shrink_mean(guide.target, half.hole.size()), guide.weight});
  }
  return half;
}

Quilt doubled(const Quilt& half, const Mask& hole) {
  Quilt quilt;
  for (QuiltPatch p : half.patches) {
    p.tx *= 2, p.ty *= 2, p.side *= 2;
    p.sx = 2 * p.sx + (p.fx < 0 ? 1 : 0), p.sy = 2 * p.sy + (p.fy < 0 ? 1 : 0);
    quilt.patches.push_back(p);
  }
  quilt.label = LabelImage(hole.size(), kNone);
  for (int y = 0; y < hole.height(); ++y) {
    for (int x = 0; x < hole.width(); ++x) {
      if (hole(x, y)) quilt.label(x, y) = half.label(x / 2, y / 2);
    }
  }
  return quilt;
}

int automatic_side(const QuiltJob& job) {
  const double structure = structure_length(job.source, job.forbidden);
  const ScalarImage inside = distance_to(invert(job.hole));
  float widest = 0.0f;
  for (const float d : inside.pixels()) widest = std::max(widest, std::isfinite(d) ? d : 1e9f);
  const double least = std::clamp(std::min(job.source.width(), job.source.height()) / 10.0, 40.0, 96.0);
  const double textured = std::clamp(4.0 * structure, least, 144.0);
  // A thin hole is best closed by small patches that match its banks.
  return static_cast<int>(std::min(textured, std::max(32.0, 5.0 * widest)));
}

}  // namespace

std::vector<OptionField> describe(QuiltOptions& o) {
  return {
      number("patch", o.patch, 0, 1024, "px", "side of a patch; 0 = the structure of the photo and the hole decide"),
      number("tries", o.tries, 1, 100000, "", "random places tried for every patch"),
      number("reuse", o.reuse, 0.0, 100.0, "", "cost of showing a place that another patch shows already"),
      number("nearby", o.nearby, 0.0, 1e6, "px", "how far from a patch its source may lie; 0 = anywhere"),
      flag("mirror-x", o.mirror_x, "patches may be mirrored left to right"),
      flag("mirror-y", o.mirror_y, "patches may be mirrored top to bottom"),
      number("sweeps", o.sweeps, 1, 10, "", "rounds of seam search"),
  };
}

Quilt make_quilt(const QuiltJob& job, const QuiltOptions& options, Rng rng, const Monitor& monitor) {
  const auto& forbidden = job.forbidden.pixels();
  if (std::all_of(forbidden.begin(), forbidden.end(), [](std::uint8_t v) { return v != 0; })) {
    throw InputError("", "nothing in the photo may be copied: every pixel is masked, forbidden or covered by branches");
  }
  QuiltOptions settled = options;
  if (settled.patch == 0) settled.patch = automatic_side(job);
  const auto open = std::count_if(job.hole.pixels().begin(), job.hole.pixels().end(), [](std::uint8_t v) { return v != 0; });
  if (open <= kFullResolutionHole || job.source.width() < 64 || job.source.height() < 64) {
    return quilt_at_this_size(job, settled, rng, monitor);
  }
  const QuiltJob half = halved(job);
  if (mean_of(half.forbidden) == 1.0) return quilt_at_this_size(job, settled, rng, monitor);
  settled.patch = std::max(1, settled.patch / 2);
  settled.nearby /= 2.0;
  return doubled(quilt_at_this_size(half, settled, rng, monitor), job.hole);
}

VectorImage quilt_sources(const Quilt& quilt) {
  const float none = std::numeric_limits<float>::quiet_NaN();
  VectorImage out(quilt.label.size(), Eigen::Vector2f(none, none));
  parallel_for(
      out.height(),
      [&](int y) {
        for (int x = 0; x < out.width(); ++x) {
          const int label = quilt.label(x, y);
          if (label == kNone) continue;
          const QuiltPatch& p = quilt.patches[label];
          out(x, y) = {static_cast<float>(p.source_x(x)), static_cast<float>(p.source_y(y))};
        }
      },
      32);
  return out;
}

double structure_length(const ColorImage& photo, const Mask& forbidden) {
  const ScalarImage light = luma(photo);
  ScalarImage weight(photo.size(), 0.0f);
  for (std::size_t i = 0; i < weight.pixels().size(); ++i) weight.pixels()[i] = forbidden.pixels()[i] ? 0.0f : 1.0f;
  ScalarImage swing = masked_blur(light, weight, 40.0);  // slow shading is not structure
  for (std::size_t i = 0; i < swing.pixels().size(); ++i) swing.pixels()[i] = light.pixels()[i] - swing.pixels()[i];
  const auto product = [&](int dx, int dy) {
    double sum = 0.0, count = 0.0;
    for (int y = 0; y + dy < light.height(); y += 2) {
      const float *here = swing.row(y), *there = swing.row(y + dy) + dx;
      const float *counts = weight.row(y), *counts_there = weight.row(y + dy) + dx;
      for (int x = 0; x + dx < light.width(); x += 2) {
        if (counts[x] == 0.0f || counts_there[x] == 0.0f) continue;
        sum += here[x] * there[x];
        count += 1.0;
      }
    }
    return count > 50.0 ? sum / count : 0.0;
  };
  const double variance = product(0, 0);
  if (variance <= 0.0) return 8.0;
  const int most = std::min({64, light.width() / 4, light.height() / 4});
  for (int lag = 2; lag < most; lag = std::max(lag + 1, lag * 5 / 4)) {
    std::array<double, 2> products{};
    parallel_for(
        2, [&](int along) { products[static_cast<std::size_t>(along)] = along ? product(0, lag) : product(lag, 0); });
    if (std::max(products[0], products[1]) < 0.15 * variance) return lag;
  }
  return most;
}

}  // namespace ramify
