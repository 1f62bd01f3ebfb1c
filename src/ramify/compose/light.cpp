// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/compose/light.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "ramify/compose/light_tone.h"
#include "ramify/compose/light_weave.h"
#include "ramify/core/parallel.h"
#include "ramify/image/filter.h"
#include "ramify/image/sample.h"

namespace ramify {
namespace {

// Linear light inside the new branches: what was laid plus the far glow that was taken off where it came from.
ColorImage new_core(const LightLayer& layer, const WovenLight& woven, const std::vector<Strand>& targets) {
  const Mask inside = strand_mask(targets, woven.value.size(), 1.3, 1.0);
  ColorImage core(woven.value.size());
  parallel_for(core.height(), [&](int y) {
    for (int x = 0; x < core.width(); ++x) {
      if (!inside(x, y) || woven.owner(x, y) == kNone) continue;
      const Vec2 from = woven.source(x, y).cast<double>();
      const Rgb glow = sample_bilinear(layer.glow, from);
      const float gain = sample_bilinear(layer.glow_gain, from);
      for (int c = 0; c < 3; ++c) core(x, y)[c] = gain * std::min(1.0f, woven.value(x, y)[c] + glow[c]);
    }
  }, 32);
  return core;
}

// Where a new core brings its own glow along, 0..1: not where it fades.
ScalarImage own_glow(const WovenLight& woven, const std::vector<Strand>& targets) {
  ScalarImage inside = core_share(targets, woven.value.size());
  for (std::size_t i = 0; i < inside.pixels().size(); ++i) inside.pixels()[i] *= woven.window.pixels()[i];
  return inside;
}

// Where the new picture shows the grain of the copied branch, 0..1.
ScalarImage own_grain(const LightLayer& layer, const WovenLight& woven) {
  ScalarImage inside(woven.value.size());
  parallel_for(inside.height(), [&](int y) {
    for (int x = 0; x < inside.width(); ++x) {
      if (woven.owner(x, y) == kNone) continue;
      inside(x, y) = woven.window(x, y) * sample_bilinear(layer.inside, woven.source(x, y).cast<double>());
    }
  }, 32);
  return inside;
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
  const auto mark = [&](const Mask& mask) {
    for (std::size_t i = 0; i < mask.pixels().size(); ++i) if (mask.pixels()[i]) scene.unusable.pixels()[i] = 255;
  };
  mark(habitat.outside);
  mark(habitat.outliers);
  for (std::size_t i = 0; i < exemplar.regions.pixels().size(); ++i) {
    const auto role = static_cast<RegionRole>(exemplar.regions.pixels()[i]);
    if (role == RegionRole::Ignore || role == RegionRole::Keep) scene.unusable.pixels()[i] = 255;
  }
  return scene;
}

Composite compose_light(const LightScene& scene, const Skeleton& exemplar, const Skeleton& target, CompositeMode mode,
                        const ComposeOptions& options, Rng rng, const Monitor& monitor) {
  const LightRules rules = light_rules(mode);
  const std::vector<Strand> own = make_strands(exemplar);
  const LightLayer layer = make_light_layer(scene.photo, scene.plate, own, mode, scene.brighter);
  monitor.report(0.1);
  const LightSource source = make_light_source(own, layer, scene.shadow, scene.unusable, rules);
  std::vector<Strand> targets = make_strands(target);
  assign_levels(targets, source, rng);
  monitor.report(0.2);
  WovenLight woven = weave_light(source, layer, targets, scene.background.size(), rules, options.leave_out, rng,
                                 monitor.stage("light", 0.2, 0.9));
  const bool emits = mode == CompositeMode::Emit;
  const ColorImage core = emits ? new_core(layer, woven, targets) : ColorImage();
  const ScalarImage inside = emits ? own_glow(woven, targets) : own_grain(layer, woven);
  Composite result;
  result.color = apply_light(layer, scene.background, woven.value, core, inside);
  result.plate = scene.background;
  result.owner = std::move(woven.owner);
  result.source = std::move(woven.source);
  result.composite = mode;
  put_in_front(scene, result);
  monitor.report(1.0);
  return result;
}

}  // namespace ramify
