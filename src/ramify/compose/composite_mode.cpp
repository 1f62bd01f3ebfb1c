// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/compose/composite_mode.h"

#include <algorithm>
#include <cmath>

#include "ramify/image/color.h"
#include "ramify/image/filter.h"

namespace ramify {
namespace {

double median(std::vector<float> values) {
  if (values.empty()) return 0.0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

BranchLook measure_branch_look(const ColorImage& photo, const FragmentLibrary& library) {
  const ScalarImage level = luma(photo);
  ScalarImage ground_weight(level.size());
  for (std::size_t i = 0; i < ground_weight.pixels().size(); ++i) {
    ground_weight.pixels()[i] = library.field.signed_distance.pixels()[i] > 3.0f ? 1.0f : 0.0f;
  }
  const ScalarImage smooth = masked_blur(level, ground_weight, 6.0);
  std::vector<float> core, near, grain, radii;
  for (std::size_t i = 0; i < level.pixels().size(); ++i) {
    if (library.unusable.pixels()[i] || library.shadow.pixels()[i]) continue;
    const float distance = library.field.signed_distance.pixels()[i], value = level.pixels()[i];
    if (library.field.centre_distance.pixels()[i] <= std::max(0.7f, 0.5f * library.field.radius.pixels()[i])) {
      core.push_back(value);
      radii.push_back(library.field.radius.pixels()[i]);
    } else if (distance > 3.0f && distance < 12.0f) {
      near.push_back(value);
      grain.push_back(std::abs(value - smooth.pixels()[i]));
    }
  }
  BranchLook look;
  look.ground = median(near);
  look.contrast = median(core) - look.ground;
  look.radius = median(radii);
  look.roughness = 1.4826 * median(grain) / std::max(1e-6, std::abs(look.contrast));
  return look;
}

CompositeMode choose_composite_mode(const Exemplar& exemplar, const FragmentLibrary& library) {
  if (exemplar.polarity == Polarity::Glow) return CompositeMode::Emit;
  const BranchLook look = measure_branch_look(exemplar.photo.color, library);
  // Measured on ten photos (docs/decisions/0021): lightning's core 0.90 and roughness 0.02, the next bright ones 0.91 but
  // 0.19 (snow on ridges) and 0.46 but 0.04 (roots); retina's roughness 0.14, the smoothest crack's 0.21.
  constexpr double kLuminous = 0.8, kDarkGround = 0.5, kEvenGround = 0.1, kSmoothGround = 0.17, kThin = 8.0;
  constexpr double kOpaque = 0.5;  // of the ground: a vessel 0.73 to 0.85, a bare tree 0.31
  if (look.ground < kDarkGround && look.contrast + look.ground > kLuminous && look.roughness < kEvenGround) {
    return CompositeMode::Emit;
  }
  const bool shines_through = look.ground + look.contrast > kOpaque * look.ground;
  if (look.contrast < 0.0 && shines_through && look.radius < kThin && look.roughness < kSmoothGround) {
    return CompositeMode::Absorb;
  }
  return CompositeMode::Paste;
}

}  // namespace ramify
