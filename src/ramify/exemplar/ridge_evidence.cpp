// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <cmath>

#include "ramify/exemplar/line_finder.h"
#include "ramify/image/filter.h"
#include "ramify/skeleton/thickness.h"

namespace ramify {
namespace {

constexpr double kNoiseFactor = 8.0;   // a line starts at this many times the median response
constexpr double kGlowFactor = 20.0;   // where branches glow: most of the sky is black and its median response tiny
constexpr double kLargestShare = 0.4;  // of the picture: thicker classes are background
constexpr double kLongest = 10.0;    // smallest area of a thick branch over its largest radius squared (a disc has 3.1)
constexpr double kBankReach = 3.0;   // px to both sides of a rim
constexpr double kBankShare = 0.45;  // of the contrast lies within these
constexpr double kApart = 2.65;     // contrast over the spread of the rest: that of the halves of a normal distribution
constexpr double kLowShare = 0.35;  // and goes on at this share of it (ALGORITHMS 3.3-3)
constexpr double kCloudSigma = 1.2;     // px: wider ridges count less where branches glow
constexpr double kGlowLowShare = 0.22;  // a stroke of lightning dies away at its tip

double median_positive(const ScalarImage& image, const Mask& excluded) {
  std::vector<float> values;
  for (std::size_t i = 0; i < image.pixels().size(); ++i) {
    if (image.pixels()[i] > 0.0f && (excluded.empty() || !excluded.pixels()[i])) values.push_back(image.pixels()[i]);
  }
  if (values.empty()) return 0.0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// Excluded pixels take the value of the nearest allowed pixel of their row or column, so that their rim is no line.
ScalarImage filled_from_rim(ScalarImage picture, const Mask& excluded) {
  if (excluded.empty()) return picture;
  const Image<std::uint8_t>& hole = excluded;
  for (int y = 0; y < picture.height(); ++y) {
    for (int x = 0; x < picture.width(); ++x) {
      if (!hole(x, y)) continue;
      const int reach = std::max(picture.width(), picture.height());
      for (int d = 1; d < reach; ++d) {
        bool found = false;
        for (const auto& [dx, dy] : {std::pair{d, 0}, {-d, 0}, {0, d}, {0, -d}}) {
          if (found || !hole.contains(x + dx, y + dy) || hole(x + dx, y + dy)) continue;
          picture(x, y) = picture(x + dx, y + dy);
          found = true;
        }
        if (found) break;
      }
    }
  }
  return picture;
}

// Otsu's threshold: the cut that separates two classes of values best.
float otsu_threshold(const ScalarImage& image, const Mask& excluded) {
  const auto [low, high] = std::minmax_element(image.pixels().begin(), image.pixels().end());
  const float bottom = *low, span = std::max(*high - *low, 1e-6f);
  std::array<double, 256> histogram{};
  double total = 0.0, sum = 0.0;
  for (std::size_t i = 0; i < image.pixels().size(); ++i) {
    if (!excluded.empty() && excluded.pixels()[i]) continue;
    const int bin = std::min(255, static_cast<int>((image.pixels()[i] - bottom) / span * 256.0f));
    histogram[bin] += 1.0;
    total += 1.0;
    sum += bin;
  }
  double below = 0.0, sum_below = 0.0, best = -1.0;
  int cut = 0;
  for (int bin = 0; bin < 255; ++bin) {
    below += histogram[bin];
    sum_below += bin * histogram[bin];
    if (below == 0.0 || below == total) continue;
    const double gap = sum_below / below - (sum - sum_below) / (total - below);
    const double between = below * (total - below) * gap * gap;
    if (between > best) {
      best = between;
      cut = bin;
    }
  }
  return bottom + span * (static_cast<float>(cut) + 1.0f) / 256.0f;
}

// Components that can be branches: long for their width, and not most of the picture. Clouds, corners outside a round
// field and sheets of paper are neither.
Mask without_blobs(const Mask& mask) {
  int count = 0;
  const LabelImage label = label_components(mask, true, count);
  const ScalarImage depth = distance_inside(mask);
  std::vector<double> area(static_cast<std::size_t>(count), 0.0), deepest(area);
  for (std::size_t i = 0; i < mask.pixels().size(); ++i) {
    const int k = label.pixels()[i];
    if (k == kNone) continue;
    area[k] += 1.0;
    deepest[k] = std::max(deepest[k], static_cast<double>(depth.pixels()[i]));
  }
  Mask out(mask.size());
  const double whole = static_cast<double>(mask.pixels().size());
  for (std::size_t i = 0; i < mask.pixels().size(); ++i) {
    const int k = label.pixels()[i];
    if (k == kNone || area[k] > kLargestShare * whole || area[k] < kLongest * deepest[k] * deepest[k]) continue;
    out.pixels()[i] = 255;
  }
  return out;
}

struct ToneSum {
  double n = 0.0, sum = 0.0, square = 0.0;

  void add(double v) { n += 1.0, sum += v, square += v * v; }
  double mean() const { return sum / std::max(n, 1.0); }
  double variance() const { return std::max(0.0, square / std::max(n, 1.0) - mean() * mean()); }
};

// Components with a tone of their own and with banks. Otsu cuts any picture in two: the stains of a wall are the darker
// half of its texture, and no further from the rest than one half of a normal distribution is from the other. The rim
// of a bright cloud is only where a slow change passes the threshold: across real banks the picture changes by a good
// part of what tells the component from the rest.
Mask standing_out(const Mask& mask, const ScalarImage& picture, const Mask& excluded, double apart) {
  int count = 0;
  const LabelImage label = label_components(mask, true, count);
  const Gradient inward = gradient(gaussian_blur(distance_inside(mask), 1.0));
  std::vector<ToneSum> inside(static_cast<std::size_t>(count));
  std::vector<double> step(inside.size(), 0.0), rim(step);
  ToneSum rest;
  for (int y = 0; y < mask.height(); ++y) {
    for (int x = 0; x < mask.width(); ++x) {
      const int k = label(x, y);
      if (k == kNone) {
        if (excluded.empty() || !excluded(x, y)) rest.add(picture(x, y));
        continue;
      }
      inside[k].add(picture(x, y));
      const Vec2 way(inward.dx(x, y), inward.dy(x, y));
      const bool on_rim =
          !mask.clamped(x - 1, y) || !mask.clamped(x + 1, y) || !mask.clamped(x, y - 1) || !mask.clamped(x, y + 1);
      if (!on_rim || way.norm() < 1e-3) continue;
      const Vec2 reach = kBankReach * way.normalized();
      const int u = static_cast<int>(std::lround(reach.x())), v = static_cast<int>(std::lround(reach.y()));
      if (!mask.contains(x - u, y - v) || (!excluded.empty() && excluded(x - u, y - v))) continue;
      step[k] += picture.clamped(x + u, y + v) - picture(x - u, y - v);
      rim[k] += 1.0;
    }
  }
  Mask out(mask.size());
  for (std::size_t i = 0; i < mask.pixels().size(); ++i) {
    const int k = label.pixels()[i];
    if (k == kNone || rim[k] == 0.0) continue;
    const double contrast = inside[k].mean() - rest.mean();
    const bool own_tone = std::abs(contrast) >= apart * std::sqrt(rest.variance());
    if (own_tone && step[k] / rim[k] / contrast >= kBankShare) out.pixels()[i] = 255;
  }
  return out;
}

// Two classes by Otsu; of them the part that is thicker than `core` px, regrown within the class.
Mask thick_branches(const ScalarImage& picture, bool bright, double core, const Mask& excluded, double apart) {
  const float cut = otsu_threshold(picture, excluded);
  Mask mask(picture.size());
  for (std::size_t i = 0; i < mask.pixels().size(); ++i) {
    const bool inside = (picture.pixels()[i] > cut) == bright && (excluded.empty() || !excluded.pixels()[i]);
    mask.pixels()[i] = inside ? 255 : 0;
  }
  mask = fill_small_holes(mask, static_cast<int>(4.0 * core * core));
  const Mask kernel =
      drop_small_components(threshold(distance_inside(mask), static_cast<float>(core)), static_cast<int>(4.0 * core));
  Mask opened = dilate(kernel, core + 1.0);
  for (std::size_t i = 0; i < mask.pixels().size(); ++i) {
    opened.pixels()[i] = opened.pixels()[i] && mask.pixels()[i] ? 255 : 0;
  }
  return standing_out(without_blobs(opened), picture, excluded, apart);
}

// Strokes of lightning get fainter as they get thinner; what is faint and wide is a fold of a cloud.
void calm_clouds(RidgeField& field, double sigma) {
  for (std::size_t i = 0; i < field.strength.pixels().size(); ++i) {
    field.strength.pixels()[i] /= static_cast<float>(std::max(1.0, field.sigma.pixels()[i] / sigma));
  }
}

}  // namespace

RidgeEvidence gather_evidence(const ColorImage& photo, const Mask& excluded, const TraceOptions& options,
                              const Monitor& monitor) {
  const Polarity wanted = static_cast<Polarity>(std::max(0, static_cast<int>(options.polarity) - 1));
  const ChannelChoice choice = choose_channel(photo, excluded, options.max_radius, options.channel,
                                              options.polarity == TracePolarity::Auto ? nullptr : &wanted, monitor);
  RidgeEvidence e;
  e.picture = filled_from_rim(channel_picture(photo, choice.channel), excluded);
  e.bright = choice.polarity != Polarity::Dark;
  e.glow = choice.polarity == Polarity::Glow;
  RidgeOptions ridge{e.bright, std::max(0.7, 0.8 * options.min_radius), std::max(1.0, options.max_radius)};
  const bool flatten = options.flatten && !e.glow;
  e.field = ridge_field(flatten ? flattened(e.picture, 4.0 * options.max_radius) : e.picture, ridge, monitor);
  e.high = std::max((e.glow ? kGlowFactor : kNoiseFactor) * median_positive(e.field.strength, excluded), 1e-3) /
           options.sensitivity;
  e.low = (e.glow ? kGlowLowShare : kLowShare) * e.high;
  if (e.glow) calm_clouds(e.field, kCloudSigma * std::max(1.0, options.min_radius));
  const bool areas_wanted = options.mode == TraceMode::Area;  // two classes, says the user
  e.thick = options.mode == TraceMode::Ridge
                ? Mask(photo.size())
                : thick_branches(e.picture, e.bright, areas_wanted ? options.min_radius : 0.8 * options.max_radius,
                                 excluded, areas_wanted ? 0.0 : kApart);
  monitor.check();
  e.radius = distance_inside(e.thick);
  for (std::size_t i = 0; i < e.radius.pixels().size(); ++i) {
    if (!e.thick.pixels()[i]) e.radius.pixels()[i] = e.field.sigma.pixels()[i];
  }
  return e;
}

}  // namespace ramify
