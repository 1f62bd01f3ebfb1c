// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>

#include "ramify/core/error.h"
#include "ramify/core/parallel.h"
#include "ramify/exemplar/shore.h"
#include "ramify/image/color.h"
#include "ramify/image/filter.h"

namespace ramify {
namespace {

constexpr double kPaperLambda = 0.75;
constexpr double kShortEnd = 6.0;  // px; branches below this give no fragment of their own

// Mean Lab colour of the branch's core against that of its near surround, within the disc.
double measure_contrast(const FragmentLibrary& library, const Fragment& f) {
  Rgb inside, outside;
  int inside_count = 0, outside_count = 0;
  const int reach = static_cast<int>(f.radius);
  const float core = static_cast<float>(std::max(1.0, 0.6 * f.branch_radius));
  for (int dy = -reach; dy <= reach; ++dy) {
    for (int dx = -reach; dx <= reach; ++dx) {
      const int x = static_cast<int>(std::lround(f.centre.x())) + dx, y = static_cast<int>(std::lround(f.centre.y())) + dy;
      if (dx * dx + dy * dy > reach * reach || !library.lab.contains(x, y)) continue;
      if (library.field.centre_distance(x, y) < core) {
        inside = inside + library.lab(x, y);
        ++inside_count;
      } else if (library.field.signed_distance(x, y) > 3.0f && library.field.signed_distance(x, y) < 12.0f) {
        outside = outside + library.lab(x, y);
        ++outside_count;
      }
    }
  }
  if (inside_count == 0 || outside_count == 0) return 0.0;
  return delta_e(1.0f / inside_count * inside, 1.0f / outside_count * outside);
}

// Centres along one curve, from its parent's rim to its end, with some more at a tip (tips are rare).
std::vector<int> source_vertices(const BranchCurve& curve, const FragmentOptions& options) {
  std::vector<int> vertices;
  double next = curve.rim;
  for (int i = curve.rim; i < curve.count(); ++i) {
    if (i < next) continue;
    vertices.push_back(i);
    const double radius = disc_radius(curve.radii[i], options);
    next = i + (options.paper_spacing ? 2.0 * kPaperLambda * radius : std::max(2.0, options.source_spacing * radius));
  }
  if (curve.tip && !options.paper_spacing && curve.count() > kShortEnd) {
    for (const double share : {0.2, 0.5, 0.8}) {
      const int i = curve.count() - 1 - static_cast<int>(share * disc_radius(curve.radii.back(), options));
      if (i > curve.rim) vertices.push_back(i);
    }
  }
  return vertices;
}

// Share of the brightness difference between the two banks that the branch's direction explains (ALGORITHMS 5.2):
// least squares of left minus right on cosine and sine. Grain is taken out before; single pixels of it hide the light.
double measure_light(const FragmentLibrary& library) {
  constexpr double kCalm = 2.0, kBeside = 3.0;  // px
  const ScalarImage lightness = gaussian_blur(channel(library.lab, 0), kCalm);
  double cc = 0, cs = 0, ss = 0, cd = 0, sd = 0, dd = 0;
  for (const Fragment& f : library.fragments) {
    if (f.kind != FragmentKind::Along) continue;
    const ShapeSample& middle = f.shape[f.shape.size() / 2];
    const Vec2 away = (f.branch_radius + kBeside) * middle.normal, tangent = -perpendicular(middle.normal);
    auto level = [&](const Vec2& p) {
      return lightness.clamped(static_cast<int>(std::lround(p.x())), static_cast<int>(std::lround(p.y())));
    };
    const double d = level(f.centre + away) - level(f.centre - away), c = tangent.x(), s = tangent.y();
    cc += c * c, cs += c * s, ss += s * s, cd += c * d, sd += s * d, dd += d * d;
  }
  const double determinant = cc * ss - cs * cs;
  if (determinant < 1e-9 || dd <= 0.0) return 0.0;
  const double a = (ss * cd - cs * sd) / determinant, b = (cc * sd - cs * cd) / determinant;
  return std::sqrt(std::clamp((a * cd + b * sd) / dd, 0.0, 1.0));
}

// Banks of branches down to half the width that needs them (their discs then hold the other bank as well, and compete
// only where the target does too), and places well inside.
void add_wide_sources(FragmentLibrary& library, const FragmentOptions& options) {
  if (options.wide_radius <= 0.0 || options.paper_spacing) return;
  library.shores = wide_shores(library.field, 0.5 * options.wide_radius);
  const int step = std::max(2, static_cast<int>(options.source_spacing * options.bank_disc));
  for (int s = 0; s < static_cast<int>(library.shores.size()); ++s) {
    for (int v = 0; v < library.shores[s].count(); v += step) {
      library.fragments.push_back(bank_fragment(library.shores, s, v, options.bank_disc));
    }
  }
  for (int y = 0; y < library.lab.height(); y += step) {
    for (int x = 0; x < library.lab.width(); x += step) {
      if (library.field.signed_distance(x, y) > -0.6 * options.bank_disc) continue;
      library.fragments.push_back(interior_fragment(library.curves, library.field, Vec2(x, y), options.bank_disc));
    }
  }
}

void measure_radii(FragmentLibrary& library) {
  std::vector<double> radii;
  for (const BranchCurve& curve : library.curves) radii.insert(radii.end(), curve.radii.begin(), curve.radii.end());
  std::sort(radii.begin(), radii.end());
  library.thinnest = radii[static_cast<std::size_t>(0.02 * static_cast<double>(radii.size() - 1))];
  library.thickest = radii[static_cast<std::size_t>(0.98 * static_cast<double>(radii.size() - 1))];
}

}  // namespace

FragmentLibrary make_fragment_library(const Exemplar& exemplar, Mask shadow, Mask unusable,
                                      const FragmentOptions& options) {
  FragmentLibrary library;
  const Size size = exemplar.photo.color.size();
  library.curves = branch_curves(exemplar.skeleton);
  library.field = measure_branch_field(library.curves, size);
  library.lab = lab_from_srgb(exemplar.photo.color);
  library.shadow = shadow.empty() ? Mask(size) : std::move(shadow);
  library.unusable = unusable.empty() ? Mask(size) : std::move(unusable);
  for (int c = 0; c < static_cast<int>(library.curves.size()); ++c) {
    check_cancel();
    if (library.curves[c].count() < 2) continue;
    for (const int vertex : source_vertices(library.curves[c], options)) {
      library.fragments.push_back(along_fragment(library.curves, c, vertex, options));
    }
    if (const auto furcation = furcation_fragment(library.curves, c, options)) library.fragments.push_back(*furcation);
  }
  if (library.fragments.empty()) {
    throw InputError(exemplar.photo.name, "the annotation has no branch longer than a point, so there is nothing to cut; "
                                          "annotate at least one branch");
  }
  parallel_for(static_cast<int>(library.fragments.size()), [&](int i) {
    Fragment& f = library.fragments[static_cast<std::size_t>(i)];
    if (f.kind < FragmentKind::Bank) f.contrast = measure_contrast(library, f);
  }, 16);
  add_wide_sources(library, options);
  measure_radii(library);
  library.light_strength = measure_light(library);
  return library;
}

double usual_contrast(const FragmentLibrary& library, double branch_radius) {
  std::vector<double> values;
  for (const Fragment& f : library.fragments) {
    if (f.kind >= FragmentKind::Bank) continue;
    const double ratio = (f.branch_radius + 1.0) / (branch_radius + 1.0);
    if (ratio > 0.74 && ratio < 1.35) values.push_back(f.contrast);
  }
  if (values.size() < 5) return 0.0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() * 6 / 10);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace ramify
