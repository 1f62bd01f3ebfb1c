// SPDX-License-Identifier: GPL-3.0-or-later
// From an exemplar and a skeleton to a picture. What depends on the exemplar alone is prepared once (ComposeScene) and
// serves any number of pictures; the background is planned before growth, because outside shapes, landmarks and roots move
// with it; the picture is composed last.
#pragma once

#include "ramify/compose/background.h"
#include "ramify/compose/compose.h"
#include "ramify/exemplar/fragment.h"
#include "ramify/exemplar/habitat.h"
#include "ramify/exemplar/plate.h"

namespace ramify {

struct ComposeScene {
  Habitat habitat;
  FragmentLibrary library;
  CompositeMode composite = CompositeMode::Paste;  // never Auto
  Plate plate;
};

// Does not depend on any seed: the same exemplar gives the same scene.
ComposeScene prepare_scene(const Exemplar& exemplar, const ComposeOptions& options, const Monitor& monitor);

BackgroundPlan plan_scene_background(const Exemplar& exemplar, const ComposeScene& scene, Size canvas,
                                     const ComposeOptions& options, Rng rng);

// A map of the photo (255 or 0 per pixel) as it lies on the canvas; beyond the photo as the wider plate has it.
Mask on_canvas(const Mask& photo_map, const BackgroundPlan& plan);

// The skeleton lies on plan.canvas and is dressed with its own radii (match_radii brings any to those the photo has),
// so that its mask is the picture's. Throws InputError when the exemplar offers no fragment for it.
Composite compose_image(const Exemplar& exemplar, const ComposeScene& scene, const BackgroundPlan& plan,
                        const Skeleton& skeleton, const ComposeOptions& options, Rng rng, const Monitor& monitor);

}  // namespace ramify
