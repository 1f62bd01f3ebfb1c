// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/exemplar/trace_cleaning.h"

#include <algorithm>
#include <cmath>

#include "ramify/exemplar/trace_graph.h"
#include "ramify/exemplar/traced_line.h"

namespace ramify {
namespace {

constexpr double kStubWidths = 2.0, kStubLength = 4.0;  // a tip is longer than so many radii and px
constexpr double kShort = 12.0;                         // radii; a longer branch has stretches clear of its parent

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

Annotation without_stubs(const Annotation& full) {
  std::vector<bool> needed(full.branches.size(), false);
  for (const AnnotatedBranch& b : full.branches)
    if (b.parent) needed[b.parent->branch] = true;
  for (const auto& [a, b] : full.links) needed[a.branch] = needed[b.branch] = true;
  std::vector<int> fresh(full.branches.size(), kNone);
  Annotation out = full;
  out.branches.clear();
  for (std::size_t i = 0; i < full.branches.size(); ++i) {
    AnnotatedBranch b = full.branches[i];
    const double length = line_length(b.points), radius = median(b.radii);
    if (!needed[i] && b.parent && !b.leaves_frame.value_or(false) && length < kStubWidths * radius + kStubLength)
      continue;
    if (b.parent && length < kShort * radius) {
      const double most = full.branches[b.parent->branch].radii[b.parent->point];
      for (double& r : b.radii) r = std::min(r, most);
    }
    if (b.parent) b.parent->branch = fresh[b.parent->branch];
    fresh[i] = static_cast<int>(out.branches.size());
    out.branches.push_back(std::move(b));
  }
  for (auto& [a, b] : out.links) a.branch = fresh[a.branch], b.branch = fresh[b.branch];
  return out;
}

void calm_radii(Annotation& annotation) {
  for (AnnotatedBranch& b : annotation.branches) {
    const std::vector<double> measured = b.radii;
    const int n = static_cast<int>(measured.size());
    for (int i = 0; i < n; ++i) {
      const int half = 8 + static_cast<int>(2.0 * std::min(measured[i], 30.0));
      std::vector<double> near(measured.begin() + std::max(0, i - half), measured.begin() + std::min(n, i + half + 1));
      const auto middle = near.begin() + static_cast<std::ptrdiff_t>(near.size() / 2);
      std::nth_element(near.begin(), middle, near.end());
      b.radii[i] = std::clamp(measured[i], 0.67 * *middle, 1.33 * *middle);
    }
    b.radii = smoothed(b.radii, 2.0);
  }
}

Annotation thinned_out(const Annotation& full) {
  Annotation out = full;
  std::vector<std::vector<bool>> needed;
  for (const auto& b : full.branches) needed.emplace_back(b.points.size(), false);
  for (std::size_t b = 0; b < full.branches.size(); ++b) {
    needed[b].front() = needed[b].back() = true;
    if (const auto& p = full.branches[b].parent) needed[p->branch][p->point] = true;
  }
  for (const auto& [a, c] : full.links) needed[a.branch][a.point] = needed[c.branch][c.point] = true;
  std::vector<std::vector<int>> fresh(full.branches.size());
  for (std::size_t b = 0; b < full.branches.size(); ++b) {
    const AnnotatedBranch& from = full.branches[b];
    AnnotatedBranch& to = out.branches[b];
    to.points.clear();
    to.radii.clear();
    double since = 0.0;
    for (std::size_t i = 0; i < from.points.size(); ++i) {
      if (i > 0) since += (from.points[i] - from.points[i - 1]).norm();
      if (needed[b][i] || since >= std::clamp(0.5 * from.radii[i], 2.0, 6.0)) {
        to.points.push_back(from.points[i]);
        to.radii.push_back(from.radii[i]);
        since = 0.0;
      }
      fresh[b].push_back(static_cast<int>(to.points.size()) - 1);
    }
  }
  const auto moved = [&](BranchPoint& p) { p.point = fresh[p.branch][p.point]; };
  for (auto& b : out.branches) {
    if (b.parent) moved(*b.parent);
  }
  for (auto& [a, c] : out.links) {
    moved(a);
    moved(c);
  }
  return out;
}

}  // namespace ramify
