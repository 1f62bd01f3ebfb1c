// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/compose/scene.h"

#include <cmath>

#include "ramify/compose/composite_mode.h"
#include "ramify/compose/light.h"
#include "ramify/compose/paste.h"
#include "ramify/core/parallel.h"

namespace ramify {
namespace {

Mask either(const Mask& a, const Mask& b) {
  Mask out = a;
  for (std::size_t i = 0; i < out.pixels().size(); ++i) out.pixels()[i] |= b.pixels()[i];
  return out;
}

// Pixels whose role is `role`.
Mask role_mask(const Habitat& habitat, RegionRole role) {
  Mask out(habitat.role.size(), 0);
  for (std::size_t i = 0; i < out.pixels().size(); ++i) {
    if (habitat.role.pixels()[i] == static_cast<std::uint8_t>(role)) out.pixels()[i] = 255;
  }
  return out;
}

// Lines that may not come along with a fragment: those nobody annotated, unless they are the ground's texture or the
// branches have an apron of such (twigs, ribs).
Mask foreign_lines(const Habitat& habitat) {
  const bool at_home = habitat.shadow_is_texture || habitat.apron > 0.0;
  return at_home ? Mask(habitat.shadow.size(), 0) : habitat.shadow;
}

void check_paper_flags(const ComposeOptions& o, CompositeMode mode) {
  const bool paper = o.paper_spacing || o.paper_greedy || o.paper_order || o.paper_rigid || o.paper_warp || o.paper_cut ||
                     o.paper_blend || o.free_rims || o.paper_exact;
  if (paper && mode != CompositeMode::Paste) {
    throw OptionError("paper-…", "", "the paper's single steps have an effect on pasted branches only; add --composite paste");
  }
  if (o.paper_rigid && o.paper_warp) throw OptionError("paper-warp", "", "says how to bend, --paper-rigid not to bend at all; give one");
  if (o.free_rims && !o.paper_blend && !o.paper_exact) throw OptionError("free-rims", "", "has an effect with --paper-blend only");
}

FragmentOptions fragment_options(const ComposeOptions& options, Size photo, const Habitat& habitat) {
  FragmentOptions out;
  out.paper_spacing = options.paper_spacing || options.paper_exact;
  if (out.paper_spacing) out.canvas_side = std::min(photo.width, photo.height);
  out.least_surround = std::clamp(habitat.apron, out.least_surround, 40.0);
  return out;
}

Composite compose_pasted(const Exemplar& exemplar, const ComposeScene& scene, const Background& background,
                         const Skeleton& skeleton, const ComposeOptions& options, const Rng& rng, const Monitor& monitor) {
  const bool exact = options.paper_exact;
  TargetOptions target;
  target.fragment = fragment_options(options, exemplar.photo.color.size(), scene.habitat);
  target.parent_first = options.paper_order || exact;
  if (target.fragment.paper_spacing) target.spacing = 0.75;
  PlacementOptions placement;
  placement.mirror = options.mirror;
  placement.leave_out = options.leave_out;
  placement.paper_greedy = options.paper_greedy || exact;
  placement.bend = !options.paper_rigid;
  placement.paper_warp = options.paper_warp || exact;
  PasteOptions paste;
  paste.paper_order = options.paper_order || exact;
  paste.paper_cut = options.paper_cut || exact;
  paste.paper_blend = options.paper_blend || exact;
  paste.free_rims = options.free_rims;
  if (!exact && !options.paper_cut) paste.apron = scene.habitat.apron;
  const PlacementPlan plan = place_fragments(scene.library, skeleton, background.color, target, placement,
                                             rng.child("placement"), monitor.stage("place", 0.0, 0.4));
  PasteResult pasted = paste_fragments(exemplar.photo.color, scene.library, plan, background.color, paste, monitor.stage("paste", 0.4, 1.0));
  if (pasted.uncovered > 0) {
    monitor.note(std::to_string(pasted.uncovered) + " px of branches found no fragment of the photo that fits and show the background");
  }
  Composite out;
  out.color = std::move(pasted.color);
  out.owner = std::move(pasted.owner);
  out.source = std::move(pasted.source);
  return out;
}

Composite compose_lit(const Exemplar& exemplar, const ComposeScene& scene, const Background& background, const Mask& front,
                      const Skeleton& skeleton, const ComposeOptions& options, const Rng& rng, const Monitor& monitor) {
  LightScene light;
  light.photo = exemplar.photo.color;
  light.plate = scene.plate.color;
  light.background = background.color;
  if (!scene.habitat.shadow_is_texture) light.shadow = scene.habitat.shadow;
  light.unusable = either(scene.habitat.outside, role_mask(scene.habitat, RegionRole::Keep));
  light.front = front;
  light.brighter = measure_branch_look(exemplar.photo.color, scene.library).contrast > 0.0;
  ComposeOptions own = options;
  if (options.leave_out > 0.0) own.leave_out = options.leave_out * disc_radius(exemplar.unit_radius, FragmentOptions{});
  return compose_light(light, exemplar.skeleton, skeleton, scene.composite, own, rng.child("light"), monitor);
}

// Where no fragment lies the picture shows the background, and so does its provenance.
void fill_provenance(Composite& out, const Background& background) {
  for (std::size_t i = 0; i < out.owner.pixels().size(); ++i) {
    if (out.owner.pixels()[i] == kNone) out.source.pixels()[i] = background.source.pixels()[i];
  }
}

// Outside shapes (surround, paper, sea) stay as the background has them, whatever a disc brought along.
void restore_outside(Composite& out, const Background& background, const Mask& keep) {
  for (std::size_t i = 0; i < out.owner.pixels().size(); ++i) {
    if (!keep.pixels()[i]) continue;
    out.color.pixels()[i] = background.color.pixels()[i];
    out.owner.pixels()[i] = kNone;
  }
}

}  // namespace

ComposeScene prepare_scene(const Exemplar& exemplar, const ComposeOptions& options, const Monitor& monitor) {
  const Rng rng = Rng(0).child("scene");
  ComposeScene scene;
  scene.habitat = find_habitat(exemplar, HabitatOptions{}, rng.child("habitat"), monitor.stage("habitat", 0.0, 0.2));
  const Mask unusable = either(either(scene.habitat.outside, scene.habitat.outliers), role_mask(scene.habitat, RegionRole::Keep));
  const Mask shadow = foreign_lines(scene.habitat);
  const FragmentOptions fragments = fragment_options(options, exemplar.photo.color.size(), scene.habitat);
  scene.library = make_fragment_library(exemplar, shadow, unusable, fragments);
  scene.composite = options.composite != CompositeMode::Auto ? options.composite
                    : options.paper_exact                    ? CompositeMode::Paste
                                                             : choose_composite_mode(exemplar, scene.library);
  check_paper_flags(options, scene.composite);
  const PlateKind kind = scene.composite == CompositeMode::Emit ? PlateKind::Halo : PlateKind::Thin;
  scene.plate = make_plate(exemplar, scene.habitat, kind, rng.child("plate"), monitor.stage("plate", 0.2, 1.0));
  return scene;
}

BackgroundPlan plan_scene_background(const Exemplar& exemplar, const ComposeScene& scene, Size canvas,
                                     const ComposeOptions& options, Rng rng) {
  BackgroundOptions background;
  background.mode = options.background;
  background.mirror = options.mirror && !is_shaded(scene.library);  // light never changes sides
  return plan_background(exemplar, scene.habitat, scene.plate, canvas, background, rng);
}

Mask on_canvas(const Mask& photo_map, const BackgroundPlan& plan) {
  Mask out(plan.canvas, 0);
  parallel_for(plan.canvas.height, [&](int y) {
    for (int x = 0; x < plan.canvas.width; ++x) {
      const Vec2 p = plan.shown_at(plan.photo_from_canvas(Vec2(x, y), photo_map.width()));
      out(x, y) = photo_map.clamped(static_cast<int>(std::lround(p.x())), static_cast<int>(std::lround(p.y())));
    }
  }, 16);
  return out;
}

Composite compose_image(const Exemplar& exemplar, const ComposeScene& scene, const BackgroundPlan& plan,
                        const Skeleton& skeleton, const ComposeOptions& options, Rng rng, const Monitor& monitor) {
  if (skeleton.empty()) throw InputError("skeleton", "has no branch to render");
  const Background background = make_background(exemplar, scene.habitat, scene.plate, plan, skeleton, rng.child("background"),
                                                monitor.stage("background", 0.0, 0.4));
  const bool new_ground = plan.mode == BackgroundMode::New;
  const Mask kept = new_ground ? Mask(plan.canvas, 0) : either(background.outside, on_canvas(role_mask(scene.habitat, RegionRole::Keep), plan));
  const Monitor dress = monitor.stage("dress", 0.4, 1.0);
  Composite out = scene.composite == CompositeMode::Paste
                      ? compose_pasted(exemplar, scene, background, skeleton, options, rng, dress)
                      : compose_lit(exemplar, scene, background, kept, skeleton, options, rng, dress);
  if (scene.composite == CompositeMode::Paste) restore_outside(out, background, kept);
  fill_provenance(out, background);
  out.plate = background.color;
  out.composite = scene.composite;
  out.background = plan.mode;
  return out;
}

}  // namespace ramify
