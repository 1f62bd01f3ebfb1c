// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/compose/light_source.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

#include "ramify/compose/light_tone.h"
#include "ramify/core/error.h"
#include "ramify/core/parallel.h"
#include "ramify/image/filter.h"
#include "ramify/image/sample.h"

namespace ramify {
namespace {

constexpr double kThin = 3.2;         // px; below, a bright surround shows more than the branch
constexpr double kBrightHalo = 0.06;  // linear light
constexpr double kHaloCost = 8.0;
constexpr double kCourseSigma =
    4.0;  // samples; the line follows the branch, not its finest bends, which are copied as they are
constexpr double kLeastProminence = 0.4;
constexpr double kStraight = 0.75;  // chord per arc
constexpr double kWiderThanUsual = 1.35;
constexpr int kUsualReach = 40;  // samples
constexpr float kWhite = 1.0f;   // linear light; for absorbing layers a transmission of 0.37, dark enough
constexpr int kClean = 4;        // samples on both sides that must be good

double strength(const Rgb& v) {
  return (v.r + v.g + v.b) / 3.0;
}

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
  shift = smooth(shift, kCourseSigma);
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

// Turns back within its own width, or is suddenly much wider: a knot of the branch or a fault of the trace, and nothing
// that could be laid elsewhere.
bool tangled(const Strand& strand, int t) {
  const int reach = static_cast<int>(2.0 * strand.radii[t]) + 6;
  const int a = std::max(0, t - reach), b = std::min(strand.count() - 1, t + reach);
  if ((strand.points[b] - strand.points[a]).norm() < kStraight * (b - a)) return true;
  std::vector<double> near(strand.radii.begin() + std::max(0, t - kUsualReach),
                           strand.radii.begin() + std::min(strand.count(), t + kUsualReach + 1));
  const auto middle = near.begin() + static_cast<std::ptrdiff_t>(near.size() / 2);
  std::nth_element(near.begin(), middle, near.end());
  return strand.radii[t] > kWiderThanUsual * *middle;
}

// Runs beside another strand within its own width for longer than a crossing or a fork does.
bool doubled(const std::vector<Strand>& strands, int own, int t) {
  const Vec2& p = strands[own].points[t];
  const double r = strands[own].radii[t];
  for (int k = 0; k < static_cast<int>(strands.size()); ++k) {
    if (k == own) continue;
    int beside = 0;
    for (int u = 0; u < strands[k].count(); u += 2) {
      const double d = (strands[k].points[u] - p).squaredNorm();
      if (d < r * r)
        beside += 2;
      else if (d > 1e4)
        u += 40;  // samples are 1 px apart
    }
    if (beside > 2.0 * r + 1.0) return true;
  }
  return false;
}

// How much stronger the layer is on the branch than in the clear beside it, as a share: little where the plate errs by
// as much as the branch differs, and what would be copied is the error.
std::vector<double> prominence(const Strand& strand, const LightLayer& layer, const LabelImage& labels) {
  std::vector<double> out(strand.points.size());
  for (int t = 0; t < strand.count(); ++t) {
    double beside = 0.0;
    int count = 0;
    for (const double side : {-1.0, 1.0}) {
      for (const double gap : {3.0, 5.0, 7.0}) {
        const Vec2 p = strand.points[t] + side * (1.5 * strand.radii[t] + gap) * strand.normals[t];
        if (labels.clamped(static_cast<int>(std::lround(p.x())), static_cast<int>(std::lround(p.y()))) != 0) continue;
        beside += strength(sample_bilinear(layer.value, p)), ++count;
      }
    }
    const double level = strand.level[t].mean();
    out[t] = count > 0 && level > 0.0 ? 1.0 - beside / count / level : 1.0;
  }
  return smooth(out, 4.0);
}

void mark_bad(Strand& strand, double weakest, const Mask& unusable, const std::vector<double>& prominence) {
  strand.bad.assign(strand.points.size(), 0);
  for (int t = 0; t < strand.count(); ++t) {
    const Vec2& p = strand.points[t];
    const int x = static_cast<int>(std::lround(p.x())), y = static_cast<int>(std::lround(p.y()));
    const bool off = x < 0 || y < 0 || (!unusable.empty() && (!unusable.contains(x, y) || unusable(x, y)));
    strand.bad[t] = off || strand.level[t].mean() < weakest || prominence[t] < kLeastProminence || tangled(strand, t);
  }
}

bool clean_around(const Strand& strand, int t) {
  for (int k = std::max(0, t - kClean); k <= std::min(strand.count() - 1, t + kClean); ++k) {
    if (strand.bad[k]) return false;
  }
  return true;
}

std::vector<SourceSpot> find_spots(const std::vector<Strand>& strands, const LightLayer& layer,
                                   const LightRules& rules) {
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
  parallel_for(static_cast<int>(strands.size()), [&](int k) {
    mark_bad(strands[k], source.weakest, unusable, prominence(strands[k], layer, source.labels));
    for (int t = 0; t < strands[k].count(); ++t) strands[k].bad[t] |= doubled(strands, k, t);
  });
  mark_odd_colours(strands);
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
  for (std::size_t i = 0; i < covered.pixels().size(); ++i)
    source.cover.pixels()[i] = covered.pixels()[i] ? 1.0f : 0.0f;
  source.cover = gaussian_blur(source.cover, 0.8);
  source.strands = std::move(strands);
  source.spots = find_spots(source.strands, layer, rules);
  if (source.spots.empty()) {
    throw InputError("exemplar",
                     "no branch of the photo stands out from its background, so there is nothing to copy; "
                     "check the annotation, or try --composite paste");
  }
  return source;
}

}  // namespace ramify
