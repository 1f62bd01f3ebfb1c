// SPDX-License-Identifier: GPL-3.0-or-later
// A skeleton drawn in a style: ink, vine, lightning, woodcut, watercolour. Two steps, so that growing pictures are cheap: the scene holds
// what does not change while it grows, a drawing is the scene at one moment.
#pragma once

#include <string>
#include <vector>

#include "ramify/core/monitor.h"
#include "ramify/core/options.h"
#include "ramify/core/preset.h"
#include "ramify/core/random.h"
#include "ramify/paint/drawing.h"
#include "ramify/paint/foliage.h"
#include "ramify/paint/stroke.h"

namespace ramify {

enum class PaintStyle { Ink, Vine, Lightning, Woodcut, Watercolor };

struct PaintOptions {
  PaintStyle style = PaintStyle::Ink;
  std::string palette;              // a name or colours (palette.h); empty = the style's own
  std::string background = "none";  // a colour, or none = transparent
  StrokeOptions stroke;
  double tolerance = 0.12;          // px, how far curves may lie from the outline
  LeafShape leaf = LeafShape::Ovate;
  FoliageOptions foliage;
  std::string flower_color = "#e58aa5";
  double glow = 1.0;                // strength of the light around lightning
  double hatching = 0.8;            // lines of the ground around a woodcut, 0 = none
  double pale = 0.5;                // 0..1, how far what stands behind fades into the ground
  double rim = 1.3;                 // px of ground around what stands before something else
};
std::vector<OptionField> describe(PaintOptions& options);

// Whether an option changes what a style draws.
bool has_effect(PaintStyle style, const std::string& option);

struct PaintScene {
  Size size;
  PaintOptions options;
  std::vector<Rgb> colors;
  std::optional<Rgb> background;
  std::vector<Stroke> strokes;
  Foliage foliage;    // vine only
  double reach = 0.0; // px, longest way from a root
  std::uint64_t seed = 1;          // of what styles add
  std::vector<PaintScene> behind;  // drawn first, the farthest at the front of the list; on the same canvas
};

// Throws OptionError for palettes and colours that cannot be read, InputError for a skeleton without nodes.
// Leaves keep within `shape` unless it is empty.
PaintScene prepare_painting(const Skeleton& skeleton, const PaintOptions& options, const Rng& rng, const Monitor& monitor,
                            const Mask& shape = {});

// The drawing when it has grown to `growth` 0..1 of itself; at 1 it is finished.
Drawing draw_painting(const PaintScene& scene, double growth, const Monitor& monitor);

const std::vector<Preset>& paint_presets();

}  // namespace ramify
