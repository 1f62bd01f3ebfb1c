// SPDX-License-Identifier: GPL-3.0-or-later
// What the new branches are laid on (PICTURES 7): the plate as it is, the plate varied, or new ground of the same kind.
//
// A variation is planned before anything is grown, because landmarks and outside shapes move with it and roots with them.
#pragma once

#include <array>

#include "ramify/compose/compose.h"
#include "ramify/compose/wider_plate.h"
#include "ramify/core/monitor.h"
#include "ramify/core/random.h"
#include "ramify/exemplar/exemplar.h"
#include "ramify/exemplar/habitat.h"
#include "ramify/exemplar/plate.h"
#include "ramify/skeleton/skeleton.h"

namespace ramify {

struct BackgroundPlan {
  BackgroundMode mode = BackgroundMode::Keep;  // never Auto
  Size canvas;
  // canvas = scale * (photo with x mirrored when flipped) + shift
  bool flipped = false;
  double scale = 1.0;
  Vec2 shift = Vec2::Zero();  // px
  // Bends of Vary: waves of the canvas, faded out near the frame, near landmarks and near what lies outside.
  struct Wave { Vec2 frequency = Vec2::Zero(), amplitude = Vec2::Zero(); double phase = 0.0; };
  std::array<Wave, 3> waves{};
  WiderPlate wider;  // the plate, continued to wherever the canvas reaches beyond the photo; empty where only growth is wanted

  // Where a landmark, root or outside shape of the photo lies on the canvas. px.
  Vec2 canvas_from_photo(const Vec2& photo, int photo_width) const;
  Vec2 photo_from_canvas(const Vec2& canvas_point, int photo_width) const;
  // What of the photo is shown at a point of it, or beyond it. px of the photo.
  Vec2 shown_at(const Vec2& photo) const;
};

struct BackgroundOptions {
  BackgroundMode mode = BackgroundMode::Auto;
  bool mirror = true;     // the picture may be mirrored left to right: false where light or writing gives it away
  double bend = 0.05;     // share of the shorter side by which Vary may move things, 0 … 0.1
  double zoom = 1.25;     // Vary shows at least 1/zoom of the photo, 1 … 2
};
std::vector<OptionField> describe(BackgroundOptions& options);

// Tones of a picture that change more slowly than over a sixteenth of its width (ALGORITHMS 6.1).
struct SlowTones {
  double share = 0.0;   // 0..1, of the variance of brightness
  double spread = 0.0;  // 0..1, standard deviation of brightness
};
SlowTones measure_slow_tones(const ColorImage& photo, const Mask& without);

// Auto: New where the plate is all texture (slow share below 0.2, or slow tones too faint to be missed) without
// landmarks or outside shapes, else Vary.
BackgroundPlan plan_background(const Exemplar& exemplar, const Habitat& habitat, const Plate& plate, Size canvas,
                               const BackgroundOptions& options, Rng rng);

// Where the canvas shows only a part of the photo, moves the photo so that as little as possible of what is wanted
// (canvas, weights >= 0) lies where it is closed (photo, 255); as near to where it was as that allows. Returns the
// share of the weight that still does, 0..1. O(canvas samples x 625 places), 4096 samples for a square canvas.
double move_under(BackgroundPlan& plan, const Mask& closed, const ScalarImage& wanted);

struct Background {
  ColorImage color;
  VectorImage source;  // photo pixel every pixel comes from (px); NaN where it was filled smoothly
  Mask outside;        // canvas: what lies outside the habitat there (skyline, surround, paper)
};

// target: the new branches, on the canvas; New puts ground from beside branches beside them.
Background make_background(const Exemplar& exemplar, const Habitat& habitat, const Plate& plate, const BackgroundPlan& plan,
                           const Skeleton& target, Rng rng, const Monitor& monitor);

}  // namespace ramify
