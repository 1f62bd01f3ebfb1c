// SPDX-License-Identifier: GPL-3.0-or-later
// Dresses a skeleton by light instead of paste: what the photo's branches add to their background (lightning) or take
// from it (vessels, a bare tree before the sky) is copied along the new branches and laid on a background without
// branches (PICTURES 6, 8, 12.3). Thin, glowing and half-transparent branches have no edge to cut along; this needs
// none.
#pragma once

#include "ramify/compose/compose.h"
#include "ramify/core/monitor.h"
#include "ramify/core/random.h"
#include "ramify/exemplar/habitat.h"
#include "ramify/exemplar/plate.h"

namespace ramify {

// Pictures are sRGB and of the photo's size, but background and front are of the skeleton's canvas.
struct LightScene {
  ColorImage photo;
  ColorImage plate;       // the photo without its branches, and for Emit without their glow
  ColorImage background;  // what the new branches are laid on
  Mask shadow;            // 255 on branch-like things that are not annotated; may be empty
  Mask unusable;          // 255 where nothing may be copied from; may be empty
  Mask hiding;            // 255 on what stands before the photo's own branches; may be empty
  Mask front;             // 255 on what stands before the new branches (skyline); may be empty
  bool brighter = false;  // Absorb: the branches are brighter than the plate
};

// The scene of an exemplar whose plate was made with Halo for Emit and Thin for Absorb. background and outside are of
// the new canvas (compose/background.h); outside stays in front.
LightScene light_scene(const Exemplar& exemplar, const Habitat& habitat, const Plate& plate, ColorImage background,
                       Mask outside);

// mode: Emit or Absorb. Fills color, plate, owner, source and composite of the result. Throws InputError when the photo
// offers nothing to copy.
Composite compose_light(const LightScene& scene, const Skeleton& exemplar, const Skeleton& target, CompositeMode mode,
                        const ComposeOptions& options, Rng rng, const Monitor& monitor);

}  // namespace ramify
