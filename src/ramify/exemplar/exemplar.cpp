// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/exemplar/exemplar.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "ramify/core/error.h"
#include "ramify/exemplar/rectification.h"
#include "ramify/exemplar/region_map.h"
#include "ramify/image/filter.h"
#include "ramify/skeleton/draw.h"
#include "ramify/skeleton/edit.h"

namespace ramify {
namespace {

constexpr double kStaircase = 2.0;  // px, smoothing of pixel chains (PICTURES 10)

// Is it a raw pixel chain, most steps going to one of the eight neighbours? Such a staircase must not be learnt.
bool is_pixel_chain(const Skeleton& skeleton) {
  int steps = 0, on_grid = 0;
  for (const Node& node : skeleton.nodes()) {
    if (node.parent == kNone) continue;
    const Vec2 d = node.xy() - skeleton[node.parent].xy();
    const double larger = d.cwiseAbs().maxCoeff(), smaller = d.cwiseAbs().minCoeff();
    ++steps;
    on_grid += std::abs(larger - 1.0) < 1e-6 && (smaller < 1e-6 || std::abs(smaller - 1.0) < 1e-6);
  }
  return steps > 0 && on_grid > 0.6 * steps;
}

// The polarity most of the annotated length has, if any is given.
std::optional<Polarity> annotated_polarity(const Annotation& annotation) {
  std::array<double, 3> votes{};
  for (const AnnotatedBranch& b : annotation.branches) {
    if (b.polarity) votes[static_cast<std::size_t>(*b.polarity)] += static_cast<double>(b.points.size());
  }
  const auto most = std::max_element(votes.begin(), votes.end());
  if (*most == 0.0) return std::nullopt;
  return static_cast<Polarity>(most - votes.begin());
}

float median(std::vector<float> values) {
  if (values.empty()) return 0.0f;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// Branches against the ring of 3 … 8 px around them. Light that is nearly white on a dark picture glows.
Polarity measured_polarity(const ColorImage& photo, const Mask& branch_mask) {
  const ScalarImage away = distance_to(branch_mask);
  std::vector<float> inside, around, brightest, everywhere;
  for (std::size_t i = 0; i < photo.pixels().size(); ++i) {
    const Rgb& c = photo.pixels()[i];
    const float light = 0.2126f * c.r + 0.7152f * c.g + 0.0722f * c.b, top = std::max({c.r, c.g, c.b});
    everywhere.push_back(top);
    if (branch_mask.pixels()[i]) {
      inside.push_back(light);
      brightest.push_back(top);
    } else if (away.pixels()[i] > 3.0f && away.pixels()[i] < 8.0f) {
      around.push_back(light);
    }
  }
  if (median(inside) <= median(around)) return Polarity::Dark;
  return median(brightest) > 0.85f && median(everywhere) < 0.5f ? Polarity::Glow : Polarity::Bright;
}

// Mean radius along the length.
double mean_radius(const Skeleton& skeleton) {
  double sum = 0.0, length = 0.0;
  for (const Node& node : skeleton.nodes()) {
    if (node.parent == kNone) continue;
    const double step = (node.position - skeleton[node.parent].position).norm();
    sum += step * node.radius;
    length += step;
  }
  return length > 0.0 ? sum / length : 0.0;
}

// The photo as the annotation sees it: without perspective where that was taken out.
void rectify(Photo& photo, const Annotation& annotation) {
  if (!annotation.rectified_from_photo || !annotation.rectified_size) return;
  Warped warped = warp_picture(photo.color, photo.alpha, homography_from_row_major(*annotation.rectified_from_photo),
                               *annotation.rectified_size);
  for (std::uint8_t& v : warped.valid.pixels()) v = v >= 128 ? 255 : 0;
  photo.color = std::move(warped.color);
  photo.alpha = std::move(warped.valid);
}

}  // namespace

Exemplar make_exemplar(Photo photo, Annotation annotation) {
  if (!(photo.color.size() == annotation.photo_size)) {
    throw InputError(photo.name, "has " + std::to_string(photo.color.width()) + " x " +
                                     std::to_string(photo.color.height()) + " pixels, but its annotation was made for " +
                                     std::to_string(annotation.photo_size.width) + " x " +
                                     std::to_string(annotation.photo_size.height));
  }
  Exemplar exemplar;
  exemplar.skeleton = skeleton_from_annotation(annotation);
  rectify(photo, annotation);
  if (is_pixel_chain(exemplar.skeleton)) exemplar.skeleton = smooth_skeleton(exemplar.skeleton, kStaircase);
  exemplar.skeleton = cut_at_rim(exemplar.skeleton);
  exemplar.unit_radius = mean_radius(exemplar.skeleton);
  if (!(exemplar.unit_radius > 0.0)) {
    throw InputError(photo.name, "the annotation has no usable branch; trace the photo or draw at least one branch");
  }
  exemplar.branch_mask = draw_branch_mask(exemplar.skeleton, photo.color.size());
  for (std::uint8_t& v : exemplar.branch_mask.pixels()) v = v >= 128 ? 255 : 0;
  const std::optional<Polarity> given = annotated_polarity(annotation);
  exemplar.polarity = given ? *given : measured_polarity(photo.color, exemplar.branch_mask);
  exemplar.regions = region_map(annotation.regions, photo.color.size(), photo.alpha);
  exemplar.photo = std::move(photo);
  exemplar.annotation = std::move(annotation);
  return exemplar;
}

}  // namespace ramify
