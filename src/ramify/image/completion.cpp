// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/image/completion.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <stdexcept>

#include "ramify/core/parallel.h"
#include "ramify/image/filter.h"
#include "ramify/image/gradient_blend.h"
#include "ramify/image/sample.h"

namespace ramify {
namespace {

Mask united(const Mask& a, const Mask& b) {
  Mask out = a;
  for (std::size_t i = 0; i < out.pixels().size(); ++i) {
    if (!b.empty() && b.pixels()[i]) out.pixels()[i] = 255;
  }
  return out;
}

const Rgb* shown(const QuiltJob& job, const Quilt& quilt, int label, int x, int y) {
  if (label == kNone) return job.hole(x, y) ? nullptr : &job.canvas(x, y);
  const QuiltPatch& p = quilt.patches[label];
  const int u = p.source_x(x), v = p.source_y(y);
  return job.source.contains(u, v) ? &job.source(u, v) : nullptr;
}

// The size of steps that the photo has hardly ever (99.5 % quantile), sRGB.
float sharpest_step(const QuiltJob& job) {
  std::vector<float> steps;
  for (int y = 0; y + 1 < job.source.height(); y += 2) {
    for (int x = 0; x + 1 < job.source.width(); x += 2) {
      if (job.forbidden(x, y) || job.forbidden(x + 1, y) || job.forbidden(x, y + 1)) continue;
      const Rgb &c = job.source(x, y), a = job.source(x + 1, y) - c, b = job.source(x, y + 1) - c;
      steps.push_back(std::sqrt(a.r * a.r + a.g * a.g + a.b * a.b + b.r * b.r + b.g * b.g + b.b * b.b));
    }
  }
  if (steps.empty()) return 0.0f;
  const auto last = steps.begin() + static_cast<std::ptrdiff_t>(0.995 * static_cast<double>(steps.size() - 1));
  std::nth_element(steps.begin(), last, steps.end());
  return *last;
}

// By how much the step from p to q is off: the mean of both pictures' own steps, minus the present one.
Rgb seam_offset(const QuiltJob& job, const Quilt& quilt, bool keep_edges, int px, int py, int qx, int qy) {
  const int a = quilt.label(px, py), b = quilt.label(qx, qy);
  if (a == b) return {};
  const Rgb *ap = shown(job, quilt, a, px, py), *bq = shown(job, quilt, b, qx, qy);
  if (!ap || !bq) return {};
  const Rgb *aq = shown(job, quilt, a, qx, qy), *bp = shown(job, quilt, b, px, py);
  Rgb step{};
  int count = 0;
  if (aq) step = step + (*aq - *ap), ++count;
  if (bp) step = step + (*bq - *bp), ++count;
  if (count == 0) return {};
  const Rgb off = (1.0f / count) * step - (*bq - *ap);
  if (!keep_edges) return off;
  // A large step is an edge of things (water and land), not of light: spread out it would be fog (PICTURES 12.1-6).
  constexpr float kSpread = 0.10f, kKeep = 0.25f;  // sRGB
  const float size = std::sqrt(off.r * off.r + off.g * off.g + off.b * off.b);
  return std::clamp((kKeep - size) / (kKeep - kSpread), 0.0f, 1.0f) * off;
}

// Largest distance from a pixel of the hole to a known one, px.
double widest_reach(const Mask& hole) {
  const ScalarImage depth = distance_to(invert(hole));
  float widest = 0.0f;
  for (const float d : depth.pixels()) widest = std::max(widest, d);
  return widest;
}

}  // namespace

ColorImage blend_quilt(const QuiltJob& job, const Quilt& quilt, const ColorImage& tone, double tone_reach,
                       bool keep_edges, const Monitor& monitor) {
  const int w = job.hole.width(), h = job.hole.height();
  ColorImage hard = job.canvas;
  Mask bare(job.hole.size(), 0);
  std::atomic<bool> any_bare = false;
  parallel_for(
      h,
      [&](int y) {
        for (int x = 0; x < w; ++x) {
          if (!job.hole(x, y)) continue;
          const Rgb* c = shown(job, quilt, quilt.label(x, y), x, y);
          if (c)
            hard(x, y) = *c;
          else
            bare(x, y) = 255, any_bare = true;
        }
      },
      32);
  if (any_bare) hard = membrane(hard, bare, monitor.stage("membrane", 0.0, 0.2));
  // Where the photo has no hard edges itself (a sky), no step is an edge of things.
  constexpr float kHard = 0.1f;  // sRGB
  keep_edges = keep_edges && sharpest_step(job) > kHard;
  BlendProblem problem;
  problem.hole = job.hole;
  problem.offset_right = ColorImage(job.hole.size());
  problem.offset_down = ColorImage(job.hole.size());
  parallel_for(h, [&](int y) {
    for (int x = 0; x < w; ++x) {
      if (x + 1 < w) problem.offset_right(x, y) = seam_offset(job, quilt, keep_edges, x, y, x + 1, y);
      if (y + 1 < h) problem.offset_down(x, y) = seam_offset(job, quilt, keep_edges, x, y, x, y + 1);
    }
  }, 16);
  monitor.report(0.3);
  if (!tone.empty()) {
    const ColorImage slow = gaussian_blur(hard, tone_reach);
    problem.tone = ColorImage(job.hole.size());
    parallel_for(
        h,
        [&](int y) {
          for (int x = 0; x < w; ++x) problem.tone(x, y) = tone(x, y) - slow(x, y);
        },
        32);
    problem.screen = 1.0 / (tone_reach * tone_reach);
  }
  const ColorImage change = solve_blend(problem, monitor.stage("blend", 0.3, 1.0));
  parallel_for(
      h,
      [&](int y) {
        for (int x = 0; x < w; ++x) {
          if (job.hole(x, y)) hard(x, y) = hard(x, y) + change(x, y);
        }
      },
      32);
  return hard;
}

ColorImage tone_through_hole(const ColorImage& image, const Mask& hole, double sigma, const Monitor& monitor) {
  // Slow tones need few pixels. The rim is smoothed first, or every grain of it would run into the hole as a streak.
  const int factor = std::clamp(static_cast<int>(sigma / 4.0), 1, 8);
  const Size small{(image.width() + factor - 1) / factor, (image.height() + factor - 1) / factor};
  ColorImage calm(small);
  ScalarImage weight(small, 0.0f);
  Mask open(small, 255);
  parallel_for(small.height, [&](int y) {
    for (int x = 0; x < small.width; ++x) {
      Rgb sum{};
      int count = 0;
      for (int v = y * factor; v < std::min(image.height(), (y + 1) * factor); ++v) {
        for (int u = x * factor; u < std::min(image.width(), (x + 1) * factor); ++u) {
          if (!hole(u, v)) sum = sum + image(u, v), ++count;
        }
      }
      if (2 * count < factor * factor) continue;
      calm(x, y) = (1.0f / count) * sum;
      weight(x, y) = 1.0f;
      open(x, y) = 0;
    }
  }, 4);
  calm = masked_blur(calm, weight, std::min(sigma / 3.0, 8.0) / factor);
  return resize(gaussian_blur(membrane(calm, open, monitor), sigma / factor), image.size());
}

std::vector<OptionField> describe(CompletionOptions& o) {
  std::vector<OptionField> fields = describe(o.quilt);
  fields.push_back(number("tone-reach", o.tone_reach, 5.0, 10000.0, "px",
                          "tones slower than this follow the hole's surroundings, not the patches"));
  return fields;
}

Completion complete(const ColorImage& image, const Mask& hole, const Mask& forbidden, const CompletionOptions& options,
                    Rng rng, const Monitor& monitor) {
  const CancelScope scope(monitor);
  if (hole.size() != image.size() || (!forbidden.empty() && forbidden.size() != image.size())) {
    throw std::invalid_argument("complete: picture and masks differ in size");
  }
  Completion result;
  if (std::none_of(hole.pixels().begin(), hole.pixels().end(), [](std::uint8_t v) { return v != 0; })) {
    result.color = image;
  }
  QuiltJob job;
  job.source = image;
  job.forbidden = united(hole, forbidden);
  job.canvas = image;
  job.hole = hole;
  Quilt quilt;
  if (result.color.empty()) {
    // Through a wide hole the surroundings say nothing about tones: there the patches decide.
    const double wide = widest_reach(hole);
    ColorImage tone;
    if (wide < 2.0 * options.tone_reach) {
      tone = tone_through_hole(image, hole, options.tone_reach, monitor.stage("tone", 0.0, 0.1));
    }
    quilt = make_quilt(job, options.quilt, rng, monitor.stage("quilt", 0.1, 0.8));
    result.color = blend_quilt(job, quilt, tone, options.tone_reach, tone.empty(), monitor.stage("blend", 0.8, 1.0));
  } else {
    quilt.label = LabelImage(hole.size(), kNone);
  }
  result.source = quilt_sources(quilt);
  parallel_for(
      hole.height(),
      [&](int y) {
        for (int x = 0; x < hole.width(); ++x) {
          if (!hole(x, y)) result.source(x, y) = {static_cast<float>(x), static_cast<float>(y)};
        }
      },
      32);
  return result;
}

}  // namespace ramify
