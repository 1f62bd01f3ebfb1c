// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/compose/light_layer.h"

#include <algorithm>
#include <cmath>

#include "ramify/core/parallel.h"
#include "ramify/image/color.h"
#include "ramify/image/filter.h"

namespace ramify {
namespace {

constexpr float kClipped = 245.0f / 255.0f;   // a channel above is burnt out
constexpr float kClippedLight = 1.0f;         // linear light such a core is given on top (PICTURES 12.3-4)
constexpr float kLogFloor = 3.0f / 255.0f;    // keeps ratios finite and quiet in the dark
constexpr double kGainSigma = 30.0;           // px
constexpr float kGainFoot = 0.01f;             // weighted light squared: where there is no glow to measure the gain is 1
constexpr float kDark = 0.03f;                 // linear light
constexpr float kGainLow = 0.1f, kGainHigh = 1.5f;
constexpr float kCoreKept = 0.8f;              // share of the glow within a core that goes with the core: it is bright by itself
constexpr double kPlateSigma = 3.0;           // px; the plate's own grain must not enter the layer
constexpr float kTouched = 0.5f / 255.0f;     // the plate differs from the photo by more: inside a hole

template <class Body>
void for_pixels(Size size, const Body& body) {
  parallel_for(size.height, [&](int y) { for (int x = 0; x < size.width; ++x) body(x, y); }, 32);
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
  for (Rgb& v : burnt.pixels()) for (int c = 0; c < 3; ++c) v[c] = std::max(0.0f, 2.0f * v[c] - 1.0f);
  return burnt;
}

ColorImage emitted(const ColorImage& photo, const ColorImage& plate) {
  const ColorImage burnt = burnt_out(photo, plate);
  ColorImage out(photo.size());
  for_pixels(photo.size(), [&](int x, int y) {
    for (int c = 0; c < 3; ++c) {
      const float light = linear_from_srgb(photo(x, y)[c]) - linear_from_srgb(plate(x, y)[c]);
      out(x, y)[c] = std::max(0.0f, light) + kClippedLight * burnt(x, y)[c];
    }
  });
  return out;
}

ScalarImage as_scalar(const Mask& mask) {
  ScalarImage out(mask.size());
  for (std::size_t i = 0; i < mask.pixels().size(); ++i) out.pixels()[i] = mask.pixels()[i] / 255.0f;
  return out;
}

// Glow is measured off the branches, and best in the dark: before a bright cloud a fitted plate errs by more than the glow.
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
  ColorImage light = emitted(photo, plate);
  const Mask branches = strand_mask(strands, photo.size(), 1.3, 1.0);
  ColorImage core(photo.size());
  for_pixels(photo.size(), [&](int x, int y) {
    if (branches(x, y)) for (int c = 0; c < 3; ++c) core(x, y)[c] = std::min(1.0f, light(x, y)[c]);
  });
  const ScalarImage around = fit_weight(plate, strand_mask(strands, photo.size(), 1.5, 6.0));
  layer.glow_model = fit_glow(core, light, around);
  layer.glow_gain = glow_gain(light, render_glow(layer.glow_model, core), around);
  for_pixels(photo.size(), [&](int x, int y) { core(x, y) = layer.glow_gain(x, y) * core(x, y); });
  layer.glow_model = fit_glow(core, light, around);
  layer.glow = render_glow(layer.glow_model, core);
  const ScalarImage kept = core_share(strands, photo.size());
  layer.value = ColorImage(photo.size());
  for_pixels(photo.size(), [&](int x, int y) {
    for (int c = 0; c < 3; ++c) {
      layer.value(x, y)[c] = std::max(0.0f, light(x, y)[c] - (1.0f - kCoreKept * kept(x, y)) * layer.glow(x, y)[c]);
    }
  });
  return layer;
}

ColorImage apply_light(const LightLayer& layer, const ColorImage& background, const ColorImage& value,
                       const ColorImage& core, const ScalarImage& inside) {
  ColorImage out(background.size());
  if (layer.mode == CompositeMode::Emit) {
    const ColorImage glow = render_glow(layer.glow_model, core);
    for_pixels(out.size(), [&](int x, int y) {
      for (int c = 0; c < 3; ++c) {
        const float around = (1.0f - kCoreKept * inside(x, y)) * glow(x, y)[c];
        const float light = std::max(glow(x, y)[c], value(x, y)[c] + around);  // never darker than the glow alone
        out(x, y)[c] = std::clamp(srgb_from_linear(linear_from_srgb(background(x, y)[c]) + light), 0.0f, 1.0f);
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
