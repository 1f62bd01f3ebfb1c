// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/compose/light_source.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

#include "ramify/core/error.h"
#include "ramify/core/parallel.h"
#include "ramify/image/filter.h"
#include "ramify/image/sample.h"

namespace ramify {
namespace {

constexpr double kThin = 3.2;          // px; below, a bright surround shows more than the branch
constexpr double kBrightHalo = 0.06;   // linear light
constexpr double kHaloCost = 8.0;
constexpr double kOddHue = 0.6;         // log ratio
constexpr double kLeastOfParent = 0.75; // a child is dimmed to its parent's level, but no further than this
constexpr double kBadTemplate = 0.7;    // cost of a template strand that is not fit to be copied
constexpr float kWhite = 1.0f;          // linear light; for absorbing layers a transmission of 0.37, dark enough
constexpr int kClean = 4;              // samples on both sides that must be good

double strength(const Rgb& v) { return (v.r + v.g + v.b) / 3.0; }

double mean(const std::vector<double>& v) { return std::accumulate(v.begin(), v.end(), 0.0) / static_cast<double>(v.size()); }

// Moves a strand's samples to the centre of gravity of the layer across it; other strands do not pull.
void recentre(Strand& strand, int own, const LightLayer& layer, const LabelImage& labels) {
  constexpr int kHalf = 20;
  std::vector<double> shift(strand.points.size());
  for (int t = 0; t < strand.count(); ++t) {
    const double reach = std::clamp(strand.radii[t], 2.0, 14.0) + 2.0;
    std::array<double, 2 * kHalf + 1> v{};
    for (int k = -kHalf; k <= kHalf; ++k) {
      const Vec2 p = strand.points[t] + strand.normals[t] * (reach * k / kHalf);
      const int label = labels.clamped(static_cast<int>(std::lround(p.x())), static_cast<int>(std::lround(p.y())));
      v[k + kHalf] = label == 0 || label == own ? strength(sample_bilinear(layer.value, p)) : 0.0;
    }
    const double top = *std::max_element(v.begin(), v.end());
    double sum = 0.0, moment = 0.0;
    for (int k = -kHalf; k <= kHalf; ++k) {
      const double w = std::max(0.0, v[k + kHalf] - 0.3 * top);
      sum += w, moment += w * reach * k / kHalf;
    }
    const double most = std::min(3.0, 1.0 + 0.5 * strand.radii[t]);
    shift[t] = sum > 0.0 ? std::clamp(moment / sum, -most, most) : 0.0;
  }
  shift = smooth(shift, 2.0);
  for (int t = 0; t < strand.count(); ++t) strand.points[t] += strand.normals[t] * shift[t];
  strand.normals = line_normals(strand.points);
}

// The strongest of three samples across the centre line: a sub-pixel shift must not read as darkness. Beyond white all
// light looks alike.
std::vector<Vec3> measure_level(const Strand& strand, const LightLayer& layer) {
  std::vector<Vec3> level(strand.points.size(), Vec3::Zero());
  for (int t = 0; t < strand.count(); ++t) {
    for (const double u : {-1.0, 0.0, 1.0}) {
      const Rgb v = sample_bilinear(layer.value, strand.points[t] + u * strand.normals[t]);
      const Vec3 seen(std::min(v.r, kWhite), std::min(v.g, kWhite), std::min(v.b, kWhite));
      if (seen.sum() > level[t].sum()) level[t] = seen;
    }
  }
  return smooth(level, 4.0);
}

double median_level(const std::vector<Strand>& strands) {
  std::vector<double> all;
  for (const Strand& s : strands) {
    for (int t = s.first; t < s.count(); ++t) all.push_back(s.level[t].mean());
  }
  if (all.empty()) return 0.0;
  std::nth_element(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(all.size() / 2), all.end());
  return all[all.size() / 2];
}

// Turns by more than a right angle within its own width: a fault of the trace, or nothing that could be laid elsewhere.
bool folds_back(const Strand& strand, int t) {
  const int reach = std::max(3, static_cast<int>(std::lround(strand.radii[t])));
  const int a = std::max(0, t - reach), b = std::min(strand.count() - 1, t + reach);
  return strand.normals[a].dot(strand.normals[b]) < 0.0;
}

void mark_bad(Strand& strand, double weakest, const Mask& unusable) {
  strand.bad.assign(strand.points.size(), 0);
  for (int t = 0; t < strand.count(); ++t) {
    const Vec2& p = strand.points[t];
    const int x = static_cast<int>(std::lround(p.x())), y = static_cast<int>(std::lround(p.y()));
    const bool off = x < 0 || y < 0 || (!unusable.empty() && (!unusable.contains(x, y) || unusable(x, y)));
    strand.bad[t] = off || strand.level[t].mean() < weakest || folds_back(strand, t);
  }
}

// Log share of each channel in a level.
Vec3 hue_of(const Vec3& level) {
  Vec3 hue;
  for (int c = 0; c < 3; ++c) hue[c] = std::log((std::max(0.0, level[c]) + 0.02) / (std::max(0.0, level.mean()) + 0.02));
  return hue;
}

// A stretch of quite another colour than the rest is not the branch's light but an error of the plate behind it (a bright
// cloud), and would be seen wherever it is laid.
void mark_odd_hues(std::vector<Strand>& strands) {
  std::array<std::vector<double>, 3> all;
  for (const Strand& s : strands) {
    for (int t = s.first; t < s.count(); ++t) {
      if (!s.bad[t]) for (int c = 0; c < 3; ++c) all[c].push_back(hue_of(s.level[t])[c]);
    }
  }
  if (all[0].empty()) return;
  Vec3 usual;
  for (int c = 0; c < 3; ++c) {
    const auto middle = all[c].begin() + static_cast<std::ptrdiff_t>(all[c].size() / 2);
    std::nth_element(all[c].begin(), middle, all[c].end());
    usual[c] = *middle;
  }
  for (Strand& s : strands) {
    for (int t = 0; t < s.count(); ++t) {
      if ((hue_of(s.level[t]) - usual).cwiseAbs().maxCoeff() > kOddHue) s.bad[t] = 1;
    }
  }
}

bool clean_around(const Strand& strand, int t) {
  for (int k = std::max(0, t - kClean); k <= std::min(strand.count() - 1, t + kClean); ++k) {
    if (strand.bad[k]) return false;
  }
  return true;
}

std::vector<SourceSpot> find_spots(const std::vector<Strand>& strands, const LightLayer& layer, const LightRules& rules) {
  std::vector<SourceSpot> spots;
  for (int k = 0; k < static_cast<int>(strands.size()); ++k) {
    const Strand& s = strands[k];
    for (int t = s.first + 2; t < s.count();) {
      if (clean_around(s, t)) {
        double penalty = 0.0;
        if (!layer.glow.empty() && s.radii[t] < kThin) {
          penalty = kHaloCost * std::max(0.0, strength(sample_bilinear(layer.glow, s.points[t])) - kBrightHalo);
        }
        spots.push_back({k, t, false, penalty});
        spots.push_back({k, t, true, penalty});
      }
      t += std::max(1, static_cast<int>(0.25 * surround_radius(s.radii[t], rules.surround_factor, rules.surround_cap)));
    }
  }
  return spots;
}

// The source strand a target strand takes its level from.
int template_strand(const Strand& target, const LightSource& source, Rng& rng) {
  const double r = mean(target.radii), length = target.count() - target.first;
  int best = kNone;
  double best_cost = std::numeric_limits<double>::infinity();
  for (int k = 0; k < static_cast<int>(source.strands.size()); ++k) {
    const Strand& s = source.strands[k];
    const double noise = 0.1 * rng.uniform();
    const auto good = std::count(s.bad.begin() + s.first, s.bad.end(), 0);
    const double share_bad = 1.0 - static_cast<double>(good) / (s.count() - s.first);
    const double cost = std::abs(std::log(mean(s.radii) / r)) +
                        0.5 * std::abs(std::log((s.count() - s.first) / length)) + kBadTemplate * share_bad + noise;
    if (cost < best_cost) best_cost = cost, best = k;
  }
  return best;
}

}  // namespace

LightSource make_light_source(std::vector<Strand> strands, const LightLayer& layer, const Mask& shadow,
                              const Mask& unusable, const LightRules& rules) {
  LightSource source;
  const Size size = layer.value.size();
  source.labels = strand_labels(strands, size, 1.2, 2.0);
  parallel_for(static_cast<int>(strands.size()), [&](int k) {
    for (int pass = 0; pass < 2; ++pass) recentre(strands[k], k + 1, layer, source.labels);
    strands[k].level = measure_level(strands[k], layer);
  });
  source.weakest = rules.weak * median_level(strands);
  for (Strand& s : strands) mark_bad(s, source.weakest, unusable);
  mark_odd_hues(strands);
  source.labels = strand_labels(strands, size, 1.2, 2.0);
  Mask covered = strand_mask(strands, size, 1.35, 2.5);
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      if (shadow.empty() || !shadow(x, y)) continue;
      covered(x, y) = 255;
      if (source.labels(x, y) == 0) source.labels(x, y) = kForeignLabel;
    }
  }
  source.cover = ScalarImage(size);
  for (std::size_t i = 0; i < covered.pixels().size(); ++i) source.cover.pixels()[i] = covered.pixels()[i] ? 1.0f : 0.0f;
  source.cover = gaussian_blur(source.cover, 0.8);
  source.strands = std::move(strands);
  source.spots = find_spots(source.strands, layer, rules);
  if (source.spots.empty()) {
    throw InputError("exemplar", "no branch of the photo stands out from its background, so there is nothing to copy; "
                                 "check the annotation, or try --composite paste");
  }
  return source;
}

void assign_levels(std::vector<Strand>& targets, const LightSource& source, Rng rng) {
  for (int k = 0; k < static_cast<int>(targets.size()); ++k) {
    Strand& target = targets[k];
    Rng own = rng.child("level", static_cast<std::uint64_t>(k));
    const int chosen = template_strand(target, source, own);
    target.level.assign(target.points.size(), Vec3::Zero());
    if (chosen == kNone) continue;
    const Strand& s = source.strands[chosen];
    const double span = std::max(1, target.count() - 1 - target.first);
    for (int t = 0; t < target.count(); ++t) {
      const double u = std::clamp((t - target.first) / span, 0.0, 1.0);
      target.level[t] = s.level[s.first + static_cast<int>(std::lround(u * (s.count() - 1 - s.first)))];
    }
    target.level = smooth(target.level, 6.0);
    for (Vec3& v : target.level) v *= std::max(1.0, source.weakest / std::max(v.mean(), 1e-6));
    if (target.parent == kNone) continue;
    const double most = targets[target.parent].level[target.parent_sample].mean();
    const double start = target.level[target.first].mean();
    const double share = std::max(kLeastOfParent, most / std::max(start, 1e-6));
    if (share < 1.0) for (Vec3& v : target.level) v *= share;
  }
}

}  // namespace ramify
