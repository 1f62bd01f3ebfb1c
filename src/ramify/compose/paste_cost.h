// SPDX-License-Identifier: GPL-3.0-or-later
// What it costs to see a fragment or the background at a pixel, and to have a seam between two pixels.
#pragma once

#include <vector>

#include "ramify/compose/paste.h"
#include "ramify/image/seam.h"

namespace ramify {

// Lab difference of two colours from their sRGB difference: exact for greys (L* is close to 100 x the encoded grey).
inline constexpr float kLabPerRgb = 57.7f;
float color_distance(const Rgb& a, const Rgb& b);

class PasteCost {
 public:
  PasteCost(const PlacementPlan& plan, const std::vector<Patch>& patches, const ColorImage& background,
            const PasteOptions& options);

  SeamCosts functions() const;              // refers to this object
  std::vector<SeamMove> moves() const;      // along, tips, junctions, sides: the later ones may cut into the earlier
  bool in_core(int x, int y) const;         // must the pixel be covered by a fragment?
  const Rgb* color(int label, int x, int y) const;  // null where the label has no pixel
  // Does the label show branch there? Empty where it has no pixel.
  int shows_branch(int label, int x, int y) const;  // 1, 0 or kNone

 private:
  int data(int label, int x, int y) const;
  int pair(int a, int b, int x, int y, int dx, int dy) const;

  const PlacementPlan& plan_;
  const std::vector<Patch>& patches_;
  const ColorImage& background_;
  const PasteOptions& options_;
  ScalarImage crossing_;  // factor of seam costs
};

}  // namespace ramify
