// SPDX-License-Identifier: GPL-3.0-or-later
// A painted density map means what it shows: white is grown and filled, black is never entered.
#include <ramify/growth/grow.h>
#include <ramify/skeleton/skeleton_io.h>
#include <ramify/synthetic/synthetic.h>

#include <cmath>

using namespace ramify;

int main() {
  const Rng rng(5);
  const Monitor monitor;
  const SyntheticExemplar made = make_synthetic(SyntheticKind::Lightning, {480, 320}, rng.child("example"), monitor);
  const Style style = learn_style(made.skeleton, {}, monitor);

  // A ring.
  GrowthTarget target;
  target.size = {400, 400};
  target.density = ScalarImage(target.size);
  for (int y = 0; y < 400; ++y)
    for (int x = 0; x < 400; ++x) target.density(x, y) = std::fabs(std::hypot(x - 200, y - 200) - 130.0) < 45.0 ? 1.0f : 0.0f;

  const Skeleton skeleton = grow_from_style(style, target, {}, rng.child("grow"), monitor);
  save_skeleton(skeleton, "05_ring.svg");
}
