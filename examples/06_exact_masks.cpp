// SPDX-License-Identifier: GPL-3.0-or-later
// A synthetic photograph with its exact masks: training data for segmentation, by the hundred if you like.
#include <ramify/image/image_io.h>
#include <ramify/skeleton/draw.h>
#include <ramify/skeleton/skeleton_io.h>
#include <ramify/synthetic/synthetic.h>

using namespace ramify;

int main() {
  for (int seed = 1; seed <= 2; ++seed) {
    const SyntheticExemplar made = make_synthetic(SyntheticKind::Vessel, {440, 350}, Rng(seed), Monitor());
    const SkeletonMasks masks = draw_masks(made.skeleton, made.skeleton.size);
    const std::string stem = "06_vessels_" + std::to_string(seed);
    save_image(stem + ".png", made.photo.color);
    save_mask(stem + "_mask.png", masks.branch);
    save_mask16(stem + "_radius.png", masks.radius);           // 1/256 px
    save_mask16(stem + "_branches.png", label_picture(masks.branch_id));
    save_skeleton(made.skeleton, stem + ".swc");
  }
}
