// SPDX-License-Identifier: GPL-3.0-or-later
// Any skeleton can be dressed with any photo: a river network as cracks in a wall.
#include <ramify/compose/scene.h>
#include <ramify/image/image_io.h>
#include <ramify/skeleton/skeleton_io.h>
#include <ramify/synthetic/synthetic.h>

using namespace ramify;

int main() {
  const Rng rng(2);
  const Monitor monitor;
  const Size size{480, 320};
  const SyntheticExemplar river = make_synthetic(SyntheticKind::River, size, rng.child("river"), monitor);
  const SyntheticExemplar crack = make_synthetic(SyntheticKind::Crack, size, rng.child("crack"), monitor);
  const Exemplar wall = make_exemplar(crack.photo, crack.annotation);

  // Widths are mapped into the range that the wall's cracks have.
  const ComposeOptions options;
  const ComposeScene scene = prepare_scene(wall, options, monitor);
  const BackgroundPlan plan = plan_scene_background(wall, scene, size, options, rng.child("plan"));
  const Composite picture =
      compose_image(wall, scene, plan, river.skeleton, options, rng.child("compose"), monitor);

  save_skeleton(river.skeleton, "02_river.json");
  save_image("02_river_as_cracks.png", picture.color);
}
