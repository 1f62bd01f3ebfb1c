// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/recipe/foreign_skeleton.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "ramify/core/error.h"
#include "ramify/skeleton/edit.h"
#include "ramify/skeleton/radius_map.h"

namespace ramify {
namespace {

constexpr double kLeastScale = 0.5, kMostScale = 2.0;  // fragments are used at their own size: more is another picture
constexpr double kOwnMedian = 1.5;                     // seeds of one style differ by less
constexpr double kOwnRange = 1.25;                     // fragments still match at this ratio of widths

std::string short_text(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.2g", value);
  return text;
}

}  // namespace

std::vector<OptionField> describe(SkeletonFitOptions& o) {
  return {choice("radii", o.radii, {"auto", "map", "keep"},
                 "Widths: map them to the exemplar's by quantiles, or keep them; auto maps a foreign skeleton's."),
          number("thickness", o.thickness, 0.1, 10.0, "", "Factor of the mapped widths; none becomes thinner than the exemplar's thinnest."),
          number("scale", o.scale, 0.0, kMostScale, "",
                 "Factor of skeleton and canvas, 0.5 to 2; 0 = chosen, 1 to 2: a foreign skeleton grows until its "
                 "median width is the exemplar's."),
          number("restyle", o.restyle, 0.0, 1.0, "",
                 "How far bends become the exemplar's; 0 = not at all. Roots and tips stay where they are.")};
}

void check_fit(const SkeletonFitOptions& options) {
  if (options.scale != 0.0 && options.scale < kLeastScale)
    throw OptionError("scale", number_text(options.scale), "expected 0.5 to 2, or 0 to choose it");
}

bool is_foreign(const Skeleton& skeleton, const Skeleton& exemplar) {
  const RadiusSpread own = measure_radius_spread(skeleton), photo = measure_radius_spread(exemplar);
  const double ratio = photo.radius_at(0.5) / own.radius_at(0.5);
  return ratio > kOwnMedian || ratio < 1.0 / kOwnMedian || own.radius_at(0.05) < photo.radii.front() / kOwnRange ||
         own.radius_at(0.95) > photo.radii.back() * kOwnRange;
}

Skeleton fit_skeleton(Skeleton skeleton, const Skeleton& exemplar, const SkeletonFitOptions& options, bool held,
                      const Monitor& monitor) {
  const bool foreign = is_foreign(skeleton, exemplar);
  const RadiusSpread photo = measure_radius_spread(exemplar);
  double scale = options.scale;
  if (scale == 0.0 && foreign && !held) {
    // It never shrinks by itself: mapped to thinner widths its branches only stand further apart.
    scale = std::clamp(photo.radius_at(0.5) / measure_radius_spread(skeleton).radius_at(0.5), 1.0, kMostScale);
    if (scale < kOwnRange) scale = 1.0;
  }
  if (scale != 0.0 && scale != 1.0) {
    Similarity enlarged;
    enlarged.scale = scale;
    enlarged.shift = Vec2::Constant(0.5 * (scale - 1.0));  // about the picture's corner, not the first pixel's centre
    Size canvas = skeleton.size;
    if (!held)
      canvas = {std::max(1, static_cast<int>(std::lround(scale * canvas.width))),
                std::max(1, static_cast<int>(std::lround(scale * canvas.height)))};
    skeleton = transform_skeleton(skeleton, enlarged, canvas);
    if (options.scale == 0.0)
      monitor.note("the skeleton is thinner than the exemplar: scaled by " + short_text(scale) + " (--scale)");
  }
  if (options.radii == RadiusFit::Keep || (options.radii == RadiusFit::Auto && !foreign)) return skeleton;
  skeleton = map_radii(skeleton, photo);
  for (int i = 0; i < skeleton.count(); ++i) skeleton.set_radius(i, std::max(photo.radii.front(), options.thickness * skeleton[i].radius));
  if (options.radii == RadiusFit::Auto) monitor.note("the skeleton's widths were mapped to the exemplar's (--radii)");
  return skeleton;
}

}  // namespace ramify
