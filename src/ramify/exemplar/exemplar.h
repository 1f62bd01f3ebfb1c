// SPDX-License-Identifier: GPL-3.0-or-later
// One photo with its annotated branches: what a style is learnt from and what fragments are cut from.
#pragma once

#include <string>

#include "ramify/exemplar/annotation.h"
#include "ramify/image/image.h"
#include "ramify/skeleton/skeleton.h"

namespace ramify {

struct Photo {
  ColorImage color;     // oriented, sRGB
  Mask alpha;           // 0 = excluded pixel; empty when the file has no alpha
  std::string name;     // file name without folder
  std::string sha256;   // of the file's bytes
  int bits = 8;         // 8, 16 or 32 (float): the depth outputs are written with
};

struct Exemplar {
  Photo photo;              // rectified when the annotation says so
  Annotation annotation;
  Skeleton skeleton;        // on the photo's canvas, cleaned for learning
  Polarity polarity = Polarity::Dark;
  double unit_radius = 1.0; // px, mean radius along the skeleton
  Mask branch_mask;         // 255 inside a branch's capsules
  Image<std::uint8_t> regions;  // RegionRole of every pixel, from polygons, --regions and alpha; Habitat elsewhere
};

// Throws InputError when the annotation has no usable branch.
Exemplar make_exemplar(Photo photo, Annotation annotation);

}  // namespace ramify
