// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/image/quilt_search.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "ramify/core/parallel.h"
#include "ramify/image/color.h"

namespace ramify {
namespace {

constexpr float kGradientGain = 2.0f;  // gradients are smaller than colours
constexpr double kBadWeight = 8.0;     // PICTURES 12.1-1 has 2 beside an unscaled overlap; a full overlap is worth more

// Means over the n x n square whose lowest corner is the pixel; squares are cut at the frame.
template <class T>
Image<T> square_means(const Image<T>& image, int n) {
  const int w = image.width(), h = image.height();
  Image<T> across(image.size()), out(image.size());
  parallel_for(h, [&](int y) {
    for (int x = 0; x < w; ++x) {
      T sum{};
      for (int i = 0; i < n; ++i) sum = sum + image(std::min(x + i, w - 1), y);
      across(x, y) = (1.0f / n) * sum;
    }
  }, 16);
  parallel_for(h, [&](int y) {
    for (int x = 0; x < w; ++x) {
      T sum{};
      for (int i = 0; i < n; ++i) sum = sum + across(x, std::min(y + i, h - 1));
      out(x, y) = (1.0f / n) * sum;
    }
  }, 16);
  return out;
}

ScalarImage liveliness(const ColorImage& image) {
  ScalarImage out(image.size());
  parallel_for(image.height(), [&](int y) {
    for (int x = 0; x < image.width(); ++x) {
      const float here = luma(image(x, y));
      out(x, y) = kGradientGain * (std::abs(luma(image.clamped(x + 1, y)) - here) +
                                   std::abs(luma(image.clamped(x, y + 1)) - here));
    }
  }, 16);
  return out;
}

ScalarImage share_of(const Mask& mask) {
  ScalarImage out(mask.size());
  for (std::size_t i = 0; i < mask.pixels().size(); ++i) out.pixels()[i] = mask.pixels()[i] ? 1.0f : 0.0f;
  return out;
}

}  // namespace

PatchSearch::PatchSearch(const QuiltJob& job, const QuiltOptions& options, int side)
    : job_(job), options_(options), side_(side), cell_(std::max(1, side / kCells)) {
  const ColorImage color = square_means(job.source, cell_);
  const ScalarImage lively = square_means(liveliness(job.source), cell_);
  const ScalarImage bad = square_means(share_of(job.forbidden), cell_);
  std::vector<ScalarImage> guides;
  for (const GuideChannel& guide : job.guides) guides.push_back(square_means(guide.source, cell_));
  const int w = job.source.width(), h = job.source.height();
  constexpr std::size_t kAligned = 4;
  stride_ = (kFirstGuide + guides.size() + kAligned - 1) / kAligned * kAligned;
  described_ = std::make_unique_for_overwrite<float[]>(stride_ * static_cast<std::size_t>(w) * h);
  parallel_for(
      h,
      [&](int y) {
        float* to = &described_[stride_ * static_cast<std::size_t>(y) * w];
        for (int x = 0; x < w; ++x, to += stride_) {
          const Rgb& c = color(x, y);
          to[0] = c.r, to[1] = c.g, to[2] = c.b, to[3] = lively(x, y);
          to[kBad] = bad(x, y);
          for (std::size_t g = 0; g < guides.size(); ++g) to[kFirstGuide + g] = guides[g](x, y);
        }
      },
      32);
  std::array<double, 4> sum{}, square{};
  double count = 0.0;
  for (int y = 0; y < h; ++y) {
    for (int x = (3 - y % 3) % 3; x < w; x += 3) {
      const float* here = described(x, y);
      if (here[kBad] > 0.0f) continue;
      for (int k = 0; k < 4; ++k) {
        sum[k] += here[k];
        square[k] += here[k] * here[k];
      }
      count += 1.0;
    }
  }
  double variance = 0.0;
  for (int k = 0; k < 4 && count > 0.0; ++k) variance += square[k] / count - (sum[k] / count) * (sum[k] / count);
  variance_ = static_cast<float>(std::max(variance, 1e-5));
  used_ = Image<float>(job.source.width() / cell_ + 2, job.source.height() / cell_ + 2, 0.0f);
}

Rgb PatchSearch::shown(const Quilt& quilt, int x, int y, bool& known) const {
  known = true;
  if (!job_.hole(x, y)) return job_.canvas(x, y);
  const int label = quilt.label(x, y);
  if (label == kNone) {
    known = false;
    return {};
  }
  const QuiltPatch& p = quilt.patches[label];
  return job_.source(p.source_x(x), p.source_y(y));
}

PatchSearch::Target PatchSearch::read_target(const Quilt& quilt, int tx, int ty) const {
  Target target;
  target.guides.resize(job_.guides.size());
  const int w = quilt.label.width(), h = quilt.label.height();
  for (int j = 0; j < kCells; ++j) {
    for (int i = 0; i < kCells; ++i) {
      const int index = j * kCells + i, x0 = tx + i * cell_, y0 = ty + j * cell_;
      Cell& cell = target.cells[index];
      int all = 0, known_count = 0, open = 0;
      std::array<float, 4> sum{};
      for (int y = std::max(0, y0); y < std::min(h, y0 + cell_); ++y) {
        for (int x = std::max(0, x0); x < std::min(w, x0 + cell_); ++x) {
          ++all;
          open += job_.hole(x, y) != 0;
          bool known = false, right = false, below = false;
          const Rgb here = shown(quilt, x, y, known);
          if (!known) continue;
          const Rgb next = shown(quilt, std::min(x + 1, w - 1), y, right);
          const Rgb under = shown(quilt, x, std::min(y + 1, h - 1), below);
          ++known_count;
          sum[0] += here.r, sum[1] += here.g, sum[2] += here.b;
          sum[3] += kGradientGain * ((right ? std::abs(luma(next) - luma(here)) : 0.0f) +
                                     (below ? std::abs(luma(under) - luma(here)) : 0.0f));
        }
      }
      if (all == 0) continue;
      ++target.inside;
      cell.known = static_cast<float>(known_count) / all;
      cell.open = static_cast<float>(open) / all;
      for (int k = 0; k < 4 && known_count > 0; ++k) cell.value[k] = sum[k] / known_count;
      target.known += cell.known;
      if (known_count > 0 || open > 0) target.active.push_back(index);
      const int cx = std::clamp(x0 + cell_ / 2, 0, w - 1), cy = std::clamp(y0 + cell_ / 2, 0, h - 1);
      for (std::size_t g = 0; g < job_.guides.size(); ++g) target.guides[g][index] = job_.guides[g].target(cx, cy);
    }
  }
  return target;
}

// Grows cell by cell, so that most places are given up after a few.
double PatchSearch::cost(const Target& target, const QuiltPatch& patch, double limit) const {
  const int w = job_.source.width(), h = job_.source.height(), edge = cell_ - 1;
  const int cx = patch.sx + patch.fx * side_ / 2, cy = patch.sy + patch.fy * side_ / 2;
  const float used = used_(std::clamp(cx / cell_, 0, used_.width() - 1), std::clamp(cy / cell_, 0, used_.height() - 1));
  const double per_cell = 1.0 / std::max(1, target.inside);
  const double per_known = target.known > 0.0 ? 1.0 / (target.known * variance_) : 0.0;
  double sum = options_.reuse * used;
  for (const int index : target.active) {
    const Cell& cell = target.cells[index];
    const int i = index % kCells, j = index / kCells;
    const int u = patch.sx + patch.fx * i * cell_ - (patch.fx < 0 ? edge : 0);
    const int v = patch.sy + patch.fy * j * cell_ - (patch.fy < 0 ? edge : 0);
    if (u < 0 || v < 0 || u + edge >= w || v + edge >= h) {
      sum += kBadWeight * cell.open * per_cell;
    } else {
      const float* a = described(u, v);
      sum += kBadWeight * cell.open * a[kBad] * per_cell;
      if (cell.known > 0.0f) {
        float d = 0.0f;
        for (int k = 0; k < 4; ++k) d += (a[k] - cell.value[k]) * (a[k] - cell.value[k]);
        sum += cell.known * d * per_known;
      }
      for (std::size_t g = 0; g < job_.guides.size(); ++g) {
        const double d = a[kFirstGuide + g] - target.guides[g][index];
        sum += job_.guides[g].weight * d * d * per_cell;
      }
    }
    if (sum > limit) break;
  }
  return sum;
}

QuiltPatch PatchSearch::draw(int tx, int ty, Rng& rng) const {
  const int w = job_.source.width(), h = job_.source.height();
  QuiltPatch patch;
  patch.tx = tx, patch.ty = ty, patch.side = side_;
  patch.fx = options_.mirror_x && rng.below(2) ? -1 : 1;
  patch.fy = options_.mirror_y && rng.below(2) ? -1 : 1;
  int u0 = 0, v0 = 0, u1 = w - side_ + 1, v1 = h - side_ + 1;
  if (options_.nearby > 0.0) {
    const int reach = static_cast<int>(options_.nearby);
    u0 = std::clamp(tx - reach, -side_ / 2, w - side_ / 2), u1 = std::clamp(tx + reach, u0 + 1, w - side_ / 2 + 1);
    v0 = std::clamp(ty - reach, -side_ / 2, h - side_ / 2), v1 = std::clamp(ty + reach, v0 + 1, h - side_ / 2 + 1);
  }
  patch.sx = u0 + rng.below(std::max(1, u1 - u0)) + (patch.fx < 0 ? side_ - 1 : 0);
  patch.sy = v0 + rng.below(std::max(1, v1 - v0)) + (patch.fy < 0 ? side_ - 1 : 0);
  return patch;
}

// Mean squared difference to the known pixels, on every second of them.
double PatchSearch::pixel_cost(const Quilt& quilt, const QuiltPatch& patch) const {
  const int w = quilt.label.width(), h = quilt.label.height();
  const int x1 = std::min(w, patch.tx + side_), y1 = std::min(h, patch.ty + side_);
  double sum = 0.0, bad = 0.0;
  int count = 0, open = 0;
  for (int y = std::max(0, patch.ty); y < y1; y += 2) {
    for (int x = std::max(0, patch.tx) + (y / 2) % 2; x < x1; x += 2) {
      const int u = patch.source_x(x), v = patch.source_y(y);
      const bool out = !job_.source.contains(u, v);
      if (job_.hole(x, y)) {
        ++open;
        bad += out || job_.forbidden(u, v);
      }
      bool known = false;
      const Rgb here = shown(quilt, x, y, known);
      if (!known || out) continue;
      const Rgb d = here - job_.source(u, v);
      sum += d.r * d.r + d.g * d.g + d.b * d.b;
      ++count;
    }
  }
  return (count ? sum / count / variance_ : 0.0) + (open ? kBadWeight * bad / open : 0.0);
}

QuiltPatch PatchSearch::choose(const Quilt& quilt, int tx, int ty, Rng rng) const {
  const Target target = read_target(quilt, tx, ty);
  constexpr int kFinalists = 3;
  std::array<std::pair<double, QuiltPatch>, kFinalists> best;
  best.fill({std::numeric_limits<double>::infinity(), {}});
  for (int k = 0; k < options_.tries; ++k) {
    const QuiltPatch patch = draw(tx, ty, rng);
    const double c = cost(target, patch, best.back().first);
    if (c >= best.back().first) continue;
    best.back() = {c, patch};
    for (int i = kFinalists - 1; i > 0 && best[i].first < best[i - 1].first; --i) std::swap(best[i], best[i - 1]);
  }
  QuiltPatch winner = best.front().second;
  if (std::none_of(target.cells.begin(), target.cells.end(), [](const Cell& c) { return c.known > 0.0f; })) return winner;
  double lowest = std::numeric_limits<double>::infinity();
  for (const auto& [coarse, finalist] : best) {
    if (!std::isfinite(coarse)) continue;
    const double kept = coarse;  // guides and reuse still count beside the pixels
    QuiltPatch centre = finalist;
    for (int step = std::max(1, cell_ / 2); step >= 1; step /= 2) {
      QuiltPatch moved_best = centre;
      double here = pixel_cost(quilt, centre);
      for (const auto& [dx, dy] : {std::pair{-1, 0}, {1, 0}, {0, -1}, {0, 1}}) {
        QuiltPatch moved = centre;
        moved.sx += dx * step, moved.sy += dy * step;
        const double c = pixel_cost(quilt, moved);
        if (c < here) here = c, moved_best = moved;
      }
      centre = moved_best;
      if (step == 1 && here + 0.5 * kept < lowest) lowest = here + 0.5 * kept, winner = centre;
    }
  }
  return winner;
}

void PatchSearch::use(const QuiltPatch& patch) {
  const int cx = patch.sx + patch.fx * side_ / 2, cy = patch.sy + patch.fy * side_ / 2;
  const double reach = side_ / 2.0;
  const int r = static_cast<int>(reach) / cell_ + 1;
  for (int j = -r; j <= r; ++j) {
    for (int i = -r; i <= r; ++i) {
      const int x = cx / cell_ + i, y = cy / cell_ + j;
      if (used_.contains(x, y)) {
        used_(x, y) += static_cast<float>(std::max(0.0, 1.0 - std::hypot(i, j) * cell_ / reach));
      }
    }
  }
}

}  // namespace ramify
