// SPDX-License-Identifier: GPL-3.0-or-later
// The whole road: one annotated photo in, one new photo out.
#include <ramify/compose/scene.h>
#include <ramify/growth/grow.h>
#include <ramify/image/image_io.h>
#include <ramify/style/style.h>
#include <ramify/synthetic/synthetic.h>

using namespace ramify;

int main() {
  const Rng rng(1);
  const Monitor monitor;
  // Your own: make_exemplar(photo, load_annotation("photo.ramify.json")).
  const SyntheticExemplar made = make_synthetic(SyntheticKind::Crack, {480, 320}, rng.child("example"), monitor);
  const Exemplar exemplar = make_exemplar(made.photo, made.annotation);

  // What depends on the exemplar alone serves any number of pictures.
  const Style style = learn_style(exemplar.skeleton, {}, monitor);
  const ComposeOptions options;
  const ComposeScene scene = prepare_scene(exemplar, options, monitor);

  GrowthTarget target;
  target.size = exemplar.skeleton.size;
  const BackgroundPlan plan = plan_scene_background(exemplar, scene, target.size, options, rng.child("plan"));
  const Skeleton skeleton = grow_from_style(style, target, {}, rng.child("grow"), monitor);
  const Composite picture = compose_image(exemplar, scene, plan, skeleton, options, rng.child("compose"), monitor);

  save_image("01_source.png", exemplar.photo.color);
  save_image("01_new_picture.png", picture.color);
}
