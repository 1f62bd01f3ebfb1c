// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/compose/target.h"

#include <algorithm>
#include <cmath>

#include "ramify/exemplar/shore.h"

namespace ramify {
namespace {

// Furcation discs a curve passes, in the order of their vertices.
struct Passed {
  int vertex, fragment;
};

class Cover {
 public:
  Cover(const std::vector<BranchCurve>& curves, const BranchField& field, const TargetOptions& options)
      : curves_(curves), field_(field), options_(options) {
    result_.chains.resize(curves.size());
    passed_.resize(curves.size());
    start_.assign(curves.size(), kNone);
  }

  TargetSet run() {
    for (std::size_t c = 0; c < curves_.size(); ++c) place_furcation(static_cast<int>(c));
    for (std::size_t c = 0; c < curves_.size(); ++c) {
      if (curves_[c].count() >= 2) cover_curve(static_cast<int>(c));
    }
    if (options_.fragment.wide_radius > 0.0) cover_wide();
    return std::move(result_);
  }

 private:
  void place_furcation(int child) {
    const auto furcation = furcation_fragment(curves_, child, options_.fragment);
    if (!furcation || (furcation->kind == FragmentKind::Side && is_wide(furcation->branch_radius))) return;
    start_[child] = static_cast<int>(result_.fragments.size());
    if (furcation->kind == FragmentKind::Junction) passed_[furcation->curve].push_back({furcation->vertex, start_[child]});
    result_.fragments.push_back(*furcation);
  }

  bool is_wide(double radius) const {
    return options_.fragment.wide_radius > 0.0 && radius >= options_.fragment.wide_radius;
  }

  void add_disc(int curve, int vertex) {
    if (is_wide(curves_[curve].radii[vertex])) return;
    result_.chains[curve].push_back(static_cast<int>(result_.fragments.size()));
    result_.fragments.push_back(along_fragment(curves_, curve, vertex, options_.fragment));
  }

  // The last disc of the curve's chain; null at its start.
  const Fragment* last_of(int curve) const {
    return result_.chains[curve].empty() ? nullptr : &result_.fragments[result_.chains[curve].back()];
  }

  // Is the next furcation so near that its disc covers this place as well?
  bool near_next(int c, std::size_t next, int vertex, double radius) const {
    if (options_.parent_first || next >= passed_[c].size()) return false;
    const Fragment& furcation = result_.fragments[passed_[c][next].fragment];
    const double distance = (curves_[c].points[furcation.vertex] - curves_[c].points[vertex]).norm();
    return distance < 0.35 * (furcation.radius + radius);
  }

  void cover_curve(int c) {
    const BranchCurve& curve = curves_[c];
    std::vector<Passed>& passed = passed_[c];
    std::stable_sort(passed.begin(), passed.end(), [](const Passed& a, const Passed& b) { return a.vertex < b.vertex; });
    if (start_[c] != kNone) {
      result_.chains[c].push_back(start_[c]);
    } else {
      add_disc(c, curve.rim);
    }
    std::size_t next = 0;
    for (int i = curve.rim; i < curve.count(); ++i) {
      if (!options_.parent_first && next < passed.size() && i >= passed[next].vertex) {
        result_.chains[c].push_back(passed[next++].fragment);
        continue;
      }
      const double radius = disc_radius(curve.radii[i], options_.fragment);
      const Fragment* last = last_of(c);
      if (last && (curve.points[i] - last->centre).norm() < options_.spacing * (last->radius + radius)) continue;
      if (!near_next(c, next, i, radius)) add_disc(c, i);
    }
    cover_end(c);
  }

  void cover_end(int c) {
    const BranchCurve& curve = curves_[c];
    const int end = curve.count() - 1;
    const Fragment* last = last_of(c);
    if (end < 3 || (last && (curve.points[end] - last->centre).norm() <= 0.5 * last->radius)) return;
    const double back = curve.tip ? 0.4 * disc_radius(curve.radii[end], options_.fragment) : 0.0;
    add_disc(c, std::max(0, end - static_cast<int>(back)));
  }

  void cover_wide() {
    const double disc = options_.fragment.bank_disc, step = 2.0 * options_.spacing * disc;
    const std::vector<BranchCurve> shores = wide_shores(field_, options_.fragment.wide_radius);
    for (int s = 0; s < static_cast<int>(shores.size()); ++s) {
      const int count = std::max(1, static_cast<int>(std::ceil(shores[s].count() / step)));
      result_.chains.emplace_back();
      for (int k = 0; k < count; ++k) {
        const int vertex = static_cast<int>((k + 0.5) * shores[s].count() / count);
        result_.chains.back().push_back(static_cast<int>(result_.fragments.size()));
        result_.fragments.push_back(bank_fragment(shores, s, vertex, disc));
      }
    }
    // A staggered grid over what lies deeper than the banks' discs reach.
    result_.chains.emplace_back();
    for (int row = 0; row * 0.8 * step < field_.curve.height() + step; ++row) {
      for (double x = row % 2 ? 0.5 * step : 0.0; x < field_.curve.width() + step; x += step) {
        const Vec2 centre(std::min<double>(x, field_.curve.width() - 1), std::min<double>(row * 0.8 * step, field_.curve.height() - 1));
        if (field_.signed_distance(static_cast<int>(centre.x()), static_cast<int>(centre.y())) > -0.3 * disc) continue;
        result_.chains.back().push_back(static_cast<int>(result_.fragments.size()));
        result_.fragments.push_back(interior_fragment(curves_, field_, centre, disc));
      }
    }
  }

  const std::vector<BranchCurve>& curves_;
  const BranchField& field_;
  const TargetOptions& options_;
  std::vector<std::vector<Passed>> passed_;
  std::vector<int> start_;  // furcation disc a curve starts with
  TargetSet result_;
};

}  // namespace

TargetSet cover_skeleton(const std::vector<BranchCurve>& curves, const BranchField& field, const TargetOptions& options) {
  return Cover(curves, field, options).run();
}

}  // namespace ramify
