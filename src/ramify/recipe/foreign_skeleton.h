// SPDX-License-Identifier: GPL-3.0-or-later
// Any skeleton for any photo: its scale, widths and bends brought to the exemplar's (ALGORITHMS 11-1).
#pragma once

#include "ramify/core/monitor.h"
#include "ramify/core/options.h"
#include "ramify/core/random.h"
#include "ramify/skeleton/skeleton.h"
#include "ramify/style/style.h"

namespace ramify {

enum class RadiusFit {
  Auto,  // as Map for a foreign skeleton, else Keep
  Map,   // by quantiles to the exemplar's radii
  Keep
};

struct SkeletonFitOptions {
  RadiusFit radii = RadiusFit::Auto;
  double thickness = 1.0;  // factor of the mapped radii, 0.1..10; none falls below the exemplar's thinnest
  double scale =
      0.0;  // 0.5..2, of skeleton and canvas; 0 = chosen, 1..2: a foreign skeleton thinner than the exemplar grows
  double restyle = 0.0;  // 0..1, how far its bends become the exemplar's
};
std::vector<OptionField> describe(SkeletonFitOptions& options);

// Throws OptionError for a scale between 0 and 0.5.
void check_fit(const SkeletonFitOptions& options);

// Whether a skeleton's widths are not the exemplar's own: 5 and 95 % of them lie within a quarter of the exemplar's
// range, and the medians within a factor of 1.5, where they are.
bool is_foreign(const Skeleton& skeleton, const Skeleton& exemplar);

// Scales skeleton and canvas and maps the radii; the canvas stays as it is where `held` (a given size). Tells in notes
// what was chosen. The skeleton is not empty.
Skeleton fit_skeleton(Skeleton skeleton, const Skeleton& exemplar, const SkeletonFitOptions& options, bool held,
                      const Monitor& monitor);

}  // namespace ramify
