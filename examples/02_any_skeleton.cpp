// SPDX-License-Identifier: GPL-3.0-or-later
// Any skeleton can be dressed with any photo: a river network as cracks in a wall, with a crack's widths and bends.
#include <ramify/compose/scene.h>
#include <ramify/image/image_io.h>
#include <ramify/growth/restyle.h>
#include <ramify/skeleton/radius_map.h>
#include <ramify/skeleton/skeleton_io.h>
#include <ramify/style/style.h>
#include <ramify/synthetic/synthetic.h>

using namespace ramify;

int main() {
  const Rng rng(2);
  const Monitor monitor;
  const Size size{480, 320};
  const SyntheticExemplar river = make_synthetic(SyntheticKind::River, size, rng.child("river"), monitor);
  const SyntheticExemplar crack = make_synthetic(SyntheticKind::Crack, size, rng.child("crack"), monitor);
  const Exemplar wall = make_exemplar(crack.photo, crack.annotation);

  const Style style = learn_style(wall.skeleton, LearnStyleOptions{}, monitor);
  const Skeleton thin = map_radii(river.skeleton, measure_radius_spread(wall.skeleton));
  const Skeleton bent = restyle_skeleton(thin, style, 0.7, rng.child("restyle"), monitor);

  const ComposeOptions options;
  const ComposeScene scene = prepare_scene(wall, options, monitor);
  const BackgroundPlan plan = plan_scene_background(wall, scene, size, options, rng.child("plan"));
  const Composite picture =
      compose_image(wall, scene, plan, bent, options, rng.child("compose"), monitor);

  save_skeleton(bent, "02_river.json");
  save_image("02_river_as_cracks.png", picture.color);
}
