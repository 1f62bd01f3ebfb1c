// SPDX-License-Identifier: GPL-3.0-or-later
// Removes the branches from a photo: the hole they leave is filled from the rest of the picture.
#include <ramify/image/completion.h>
#include <ramify/image/filter.h>
#include <ramify/image/image_io.h>
#include <ramify/synthetic/synthetic.h>

using namespace ramify;

int main() {
  const Rng rng(4);
  const Monitor monitor;
  const SyntheticExemplar made = make_synthetic(SyntheticKind::Crack, {480, 320}, rng.child("example"), monitor);
  const Mask hole = dilate(made.branch_mask, 5.0);

  const Completion filled = complete(made.photo.color, hole, Mask(), {}, rng.child("complete"), monitor);

  save_image("04_cracked.png", made.photo.color);
  save_image("04_mended.png", filled.color);
}
