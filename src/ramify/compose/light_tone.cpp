// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/compose/light_tone.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

namespace ramify {
namespace {

constexpr double kFoot = 0.02;                 // added to levels before they are compared by their ratio
constexpr int kBins = 8;                       // of equal length of branch, by brightness
constexpr double kLeastOdd = 0.3, kOdd = 4.0;  // log ratio; times the median deviation
constexpr double kLeastOfParent = 0.75;        // a child is dimmed to its parent's level, but no further than this
constexpr double kBadTemplate = 0.7;           // cost of a template strand that is not fit to be copied
constexpr double kBurnt = 0.85;                // level from which a core is burnt out, or a vessel as dark as they come
constexpr int kBeside = 20;     // samples of a child that lie in its parent's glow
constexpr double kLeastGain = 0.6, kMostGain = 1.6;
constexpr double kLeastTint = 0.6, kMostTint = 1.6;
constexpr double kGainSigma = 6.0;  // samples

double mean(const std::vector<double>& v) {
  return std::accumulate(v.begin(), v.end(), 0.0) / static_cast<double>(v.size());
}

// Log share of each channel in a level.
Vec3 hue_of(const Vec3& level) {
  Vec3 hue;
  for (int c = 0; c < 3; ++c)
    hue[c] = std::log((std::max(0.0, level[c]) + kFoot) / (std::max(0.0, level.mean()) + kFoot));
  return hue;
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// The photo's usual colour at each brightness.
struct ColourScale {
  std::vector<double> brightness;  // ascending
  std::vector<Vec3> hue;
  std::vector<double> deviation;  // median of the largest channel's: faint light differs in colour more than cores do

  Vec3 at(double level) const { return hue.empty() ? Vec3(Vec3::Zero()) : between(hue, level); }
  double deviation_at(double level) const { return deviation.empty() ? 0.0 : between(deviation, level); }

 private:
  template <class T>
  T between(const std::vector<T>& values, double level) const {
    const auto above = std::upper_bound(brightness.begin(), brightness.end(), level) - brightness.begin();
    if (above == 0) return values.front();
    if (above == static_cast<std::ptrdiff_t>(values.size())) return values.back();
    const double u = (level - brightness[above - 1]) / (brightness[above] - brightness[above - 1] + 1e-12);
    return (1.0 - u) * values[above - 1] + u * values[above];
  }
};

ColourScale measure_colours(const std::vector<Strand>& strands) {
  std::vector<Vec3> levels;
  for (const Strand& s : strands) {
    for (int t = s.first; t < s.count(); ++t)
      if (!s.bad[t]) levels.push_back(s.level[t]);
  }
  ColourScale scale;
  std::stable_sort(levels.begin(), levels.end(), [](const Vec3& a, const Vec3& b) { return a.sum() < b.sum(); });
  for (int bin = 0; bin < kBins && !levels.empty(); ++bin) {
    const std::size_t from = levels.size() * bin / kBins, to = std::max(from + 1, levels.size() * (bin + 1) / kBins);
    std::array<std::vector<double>, 4> values;
    for (std::size_t i = from; i < std::min(to, levels.size()); ++i) {
      for (int c = 0; c < 3; ++c) values[c].push_back(hue_of(levels[i])[c]);
      values[3].push_back(levels[i].mean());
    }
    scale.brightness.push_back(median(values[3]));
    scale.hue.emplace_back(median(values[0]), median(values[1]), median(values[2]));
    std::vector<double> deviations;
    for (std::size_t i = from; i < std::min(to, levels.size()); ++i) {
      deviations.push_back((hue_of(levels[i]) - scale.hue.back()).cwiseAbs().maxCoeff());
    }
    scale.deviation.push_back(median(deviations));
  }
  return scale;
}

// The source strand a target strand takes its brightness from.
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

void mark_odd_colours(std::vector<Strand>& strands) {
  const ColourScale usual = measure_colours(strands);
  for (Strand& s : strands) {
    for (int t = 0; t < s.count(); ++t) {
      const double level = s.level[t].mean(), most = std::max(kLeastOdd, kOdd * usual.deviation_at(level));
      if ((hue_of(s.level[t]) - usual.at(level)).cwiseAbs().maxCoeff() > most) s.bad[t] = 1;
    }
  }
}

void assign_levels(std::vector<Strand>& targets, const LightSource& source, double tip_fade, Rng rng) {
  const ColourScale usual = measure_colours(source.strands);
  for (int k = 0; k < static_cast<int>(targets.size()); ++k) {
    Strand& target = targets[k];
    Rng own = rng.child("level", static_cast<std::uint64_t>(k));
    const int chosen = template_strand(target, source, own);
    target.level.assign(target.points.size(), Vec3::Zero());
    if (chosen == kNone) continue;
    const Strand& s = source.strands[chosen];
    const double span = std::max(1, target.count() - 1 - target.first);
    std::vector<double> brightness(target.points.size());
    for (int t = 0; t < target.count(); ++t) {
      const double u = std::clamp((t - target.first) / span, 0.0, 1.0);
      brightness[t] = std::max(source.weakest,
                               s.level[s.first + static_cast<int>(std::lround(u * (s.count() - 1 - s.first)))].mean());
    }
    brightness = smooth(brightness, 6.0);
    if (target.parent != kNone) {
      // Beside a parent's glow a base was measured too faint: it is as bright as what follows.
      const int clear = std::min(target.first + kBeside, target.count() - 1);
      for (int t = 0; t < clear; ++t) brightness[t] = std::max(brightness[t], brightness[clear]);
      const double most = targets[target.parent].level[target.parent_sample].mean();
      const double share = std::clamp(most / std::max(brightness[target.first], 1e-6), kLeastOfParent, 1.0);
      for (double& v : brightness) v *= share;
    }
    for (int t = 0; t < target.count(); ++t) {
      // A free end fades out through the colours that the photo's faint branches have.
      const Vec3 colour = usual.at(brightness[t] * end_fade(target, t, tip_fade)).array().exp();
      target.level[t] = brightness[t] / colour.mean() * colour;
    }
  }
}

const Vec3& ToneGain::at(double along) const {
  const int k = static_cast<int>(std::lround(along)) - first;
  return gains[std::clamp(k, 0, static_cast<int>(gains.size()) - 1)];
}

ToneGain tone_gain(const Strand& source, int place, const Strand& target, int sample, int reach) {
  ToneGain out;
  out.first = std::max(0, sample - reach);
  const int last = std::min(target.count() - 1, sample + reach);
  for (int t = out.first; t <= last; ++t) {
    const Vec3& have = source.level[std::clamp(place + t - sample, 0, source.count() - 1)];
    const Vec3& wanted = target.level[t];
    Vec3 gain = Vec3::Ones();
    if (have.sum() > 0.0 && wanted.sum() > 0.0) {
      double all = std::clamp(wanted.mean() / have.mean(), kLeastGain, kMostGain);
      if (have.mean() > kBurnt) all = std::max(1.0, all);  // dimmed white is no light a flash has
      const Vec3 tint = (hue_of(wanted) - hue_of(have)).array().exp();
      gain = all * tint.cwiseMax(kLeastTint).cwiseMin(kMostTint);
    }
    out.gains.push_back(gain);
  }
  out.gains = smooth(out.gains, kGainSigma);
  return out;
}

}  // namespace ramify
