// SPDX-License-Identifier: GPL-3.0-or-later
// What the five kinds share: the parts a kind hands back, and the camera.
#pragma once

#include <vector>

#include "ramify/core/monitor.h"
#include "ramify/core/parallel.h"
#include "ramify/core/random.h"
#include "ramify/exemplar/annotation.h"
#include "ramify/image/image.h"

namespace ramify {

struct Scene {
  ColorImage color;                        // sRGB-encoded, as the lens sees it
  std::vector<AnnotatedBranch> branches;   // the truth
  std::vector<Region> regions;
  Polarity polarity = Polarity::Dark;
  Vec3 light = {0, 0, 1};
};

// Branch by branch, so that a branch's own next point always has a lower index than the children that leave it and
// branches keep their numbers.
Skeleton skeleton_of(Size size, const std::vector<AnnotatedBranch>& branches);

// One file per kind.
Scene draw_lightning(Size size, const Rng& rng, const Monitor& monitor);
Scene draw_river(Size size, const Rng& rng, const Monitor& monitor);
Scene draw_crack(Size size, const Rng& rng, const Monitor& monitor);
Scene draw_vein(Size size, const Rng& rng, const Monitor& monitor);
Scene draw_vessel(Size size, const Rng& rng, const Monitor& monitor);

// 1 at the natural size of 960 x 640, in proportion to the square root of the area.
double scale_of(Size size);

struct Camera {
  double blur = 0.6;         // px, s.d. of the lens
  double grain = 0.012;      // s.d. in mid-grey, sRGB units
  double grain_size = 0.6;   // px, s.d. of its own blur
  double color_grain = 0.4;  // share of the grain that differs between the channels
  double vignette = 0.1;     // loss of light in the corners, share
};

// Lens, falling off towards the corners, grain, and rounding to 8 bits.
ColorImage photograph(const ColorImage& scene, const Camera& camera, const Rng& rng);

// 1 well inside a rim, 0 well outside, 0.5 on it; `soft` px is the s.d. of the edge.
float coverage(float distance, float soft);

// 0 below a, 1 above b, smooth between.
float smooth_step(float a, float b, float x);

// Brightness, around 1, of a surface of the given height (px) lit from the side `towards_light` points to.
ScalarImage relief_shade(const ScalarImage& height, float strength, const Vec2& towards_light);

inline Rgb mix(const Rgb& a, const Rgb& b, float t) { return a + t * (b - a); }
inline Rgb operator*(const Rgb& a, const Rgb& b) { return {a.r * b.r, a.g * b.g, a.b * b.b}; }

// paint(x, y) for every pixel, rows in parallel.
template <class Paint>
ColorImage painted(Size size, Paint&& paint) {
  ColorImage out(size);
  parallel_for(size.height, [&](int y) {
    for (int x = 0; x < size.width; ++x) out(x, y) = paint(x, y);
  }, 8);
  return out;
}

}  // namespace ramify
