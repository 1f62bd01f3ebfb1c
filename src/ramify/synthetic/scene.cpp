// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/synthetic/scene.h"

#include <algorithm>
#include <cmath>

#include "ramify/image/filter.h"
#include "ramify/synthetic/noise.h"

namespace ramify {

Skeleton skeleton_of(Size size, const std::vector<AnnotatedBranch>& branches) {
  Skeleton skeleton(size);
  std::vector<int> first(branches.size());
  for (std::size_t b = 0; b < branches.size(); ++b) {
    const AnnotatedBranch& branch = branches[b];
    Node node;
    node.parent = branch.parent ? first[branch.parent->branch] + branch.parent->point : kNone;
    node.order = branch.parent ? skeleton[node.parent].order + 1 : 0;
    first[b] = skeleton.count();
    for (std::size_t i = 0; i < branch.points.size(); ++i) {
      node.position = Vec3(branch.points[i].x(), branch.points[i].y(), 0.0);
      node.radius = branch.radii[i];
      node.parent = skeleton.append(node);
    }
  }
  return skeleton;
}

double scale_of(Size size) { return std::sqrt(static_cast<double>(size.width) * size.height / (960.0 * 640.0)); }

float coverage(float distance, float soft) { return 0.5f * std::erfc(distance / (1.41421356f * soft)); }

float smooth_step(float a, float b, float x) {
  const float t = std::clamp((x - a) / (b - a), 0.0f, 1.0f);
  return t * t * (3.0f - 2.0f * t);
}

ColorImage photograph(const ColorImage& scene, const Camera& camera, const Rng& rng) {
  const Size size = scene.size();
  const ColorImage sharp = gaussian_blur(scene, camera.blur);
  const auto grain_field = [&](std::string_view name) {
    ScalarImage grain = gaussian_blur(white_noise(size, rng.child(name)), camera.grain_size);
    // Blurring white noise by s leaves 1 / (2 sqrt(pi) s) of its deviation (1 for s = 0).
    const float gain = static_cast<float>(std::max(1.0, 2.0 * std::sqrt(kPi) * camera.grain_size) * camera.grain);
    for (float& value : grain.pixels()) value *= gain;
    return grain;
  };
  const ScalarImage common = grain_field("grain"), red = grain_field("grain red"), blue = grain_field("grain blue");
  const double half = 0.5 * std::hypot(size.width, size.height);
  const float share = static_cast<float>(camera.color_grain);
  return painted(size, [&](int x, int y) {
    const double away = std::hypot(x - 0.5 * size.width, y - 0.5 * size.height) / half;
    const float light = static_cast<float>(1.0 - camera.vignette * away * away * away);
    const float g = common(x, y), r = g + share * red(x, y), b = g + share * blue(x, y);
    Rgb out = light * sharp(x, y);
    const float level = 0.2126f * out.r + 0.7152f * out.g + 0.0722f * out.b;
    // Sensor noise in encoded values: strongest in the mid-tones, little in black and in clipped white.
    const float strength = 0.35f + 2.6f * std::clamp(level, 0.0f, 1.0f) * (1.0f - std::clamp(level, 0.0f, 1.0f));
    out = out + Rgb{strength * r, strength * g, strength * b};
    for (int c = 0; c < 3; ++c) out[c] = std::round(255.0f * std::clamp(out[c], 0.0f, 1.0f)) / 255.0f;
    return out;
  });
}

ScalarImage relief_shade(const ScalarImage& height, float strength, const Vec2& towards_light) {
  const Gradient slope = gradient(height);
  ScalarImage shade(height.size());
  for (std::size_t i = 0; i < shade.pixels().size(); ++i)
    shade.pixels()[i] = 1.0f - strength * static_cast<float>(towards_light.x() * slope.dx.pixels()[i] +
                                                             towards_light.y() * slope.dy.pixels()[i]);
  return shade;
}

}  // namespace ramify
