// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/compose/light_layer.h"

#include <algorithm>
#include <cmath>

#include "ramify/core/parallel.h"
#include "ramify/image/color.h"
#include "ramify/image/filter.h"

namespace ramify {
namespace {

constexpr float kClipped = 245.0f / 255.0f;  // a channel above is burnt out
constexpr float kDim = 200.0f / 255.0f;      // a channel below lets all that is behind through
constexpr float kLeastApart = 0.2f;          // linear light; a core is opaque from twice this above what is behind it
constexpr float kClippedLight = 1.0f;        // linear light such a core is given on top (PICTURES 12.3-4)
constexpr float kLogFloor = 3.0f / 255.0f;   // keeps ratios finite and quiet in the dark
constexpr double kGainSigma = 30.0;          // px
constexpr float kGainFoot = 0.01f;           // weighted light squared: where there is no glow to measure the gain is 1
constexpr int kWidthClasses = 5;
constexpr float kDark = 0.03f;  // linear light
constexpr float kNotBright = 0.15f, kBright = 0.35f;  // linear light of a plate whose errors exceed the glow before it
constexpr float kGainLow = 0.1f, kGainHigh = 1.5f;
constexpr float kCoreKept = 0.8f;    // share of the glow within a core that goes with the core: it is bright by itself
constexpr double kPlateSigma = 3.0;  // px; the plate's own grain must not enter the layer
constexpr float kTouched = 0.5f / 255.0f;  // the plate differs from the photo by more: inside a hole

template <class Body>
void for_pixels(Size size, const Body& body) {
  parallel_for(
      size.height,
      [&](int y) {
        for (int x = 0; x < size.width; ++x) body(x, y);
      },
      32);
}

Mask hole_of(const ColorImage& photo, const ColorImage& plate) {
  Mask hole(photo.size(), 0);
  for_pixels(photo.size(), [&](int x, int y) {
    const Rgb d = photo(x, y) - plate(x, y);
    if (std::max({std::abs(d.r), std::abs(d.g), std::abs(d.b)}) > kTouched) hole(x, y) = 255;
  });
  return hole;
}

// 0..1 per channel: well inside a burnt-out area, where the photo knows only that there was more light.
ColorImage burnt_out(const ColorImage& photo, const ColorImage& plate) {
  ColorImage burnt(photo.size());
  for_pixels(photo.size(), [&](int x, int y) {
    for (int c = 0; c < 3; ++c) burnt(x, y)[c] = photo(x, y)[c] >= kClipped && plate(x, y)[c] < kClipped ? 1.0f : 0.0f;
  });
  burnt = gaussian_blur(burnt, 0.7);
  for (Rgb& v : burnt.pixels())
    for (int c = 0; c < 3; ++c) v[c] = std::max(0.0f, 2.0f * v[c] - 1.0f);
  return burnt;
}

// 0..1 within the branches: how near the brightest channel is to burning out. A photo saturates: a core that burns out
// looks the same before a black sky and before a bright cloud, so what is behind it neither adds to it nor may be taken
// off. A cloud that burns out by itself is no core.
ScalarImage opaque_core(const ColorImage& photo, const ColorImage& plate, const std::vector<Strand>& strands) {
  ScalarImage opaque = core_share(strands, photo.size());
  for_pixels(photo.size(), [&](int x, int y) {
    const Rgb& v = photo(x, y);
    const float apart = linear_from_srgb(luma(v)) - linear_from_srgb(luma(plate(x, y)));
    opaque(x, y) *= std::clamp((std::max({v.r, v.g, v.b}) - kDim) / (kClipped - kDim), 0.0f, 1.0f) *
                    std::clamp((apart - kLeastApart) / kLeastApart, 0.0f, 1.0f);
  });
  return opaque;
}

ColorImage emitted(const ColorImage& photo, const ColorImage& plate, const ScalarImage& opaque) {
  const ColorImage burnt = burnt_out(photo, plate);
  ColorImage out(photo.size());
  for_pixels(photo.size(), [&](int x, int y) {
    for (int c = 0; c < 3; ++c) {
      const float light = linear_from_srgb(photo(x, y)[c]) - (1.0f - opaque(x, y)) * linear_from_srgb(plate(x, y)[c]);
      out(x, y)[c] = std::max(0.0f, light) + kClippedLight * opaque(x, y) * burnt(x, y)[c];
    }
  });
  return out;
}

ScalarImage as_scalar(const Mask& mask) {
  ScalarImage out(mask.size());
  for (std::size_t i = 0; i < mask.pixels().size(); ++i) out.pixels()[i] = mask.pixels()[i] / 255.0f;
  return out;
}

// Glow is measured off the branches, and best in the dark: before a bright cloud a fitted plate errs by more than the
// glow.
ScalarImage fit_weight(const ColorImage& plate, const Mask& branches) {
  ScalarImage weight(plate.size());
  for_pixels(plate.size(), [&](int x, int y) {
    const float behind = linear_from_srgb(luma(plate(x, y)));
    weight(x, y) = branches(x, y) ? 0.0f : 1.0f / ((kDark + behind) * (kDark + behind));
  });
  return weight;
}

// How the photo's glow departs from the model in the large: the share of it that is there, weighted.
ScalarImage glow_gain(const ColorImage& light, const ColorImage& glow, const ScalarImage& weight) {
  ColorImage products(light.size());  // light * glow, glow^2, and nothing
  for_pixels(light.size(), [&](int x, int y) {
    for (int c = 0; c < 3; ++c) {
      products(x, y).r += weight(x, y) * light(x, y)[c] * glow(x, y)[c];
      products(x, y).g += weight(x, y) * glow(x, y)[c] * glow(x, y)[c];
    }
  });
  products = gaussian_blur(products, kGainSigma);
  ScalarImage gain(light.size());
  for_pixels(light.size(), [&](int x, int y) {
    const Rgb& p = products(x, y);
    gain(x, y) = std::clamp((p.r + kGainFoot) / (p.g + kGainFoot), kGainLow, kGainHigh);
  });
  return gain;
}

// How strongly branches glow by their width. Each width's own glow must be told from that of a thicker branch beside
// it, so all are fitted at once.
std::vector<std::pair<double, double>> fit_gain_of_radius(const GlowModel& model, const ColorImage& core,
                                                          const ColorImage& light, const ScalarImage& weight,
                                                          const std::vector<Strand>& strands) {
  double low = 1e9, high = 0.0;
  for (const Strand& s : strands)
    for (const double r : s.radii) low = std::min(low, r), high = std::max(high, r);
  if (high <= 0.0) return {};
  const int classes = high < 1.5 * low ? 1 : kWidthClasses;
  const double step = std::log(high / low) / classes + 1e-9;
  const auto class_of = [&](double r) {
    return std::clamp(static_cast<int>(std::log(r / low) / step), 0, classes - 1);
  };
  std::vector<std::pair<double, double>> out;
  std::vector<ColorImage> glows;
  Mask taken(core.size(), 0);
  for (int k = classes - 1; k >= 0; --k) {  // thick ones first: where branches overlap the light is theirs
    std::vector<Strand> of_class;
    double sum = 0.0;
    int count = 0;
    for (const Strand& s : strands) {
      Strand part;
      for (int t = 0; t < s.count(); ++t) {
        if (class_of(s.radii[t]) != k) continue;
        part.points.push_back(s.points[t]), part.radii.push_back(s.radii[t]);
        sum += s.radii[t], ++count;
      }
      if (!part.points.empty()) of_class.push_back(std::move(part));
    }
    if (count == 0) continue;
    const Mask here = strand_mask(of_class, core.size(), 1.3, 1.0);
    ColorImage own(core.size());
    for_pixels(core.size(), [&](int x, int y) {
      if (here(x, y) && !taken(x, y)) own(x, y) = core(x, y);
    });
    for (std::size_t i = 0; i < taken.pixels().size(); ++i) taken.pixels()[i] |= here.pixels()[i];
    out.emplace_back(sum / count, 1.0);
    glows.push_back(render_glow(model, own));
  }
  const std::vector<double> gains = fit_gains(glows, light, weight);
  for (std::size_t i = 0; i < gains.size(); ++i) out[i].second = std::clamp(gains[i], 0.0, 2.0 * kGainHigh);
  std::reverse(out.begin(), out.end());
  return out;
}

ColorImage absorbed(const ColorImage& photo, const ColorImage& plate, const Mask& hole, bool brighter) {
  const ColorImage calm = gaussian_blur(plate, kPlateSigma);
  const float sign = brighter ? -1.0f : 1.0f;
  ColorImage out(photo.size());
  for_pixels(photo.size(), [&](int x, int y) {
    if (!hole(x, y)) return;
    for (int c = 0; c < 3; ++c) {
      const float behind = std::max(0.0f, calm(x, y)[c]), seen = std::max(0.0f, photo(x, y)[c]);
      out(x, y)[c] = sign * std::log((behind + kLogFloor) / (seen + kLogFloor));
    }
  });
  return out;
}

}  // namespace

ScalarImage core_share(const std::vector<Strand>& strands, Size size) {
  ScalarImage share(size);
  const Mask mask = strand_mask(strands, size, 1.0, 0.5);
  for (std::size_t i = 0; i < mask.pixels().size(); ++i) share.pixels()[i] = mask.pixels()[i] / 255.0f;
  return gaussian_blur(share, 0.7);
}

ScalarImage kept_glow_share(const std::vector<Strand>& strands, Size size) { return strand_share(strands, size, 0.5); }

LightLayer make_light_layer(const ColorImage& photo, const ColorImage& plate, const std::vector<Strand>& strands,
                            CompositeMode mode, bool brighter) {
  LightLayer layer;
  layer.mode = mode;
  layer.brighter = brighter;
  if (mode != CompositeMode::Emit) {
    const Mask hole = hole_of(photo, plate);
    layer.value = absorbed(photo, plate, hole, brighter);
    layer.inside = as_scalar(hole);
    return layer;
  }
  layer.opaque = opaque_core(photo, plate, strands);
  const ColorImage light = emitted(photo, plate, layer.opaque);
  const Mask branches = strand_mask(strands, photo.size(), 1.3, 1.0);
  ColorImage core(photo.size());
  for_pixels(photo.size(), [&](int x, int y) {
    if (branches(x, y))
      for (int c = 0; c < 3; ++c) core(x, y)[c] = std::min(1.0f, light(x, y)[c]);
  });
  const ScalarImage around = fit_weight(plate, strand_mask(strands, photo.size(), 1.5, 6.0));
  layer.glow_model = fit_glow(core, light, around);
  layer.glow_gain = glow_gain(light, render_glow(layer.glow_model, core), around);
  const ColorImage plain = core;
  for_pixels(photo.size(), [&](int x, int y) { core(x, y) = layer.glow_gain(x, y) * core(x, y); });
  layer.glow_model = fit_glow(core, light, around);
  layer.glow = render_glow(layer.glow_model, core);
  layer.gain_of_radius = fit_gain_of_radius(layer.glow_model, plain, light, around, strands);
  const ScalarImage kept = kept_glow_share(strands, photo.size()), inside = core_share(strands, photo.size());
  layer.value = ColorImage(photo.size());
  for_pixels(photo.size(), [&](int x, int y) {
    const float behind = linear_from_srgb(luma(plate(x, y)));
    const float trusted = std::clamp((kBright - behind) / (kBright - kNotBright), 0.0f, 1.0f);
    const float share = inside(x, y) + (1.0f - inside(x, y)) * trusted;
    for (int c = 0; c < 3; ++c) {
      layer.value(x, y)[c] = share * std::max(0.0f, light(x, y)[c] - (1.0f - kCoreKept * kept(x, y)) * layer.glow(x, y)[c]);
    }
  });
  return layer;
}

ColorImage apply_light(const LightLayer& layer, const ColorImage& background, const ColorImage& value,
                       const ColorImage& core, const ScalarImage& inside, const ScalarImage& opaque) {
  ColorImage out(background.size());
  if (layer.mode == CompositeMode::Emit) {
    const ColorImage glow = render_glow(layer.glow_model, core);
    for_pixels(out.size(), [&](int x, int y) {
      for (int c = 0; c < 3; ++c) {
        const float around = (1.0f - kCoreKept * inside(x, y)) * glow(x, y)[c];
        const float light = std::max(glow(x, y)[c], value(x, y)[c] + around);  // never darker than the glow alone
        const float behind = linear_from_srgb(background(x, y)[c]);
        const float seen = std::max(behind, (1.0f - opaque(x, y)) * behind + light);  // light never darkens
        out(x, y)[c] = std::clamp(srgb_from_linear(seen), 0.0f, 1.0f);
      }
    });
    return out;
  }
  const float sign = layer.brighter ? 1.0f : -1.0f;
  const ColorImage calm = gaussian_blur(background, kPlateSigma);
  for_pixels(out.size(), [&](int x, int y) {
    const Rgb behind = (1.0f - inside(x, y)) * background(x, y) + inside(x, y) * calm(x, y);
    for (int c = 0; c < 3; ++c) {
      const float through = (behind[c] + kLogFloor) * std::exp(sign * value(x, y)[c]) - kLogFloor;
      out(x, y)[c] = std::clamp(through, 0.0f, 1.0f);
    }
  });
  return out;
}

}  // namespace ramify
