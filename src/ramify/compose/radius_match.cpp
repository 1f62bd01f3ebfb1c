// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/compose/placement.h"
#include "ramify/skeleton/radius_map.h"

namespace ramify {
namespace {

constexpr double kSlack = 1.25;  // fragments still match at this ratio of widths

std::vector<double> all_radii(const std::vector<BranchCurve>& curves) {
  std::vector<double> all;
  for (const BranchCurve& curve : curves) all.insert(all.end(), curve.radii.begin(), curve.radii.end());
  return all;
}

}  // namespace

Skeleton match_radii(const Skeleton& skeleton, const FragmentLibrary& library) {
  const std::vector<double> target = all_radii(branch_curves(skeleton, {0.0, 0.0})), source = all_radii(library.curves);
  if (target.empty() || source.empty()) return skeleton;
  const RadiusSpread own = measure_radius_spread(target);
  if (own.radius_at(0.05) >= library.thinnest / kSlack && own.radius_at(0.95) <= library.thickest * kSlack)
    return skeleton;
  return map_radii(skeleton, measure_radius_spread(source));
}

}  // namespace ramify
