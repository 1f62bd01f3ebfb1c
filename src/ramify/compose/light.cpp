// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/compose/light.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "ramify/compose/light_tone.h"
#include "ramify/compose/light_weave.h"
#include "ramify/core/parallel.h"
#include "ramify/image/filter.h"
#include "ramify/image/sample.h"

namespace ramify {
namespace {

// How strongly the photo's branches of this radius (px) glow beside the model.
double usual_gain(const LightLayer& layer, double radius) {
  const auto& table = layer.gain_of_radius;
  if (table.empty()) return 1.0;
  const auto above =
      std::upper_bound(table.begin(), table.end(), radius, [](double r, const auto& e) { return r < e.first; });
  if (above == table.begin()) return table.front().second;
  if (above == table.end()) return table.back().second;
  const auto& [r0, g0] = *(above - 1);
  const double u = std::log(radius / r0) / std::log(above->first / r0);
  return (1.0 - u) * g0 + u * above->second;
}

// That gain on every pixel of the new branches; where they overlap the larger.
ScalarImage gain_by_width(const LightLayer& layer, const std::vector<Strand>& targets, Size size) {
  constexpr double kLeast = 0.25, kStep = 0.1;  // px, log ratio: the table's first radius and its step
  std::vector<float> table;
  for (int k = 0; k < 64; ++k) table.push_back(static_cast<float>(usual_gain(layer, kLeast * std::exp(kStep * k))));
  ScalarImage gain(size);
  for (const Strand& s : targets) {
    for (int t = 0; t < s.count(); ++t) {
      const double r = std::max(kLeast, s.radii[t]), reach = 1.3 * r + 1.0;
      const float g = table[std::clamp(static_cast<int>(std::lround(std::log(r / kLeast) / kStep)), 0, 63)];
      const int cx = static_cast<int>(std::lround(s.points[t].x())),
                cy = static_cast<int>(std::lround(s.points[t].y()));
      const int half = static_cast<int>(std::ceil(reach));
      for (int y = std::max(0, cy - half); y <= std::min(size.height - 1, cy + half); ++y) {
        for (int x = std::max(0, cx - half); x <= std::min(size.width - 1, cx + half); ++x) {
          if ((Vec2(x, y) - s.points[t]).norm() <= reach) gain(x, y) = std::max(gain(x, y), g);
        }
      }
    }
  }
  return gain;
}

// Linear light inside the new branches: what was laid plus the far glow that was taken off where it came from.
ColorImage new_core(const LightLayer& layer, const WovenLight& woven, const std::vector<Strand>& targets) {
  const ScalarImage gain = gain_by_width(layer, targets, woven.value.size());
  ColorImage core(woven.value.size());
  parallel_for(
      core.height(),
      [&](int y) {
        for (int x = 0; x < core.width(); ++x) {
          if (gain(x, y) <= 0.0f || woven.owner(x, y) == kNone) continue;
          const Rgb glow = sample_bilinear(layer.glow, woven.source(x, y).cast<double>());
          for (int c = 0; c < 3; ++c) core(x, y)[c] = gain(x, y) * std::min(1.0f, woven.value(x, y)[c] + glow[c]);
        }
      },
      32);
  return core;
}

// Where a new core brings its own glow along, 0..1: not where it fades.
ScalarImage own_glow(const WovenLight& woven, const std::vector<Strand>& targets) {
  ScalarImage inside = kept_glow_share(targets, woven.value.size());
  for (std::size_t i = 0; i < inside.pixels().size(); ++i) inside.pixels()[i] *= woven.window.pixels()[i];
  return inside;
}

// A share of the photo's layer (its own grain, its opaque cores) where it was laid, 0..1.
ScalarImage carried(const ScalarImage& share, const WovenLight& woven) {
  ScalarImage out(woven.value.size());
  parallel_for(
      out.height(),
      [&](int y) {
        for (int x = 0; x < out.width(); ++x) {
          if (woven.owner(x, y) == kNone) continue;
          out(x, y) = woven.window(x, y) * sample_bilinear(share, woven.source(x, y).cast<double>());
        }
      },
      32);
  return out;
}

// What stands in front hides the light behind it, with an edge softened by 0.8 px.
void put_in_front(const LightScene& scene, Composite& result) {
  if (scene.front.empty()) return;
  ScalarImage cover(scene.front.size());
  for (std::size_t i = 0; i < cover.pixels().size(); ++i) cover.pixels()[i] = scene.front.pixels()[i] / 255.0f;
  cover = gaussian_blur(cover, 0.8);
  for (std::size_t i = 0; i < cover.pixels().size(); ++i) {
    const float a = cover.pixels()[i];
    Rgb& out = result.color.pixels()[i];
    out = a * scene.background.pixels()[i] + (1.0f - a) * out;
    if (a <= 0.5f) continue;
    result.owner.pixels()[i] = kNone;
    result.source.pixels()[i].setConstant(std::numeric_limits<float>::quiet_NaN());
  }
}

}  // namespace

LightScene light_scene(const Exemplar& exemplar, const Habitat& habitat, const Plate& plate, ColorImage background,
                       Mask outside) {
  LightScene scene;
  scene.photo = exemplar.photo.color;
  scene.plate = plate.color;
  scene.background = std::move(background);
  scene.front = std::move(outside);
  scene.brighter = exemplar.polarity != Polarity::Dark;
  if (!habitat.shadow_is_texture) scene.shadow = habitat.shadow;
  scene.unusable = Mask(scene.photo.size(), 0);
  scene.hiding = habitat.outside;
  const auto mark = [&](const Mask& mask) {
    for (std::size_t i = 0; i < mask.pixels().size(); ++i)
      if (mask.pixels()[i]) scene.unusable.pixels()[i] = 255;
  };
  mark(habitat.outside);
  mark(habitat.outliers);
  for (std::size_t i = 0; i < exemplar.regions.pixels().size(); ++i) {
    const auto role = static_cast<RegionRole>(exemplar.regions.pixels()[i]);
    if (role == RegionRole::Ignore || role == RegionRole::Keep) scene.unusable.pixels()[i] = 255;
    if (role == RegionRole::Keep) scene.hiding.pixels()[i] = 255;
  }
  return scene;
}

Composite compose_light(const LightScene& scene, const Skeleton& exemplar, const Skeleton& target, CompositeMode mode,
                        const ComposeOptions& options, Rng rng, const Monitor& monitor) {
  const LightRules rules = light_rules(mode);
  std::vector<Strand> own = make_strands(exemplar);
  close_hidden_ends(own, scene.hiding);
  const LightLayer layer = make_light_layer(scene.photo, scene.plate, own, mode, scene.brighter);
  monitor.report(0.1);
  const LightSource source = make_light_source(own, layer, scene.shadow, scene.unusable, rules);
  std::vector<Strand> targets = make_strands(target);
  close_hidden_ends(targets, scene.front);
  begin_inside_parents(targets);
  assign_levels(targets, source, rules.tip_fade, rng);
  monitor.report(0.2);
  WovenLight woven = weave_light(source, layer, targets, scene.background.size(), rules, options.leave_out, rng,
                                 monitor.stage("light", 0.2, 0.9));
  const bool emits = mode == CompositeMode::Emit;
  const ColorImage core = emits ? new_core(layer, woven, targets) : ColorImage();
  const ScalarImage inside = emits ? own_glow(woven, targets) : carried(layer.inside, woven);
  const ScalarImage opaque = emits ? carried(layer.opaque, woven) : ScalarImage();
  Composite result;
  result.color = apply_light(layer, scene.background, woven.value, core, inside, opaque);
  result.plate = scene.background;
  result.owner = std::move(woven.owner);
  result.source = std::move(woven.source);
  result.composite = mode;
  put_in_front(scene, result);
  monitor.report(1.0);
  return result;
}

}  // namespace ramify
