// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/exemplar/plate.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "ramify/exemplar/branch_zone.h"
#include "ramify/image/color.h"
#include "ramify/image/completion.h"
#include "ramify/image/filter.h"

namespace ramify {
namespace {

Mask add(Mask a, const Mask& b) {
  for (std::size_t i = 0; i < a.pixels().size(); ++i) a.pixels()[i] |= b.pixels()[i];
  return a;
}

Mask without(Mask a, const Mask& b) {
  for (std::size_t i = 0; i < a.pixels().size(); ++i) {
    if (b.pixels()[i]) a.pixels()[i] = 0;
  }
  return a;
}

Mask within(Mask a, const Mask& b) {
  for (std::size_t i = 0; i < a.pixels().size(); ++i) a.pixels()[i] &= b.pixels()[i];
  return a;
}

Mask mask_of(const Habitat& habitat, RegionRole role) {
  Mask mask(habitat.role.size(), 0);
  for (std::size_t i = 0; i < mask.pixels().size(); ++i) {
    if (habitat.role.pixels()[i] == static_cast<std::uint8_t>(role)) mask.pixels()[i] = 255;
  }
  return mask;
}

ScalarImage weight_of(const Mask& mask, bool inside) {
  ScalarImage weight(mask.size());
  for (std::size_t i = 0; i < weight.pixels().size(); ++i) {
    weight.pixels()[i] = (mask.pixels()[i] != 0) == inside ? 1.0f : 0.0f;
  }
  return weight;
}

double quantile(std::vector<float> values, double share) {
  if (values.empty()) return 0.0;
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

// How a photo differs from the ground around its branches, and how far the difference reaches.
constexpr int kSides = 8;
struct Reach {
  ScalarImage beside;      // px from the annotated branches
  ScalarImage apart;       // Lab difference to the ground around, in the branches' own direction
  double margin = 3.0;     // px beyond the annotated edge at which the median difference has died away
  double telling = 1e9;    // Lab; a difference this large beside a branch belongs to the branch
  ScalarImage direction;   // rad, away from the nearest branch
  std::array<double, kSides> side{};  // px beyond the edge, by that direction: how far a shadow to one side reaches
};

// The direction in which every pixel lies from what is nearest to it.
ScalarImage away_from_nearest(const ScalarImage& distance) {
  const ScalarImage calm = gaussian_blur(distance, 1.5);
  ScalarImage out(distance.size());
  for (int y = 0; y < out.height(); ++y) {
    for (int x = 0; x < out.width(); ++x) {
      out(x, y) =
          std::atan2(calm.clamped(x, y + 1) - calm.clamped(x, y - 1), calm.clamped(x + 1, y) - calm.clamped(x - 1, y));
    }
  }
  return out;
}

// Position of a direction among the sides, 0 … kSides.
double side_of(float direction) {
  const double s = direction / (2.0 * kPi) * kSides;
  return s < 0.0 ? s + kSides : s;
}

// A branch that casts a shadow darkens one side of it, which a median over all sides misses. What both sides have (a
// bank, a glow) does not count.
void measure_sides(Reach& reach, const Mask& banned, double rest) {
  constexpr int kFar = 20;                            // px
  constexpr std::size_t kFew = 200;                   // pixels
  const double visible = std::max(0.25, 0.4 * rest);  // Lab
  reach.direction = away_from_nearest(reach.beside);
  std::array<std::array<std::vector<float>, kFar>, kSides> at;
  for (std::size_t i = 0; i < banned.pixels().size(); ++i) {
    const float d = reach.beside.pixels()[i];
    if (banned.pixels()[i] || d <= 0.0f || d >= kFar) continue;
    const int side = static_cast<int>(std::lround(side_of(reach.direction.pixels()[i]))) % kSides;
    at[side][static_cast<std::size_t>(d)].push_back(reach.apart.pixels()[i]);
  }
  for (int k = 0; k < kSides; ++k) {
    const auto &here = at[k], &across = at[(k + kSides / 2) % kSides];
    for (std::size_t d = 1; d < kFar && here[d].size() >= kFew && across[d].size() >= kFew; ++d) {
      if (std::abs(quantile(here[d], 0.5)) < std::abs(quantile(across[d], 0.5)) + visible) break;
      reach.side[k] = static_cast<double>(d) + 1.0;
    }
  }
}

// What lies in such a shadow.
Mask shaded_sides(const Reach& reach) {
  Mask mask(reach.beside.size(), 0);
  for (std::size_t i = 0; i < mask.pixels().size(); ++i) {
    const double s = side_of(reach.direction.pixels()[i]), u = s - std::floor(s);
    const int k = static_cast<int>(s) % kSides;
    if (reach.beside.pixels()[i] < (1.0 - u) * reach.side[k] + u * reach.side[(k + 1) % kSides]) mask.pixels()[i] = 255;
  }
  return mask;
}

Reach measure_reach(const Exemplar& exemplar, const Habitat& habitat) {
  constexpr float kFar = 24.0f;  // px
  const ColorImage lab = lab_from_srgb(exemplar.photo.color);
  Reach reach;
  reach.beside = distance_to(branch_zone(exemplar.skeleton, lab.size(), [](double r) { return r; }));
  const Mask banned = add(habitat.outside, habitat.outliers);
  ScalarImage ground(lab.size());
  for (std::size_t i = 0; i < ground.pixels().size(); ++i) {
    ground.pixels()[i] = reach.beside.pixels()[i] > kFar && !banned.pixels()[i] ? 1.0f : 0.0f;
  }
  const ColorImage around = masked_blur(lab, ground, 20.0);
  // Branches differ from the ground in one direction of colour; what differs in another is not theirs (an optic disc).
  Rgb direction{};
  for (std::size_t i = 0; i < ground.pixels().size(); ++i) {
    if (reach.beside.pixels()[i] == 0.0f && !banned.pixels()[i]) direction = direction + (lab.pixels()[i] - around.pixels()[i]);
  }
  const float length = std::sqrt(direction.r * direction.r + direction.g * direction.g + direction.b * direction.b);
  if (length > 0.0f) direction = (1.0f / length) * direction;
  reach.apart = ScalarImage(lab.size());
  std::vector<std::vector<float>> at(static_cast<std::size_t>(kFar) + 1);
  std::vector<float> elsewhere;
  for (std::size_t i = 0; i < ground.pixels().size(); ++i) {
    const Rgb d = lab.pixels()[i] - around.pixels()[i];
    const float along = d.r * direction.r + d.g * direction.g + d.b * direction.b;
    reach.apart.pixels()[i] = along;
    if (banned.pixels()[i]) continue;
    if (reach.beside.pixels()[i] <= kFar) at[static_cast<std::size_t>(reach.beside.pixels()[i] + 0.5f)].push_back(std::abs(along));
    else if (i % 3 == 0) elsewhere.push_back(std::abs(along));
  }
  const double contrast = quantile(at[0], 0.5), rest = quantile(elsewhere, 0.5);
  constexpr int kMost = 14;
  const double visible = std::max(1.0, 0.03 * (contrast - rest));  // Lab; a soft shadow beside a root is seen at this
  while (reach.margin < kMost && quantile(at[static_cast<std::size_t>(reach.margin)], 0.5) > rest + visible) {
    reach.margin += 1.0;
  }
  measure_sides(reach, banned, rest);
  reach.telling = std::max(0.5 * contrast, quantile(elsewhere, 0.94));
  return reach;
}

// What touches the hole and differs from the ground as a branch does, or has colours found beside branches only: banks,
// knots and shaded sides that the annotation was too narrow for. They would stay behind as crumbs.
Mask with_crumbs(Mask hole, const Reach& reach, const Mask& own, const Skeleton& skeleton) {
  double widest = 0.0;
  for (const Node& node : skeleton.nodes()) widest = std::max(widest, node.radius);
  // A wide river's mouth may have been left out altogether.
  const float near = static_cast<float>(std::clamp(2.5 * widest, 16.0, 160.0));  // px
  Mask different = hole;
  for (std::size_t i = 0; i < hole.pixels().size(); ++i) {
    if (reach.beside.pixels()[i] >= near) continue;
    if (own.pixels()[i] || reach.apart.pixels()[i] > reach.telling) different.pixels()[i] = 255;
  }
  int count = 0;
  const LabelImage part = label_components(different, true, count);
  std::vector<std::uint8_t> touches(static_cast<std::size_t>(count), 0);
  for (std::size_t i = 0; i < hole.pixels().size(); ++i) {
    if (hole.pixels()[i]) touches[static_cast<std::size_t>(part.pixels()[i])] = 1;
  }
  Mask crumbs(hole.size(), 0);
  for (std::size_t i = 0; i < hole.pixels().size(); ++i) {
    if (!hole.pixels()[i] && part.pixels()[i] != kNone && touches[static_cast<std::size_t>(part.pixels()[i])]) crumbs.pixels()[i] = 255;
  }
  return add(std::move(hole), dilate(crumbs, 2.5));
}

// What is lifted out of the photo: branches, and the lines nobody annotated unless they are the ground's texture. What
// lies outside the habitat stays as it is.
Mask branch_holes(const Exemplar& exemplar, const Habitat& habitat, double factor, double margin, double shadow_margin) {
  Mask hole = branch_zone(exemplar.skeleton, exemplar.photo.color.size(), [&](double r) { return factor * r + margin; });
  if (!habitat.shadow_is_texture) hole = add(std::move(hole), dilate(habitat.shadow, shadow_margin));
  return without(std::move(hole), habitat.outside);
}

Mask never_copied(const Habitat& habitat) {
  return add(habitat.outside, habitat.outliers);
}

// Landmarks and kept things (a skyline) are made of themselves: what branches hide of them is copied from the rest of them.
void fill_from_itself(Plate& plate, const Mask& hole, const Mask& thing, Rng rng, const Monitor& monitor) {
  if (mean_of(hole) == 0.0 || mean_of(without(thing, hole)) == 0.0) return;
  CompletionOptions options;
  options.tone_reach = 25.0;
  const Completion inner = complete(plate.color, hole, invert(thing), options, rng, monitor);
  plate.color = inner.color;
  for (std::size_t i = 0; i < hole.pixels().size(); ++i) {
    if (hole.pixels()[i]) plate.source.pixels()[i] = inner.source.pixels()[i];
  }
}

void fill_kept(Plate& plate, const Exemplar& exemplar, const Habitat& habitat, Rng rng, const Monitor& monitor) {
  const Mask kept = mask_of(habitat, RegionRole::Keep);
  const Mask branches = branch_zone(exemplar.skeleton, kept.size(), [](double r) { return 1.5 * r + 6.0; });
  const Mask hole = within(branches, kept);
  fill_from_itself(plate, hole, kept, rng, monitor);
  plate.hole = add(std::move(plate.hole), hole);
}

Plate thin_plate(const Exemplar& exemplar, const Habitat& habitat, Rng rng, const Monitor& monitor) {
  Plate plate;
  const Reach reach = measure_reach(exemplar, habitat);
  plate.hole = add(branch_holes(exemplar, habitat, 1.15, reach.margin, 2.0), shaded_sides(reach));
  plate.hole = without(with_crumbs(std::move(plate.hole), reach, habitat.own, exemplar.skeleton), habitat.outside);
  float widest = 0.0f;
  const ScalarImage depth = distance_to(invert(plate.hole));
  for (const float d : depth.pixels()) widest = std::max(widest, std::isfinite(d) ? d : 0.0f);
  CompletionOptions options;
  options.tone_reach = 25.0;
  options.quilt.nearby = std::max(0.12 * std::max(plate.hole.width(), plate.hole.height()), 4.0 * widest);
  const Mask landmark = mask_of(habitat, RegionRole::Landmark);
  // The landmark's holes are filled with ground first, so that no branch within it colours the ground beside its rim.
  Completion filled = complete(exemplar.photo.color, plate.hole, add(add(never_copied(habitat), habitat.own), plate.hole), options,
                               rng.child("ground"), monitor.stage("ground", 0.0, 0.8));
  plate.color = std::move(filled.color);
  plate.source = std::move(filled.source);
  fill_from_itself(plate, within(plate.hole, landmark), landmark, rng.child("landmark"), monitor.stage("landmark", 0.8, 0.9));
  fill_kept(plate, exemplar, habitat, rng.child("kept"), monitor.stage("kept", 0.9, 1.0));
  return plate;
}

// The hole's own texture, from elsewhere: the photo minus its slow tones is completed; places of like brightness are
// preferred, because grain follows brightness (one level for the whole picture is far too much in the dark, 12.3-3).
Completion complete_grain(const ColorImage& grain, const ColorImage& slow, const Mask& hole, const Mask& forbidden, Rng rng,
                          const Monitor& monitor) {
  QuiltJob job;
  job.source = grain;
  job.forbidden = add(forbidden, hole);
  job.canvas = grain;
  job.hole = hole;
  constexpr double kToneWeight = 40.0;  // a difference of 0.15 in brightness costs as much as an overlap that differs fully
  const ScalarImage level = luma(slow);
  job.guides.push_back({level, level, kToneWeight});
  QuiltOptions options;
  options.patch = 72;
  options.tries = 200;
  options.sweeps = 1;
  const Quilt quilt = make_quilt(job, options, rng, monitor);
  return {blend_quilt(job, quilt, {}, 25.0, false, monitor), quilt_sources(quilt)};
}

// Two nested holes. In the halo the slow tones come from around it, and the photo's own quick ones are put back, rising
// from nothing beside the branch; in the thin hole the quick ones are copied from elsewhere.
Plate halo_plate(const Exemplar& exemplar, const Habitat& habitat, Rng rng, const Monitor& monitor) {
  const ColorImage& photo = exemplar.photo.color;
  Plate plate;
  plate.hole = branch_holes(exemplar, habitat, 1.5, 6.0, 6.0);
  // A landmark's light (a cloud base) is its own; only the branch itself is taken out of it.
  const Mask apart = add(habitat.outside, mask_of(habitat, RegionRole::Landmark));
  const auto halo = [&](double most, double factor) {
    const auto reach = [&](double r) { return std::min(most, 1.5 * r + 6.0 + factor * std::max(0.0, r - 2.5)); };
    const Mask glow = without(branch_zone(exemplar.skeleton, photo.size(), reach), apart);
    return without(add(glow, plate.hole), habitat.outside);
  };
  plate.halo = halo(80.0, 16.0);
  monitor.report(0.1);
  constexpr double kTone = 12.0;
  ColorImage around = tone_through_hole(photo, add(plate.halo, habitat.outside), kTone, monitor.stage("tone", 0.1, 0.2));
  // Before a dark sky the glow of a thick stroke is seen much farther.
  const Mask wide = halo(150.0, 26.0);
  constexpr float kDark = 0.3f;  // sRGB
  for (std::size_t i = 0; i < wide.pixels().size(); ++i) {
    if (wide.pixels()[i] && luma(around.pixels()[i]) < kDark) plate.halo.pixels()[i] = 255;
  }
  around = tone_through_hole(photo, add(plate.halo, habitat.outside), kTone, monitor.stage("tone", 0.2, 0.3));
  constexpr double kSlow = 9.0;  // px; grain and small cloud shapes are quicker than this
  const Mask covered = add(plate.hole, habitat.outside);
  const ColorImage own_slow = masked_blur(photo, weight_of(covered, false), kSlow);
  ColorImage quick(photo.size());
  for (std::size_t i = 0; i < quick.pixels().size(); ++i) {
    if (!covered.pixels()[i]) quick.pixels()[i] = photo.pixels()[i] - own_slow.pixels()[i];
  }
  const ScalarImage beside = distance_to(plate.hole);
  Mask inner = plate.halo;  // where the photo's own quick tones are not to be trusted
  constexpr float kRampFrom = 12.0f, kRampTo = 50.0f;
  for (std::size_t i = 0; i < inner.pixels().size(); ++i) {
    if (beside.pixels()[i] > kRampTo) inner.pixels()[i] = 0;
  }
  const Completion grain = complete_grain(quick, around, inner, add(never_copied(habitat), plate.halo), rng,
                                          monitor.stage("grain", 0.3, 0.9));
  plate.color = photo;
  plate.source = grain.source;
  const ScalarImage depth = distance_to(invert(plate.halo));
  for (std::size_t i = 0; i < inner.pixels().size(); ++i) {
    if (!plate.halo.pixels()[i]) continue;
    const float own = std::clamp((beside.pixels()[i] - kRampFrom) / (kRampTo - kRampFrom), 0.0f, 1.0f);
    const float foreign = std::sqrt(1.0f - own * own);  // independent grains add by their squares
    const Rgb dark = around.pixels()[i] + own * quick.pixels()[i] + foreign * grain.color.pixels()[i];
    // The two tones meet over the halo's outer pixels, but never inside the thin hole.
    const float share = plate.hole.pixels()[i] ? 1.0f : std::min(1.0f, depth.pixels()[i] / std::min(40.0f, 40.0f * own + 1.0f));
    plate.color.pixels()[i] = share * dark + (1.0f - share) * photo.pixels()[i];
    if (own > 0.5f) plate.source.pixels()[i] = {static_cast<float>(i % photo.width()), static_cast<float>(i / photo.width())};
  }
  fill_kept(plate, exemplar, habitat, rng.child("kept"), monitor.stage("kept", 0.9, 1.0));
  return plate;
}

}  // namespace

Plate make_plate(const Exemplar& exemplar, const Habitat& habitat, PlateKind kind, Rng rng, const Monitor& monitor) {
  return kind == PlateKind::Thin ? thin_plate(exemplar, habitat, rng, monitor) : halo_plate(exemplar, habitat, rng, monitor);
}

}  // namespace ramify
