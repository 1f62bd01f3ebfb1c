// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/report/width_figures.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "ramify/core/parallel.h"
#include "ramify/exemplar/width_probe.h"
#include "ramify/image/color.h"
#include "ramify/image/sample.h"
#include "ramify/skeleton/branches.h"
#include "ramify/skeleton/curve.h"

namespace ramify {
namespace {

constexpr double kThinnest = 1.0;    // px; below, a width is hardly seen
constexpr double kSure = 0.3;        // confidence of the probe
constexpr int kShortest = 12;        // samples of a branch

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// Mean of centre line minus mean of the ground beside it.
double contrast(const ScalarImage& picture, const std::vector<BranchCurve>& curves) {
  double sum = 0.0;
  int count = 0;
  for (const BranchCurve& curve : curves) {
    for (int i = std::max(1, curve.rim); i + 1 < curve.count(); i += 4) {
      const Vec2 tangent = (curve.points[i + 1] - curve.points[i - 1]).normalized();
      const Vec2 beside = (1.5 * curve.radii[i] + 4.0) * perpendicular(tangent);
      sum += sample_bilinear(picture, curve.points[i]) -
             0.5 * (sample_bilinear(picture, curve.points[i] + beside) + sample_bilinear(picture, curve.points[i] - beside));
      ++count;
    }
  }
  return count > 0 ? sum / count : 0.0;
}

}  // namespace

WidthRatio measure_width_ratio(const ColorImage& color, const Skeleton& skeleton, bool glow) {
  const ScalarImage picture = luma(color);
  const std::vector<BranchCurve> curves = branch_curves(skeleton);
  WidthProbeOptions options;
  options.glow = glow;
  options.bright = glow || contrast(picture, curves) > 0.0;
  std::vector<std::vector<double>> found(curves.size());
  parallel_for(static_cast<int>(curves.size()), [&](int k) {
    const BranchCurve& curve = curves[k];
    if (curve.count() - curve.rim < kShortest) return;
    const std::vector<Vec2> line(curve.points.begin() + curve.rim, curve.points.end());
    const std::vector<double> stated(curve.radii.begin() + curve.rim, curve.radii.end());
    const ProbedLine probed = probe_widths(picture, line, stated, options);
    for (std::size_t i = 0; i < line.size(); ++i) {
      const double r = stated[i], x = line[i].x(), y = line[i].y();
      const bool inside = x > 2.0 * r && y > 2.0 * r && x < color.width() - 1 - 2.0 * r && y < color.height() - 1 - 2.0 * r;
      if (r >= kThinnest && inside && probed.confidence[i] > kSure) found[k].push_back(probed.radii[i] / r);
    }
  });
  std::vector<double> ratios;
  for (const auto& part : found) ratios.insert(ratios.end(), part.begin(), part.end());
  WidthRatio out;
  out.samples = static_cast<int>(ratios.size());
  if (ratios.empty()) return out;
  out.middle = median(ratios);
  for (double& v : ratios) v = std::abs(v / out.middle - 1.0);
  out.deviation = median(std::move(ratios));
  return out;
}

}  // namespace ramify
