// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/compose/coverage.h"

#include <algorithm>
#include <cmath>

#include "ramify/exemplar/shore.h"
#include "ramify/geometry/polyline.h"

namespace ramify {
namespace {

constexpr double kInside = 1.0;      // px within the edge from which a pixel must show branch
constexpr double kRim = 0.2;         // of the radius: what is nearer to the edge may be left to the bank beside it
constexpr float kShown = 1.0f;       // px beyond the photo's annotated edge that still pass for branch
constexpr double kDiscShare = 0.95;  // of the disc radius, as far as the cut takes a fragment
constexpr int kDiscGrid = 9;         // a disc is sampled on 19 x 19 points
constexpr int kStep = 2;             // px between the places that are looked at
constexpr double kFilled = 0.7;      // of the disc radius: what a disc laid on a bare place is relied on for

bool shows_branch(const FragmentLibrary& library, const Placement& placement, const Vec2& canvas) {
  const Vec2 q = placement.photo_from_canvas(canvas);
  const int u = static_cast<int>(std::lround(q.x())), v = static_cast<int>(std::lround(q.y()));
  return library.lab.contains(u, v) && !library.unusable(u, v) && library.field.signed_distance(u, v) <= kShown;
}

// Is the place inside the part of the curve that lies within `reach` vertices of `vertex`?
bool is_inside(const BranchCurve& curve, int vertex, int reach, const Vec2& p) {
  const int last = std::min(curve.count() - 1, vertex + reach);
  for (int i = std::max(0, vertex - reach); i <= last;) {
    const double r = curve.radii[i] - kInside, d = (curve.points[i] - p).norm();
    if (d < r) return true;
    i += std::max(1, static_cast<int>(d - r));  // vertices are 1 px apart
  }
  return false;
}

bool is_own(const PlacementPlan& plan, const Fragment& target, const Vec2& p) {
  if (target.kind == FragmentKind::Bank || target.kind == FragmentKind::Interior) {
    const int x = static_cast<int>(std::lround(p.x())), y = static_cast<int>(std::lround(p.y()));
    return plan.field.signed_distance(x, y) < -kInside;
  }
  const int reach = static_cast<int>(2.0 * target.radius);
  if (is_inside(plan.curves[target.curve], target.vertex, reach, p)) return true;
  return target.child != kNone && is_inside(plan.curves[target.child], plan.curves[target.child].rim, reach, p);
}

// Half the resolution: 1 where a branch is wanted, 2 where a placement shows it.
Image<std::uint8_t> shown_branches(const FragmentLibrary& library, const PlacementPlan& plan) {
  const Size size = plan.field.signed_distance.size();
  Image<std::uint8_t> state((size.width + kStep - 1) / kStep, (size.height + kStep - 1) / kStep, 0);
  for (int y = 0; y < state.height(); ++y) {
    for (int x = 0; x < state.width(); ++x) {
      const double inside = std::max(kInside, kRim * plan.field.radius(kStep * x, kStep * y));
      state(x, y) = plan.field.signed_distance(kStep * x, kStep * y) < -inside ? 1 : 0;
    }
  }
  for (const Placement& p : plan.placements) {
    const double reach = kDiscShare * p.radius;
    const int x0 = std::max(0, static_cast<int>(std::ceil((p.centre.x() - reach) / kStep)));
    const int x1 = std::min(state.width() - 1, static_cast<int>(std::floor((p.centre.x() + reach) / kStep)));
    const int y0 = std::max(0, static_cast<int>(std::ceil((p.centre.y() - reach) / kStep)));
    const int y1 = std::min(state.height() - 1, static_cast<int>(std::floor((p.centre.y() + reach) / kStep)));
    for (int y = y0; y <= y1; ++y) {
      for (int x = x0; x <= x1; ++x) {
        const Vec2 at(kStep * x, kStep * y);
        if (state(x, y) != 1 || (at - p.centre).norm() > reach) continue;
        if (shows_branch(library, p, at)) state(x, y) = 2;
      }
    }
  }
  return state;
}

// What lies within the parent's width is the parent's.
Fragment disc_on(const PlacementPlan& plan, int x, int y, const FragmentOptions& options) {
  int curve = plan.field.curve(x, y), vertex = plan.field.vertex(x, y);
  while (vertex < plan.curves[curve].rim && plan.curves[curve].parent != kNone) {
    curve = plan.curves[curve].parent;
    vertex = nearest_point(plan.curves[curve].points, Vec2(x, y));
  }
  const bool wide = options.wide_radius > 0.0 && plan.curves[curve].radii[vertex] >= options.wide_radius;
  if (!wide) return along_fragment(plan.curves, curve, vertex, options);
  return interior_fragment(plan.curves, plan.field, Vec2(x, y), options.bank_disc);
}

}  // namespace

double measure_torn_share(const FragmentLibrary& library, const PlacementPlan& plan, const Placement& placement) {
  const Fragment& target = plan.targets.fragments[placement.target];
  int own = 0, torn = 0;
  for (int gy = -kDiscGrid; gy <= kDiscGrid; ++gy) {
    for (int gx = -kDiscGrid; gx <= kDiscGrid; ++gx) {
      if (gx * gx + gy * gy > kDiscGrid * kDiscGrid) continue;
      const Vec2 p = target.centre + kDiscShare * target.radius / kDiscGrid * Vec2(gx, gy);
      const int x = static_cast<int>(std::lround(p.x())), y = static_cast<int>(std::lround(p.y()));
      if (!plan.field.curve.contains(x, y) || !is_own(plan, target, p)) continue;
      ++own;
      torn += !shows_branch(library, placement, p);
    }
  }
  return own > 0 ? static_cast<double>(torn) / own : 0.0;
}

std::vector<Fragment> cover_bare_places(const FragmentLibrary& library, const PlacementPlan& plan,
                                        const FragmentOptions& options) {
  Image<std::uint8_t> state = shown_branches(library, plan);
  std::vector<Fragment> discs;
  for (int y = 0; y < state.height(); ++y) {
    for (int x = 0; x < state.width(); ++x) {
      if (state(x, y) != 1) continue;
      discs.push_back(disc_on(plan, kStep * x, kStep * y, options));
      const Fragment& disc = discs.back();
      for (int v = 0; v < state.height(); ++v) {
        for (int u = 0; u < state.width(); ++u) {
          if ((Vec2(kStep * u, kStep * v) - disc.centre).norm() < kFilled * disc.radius) state(u, v) = 2;
        }
      }
      state(x, y) = 2;
    }
  }
  return discs;
}

}  // namespace ramify
