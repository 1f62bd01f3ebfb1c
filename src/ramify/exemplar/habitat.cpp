// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/exemplar/habitat.h"

#include <algorithm>
#include <cmath>

#include "ramify/core/parallel.h"
#include "ramify/exemplar/apron.h"
#include "ramify/exemplar/branch_zone.h"
#include "ramify/exemplar/k_means.h"
#include "ramify/image/color.h"
#include "ramify/image/filter.h"
#include "ramify/image/morphology.h"
#include "ramify/image/sample.h"

namespace ramify {
namespace {

constexpr int kMapSide = 256;  // px, longer side of the reduced photo that kinds of ground are told apart on

Mask add(Mask a, const Mask& b) {
  for (std::size_t i = 0; i < a.pixels().size(); ++i) a.pixels()[i] |= b.pixels()[i];
  return a;
}

// Low-pass Lab and local contrast of a reduced photo.
std::vector<Feature> ground_features(const ColorImage& small) {
  const ColorImage lab = lab_from_srgb(small);
  const ColorImage slow = gaussian_blur(lab, 1.5);
  ScalarImage swing(small.size());
  for (std::size_t i = 0; i < swing.pixels().size(); ++i) {
    swing.pixels()[i] = std::abs(lab.pixels()[i].r - slow.pixels()[i].r);
  }
  swing = gaussian_blur(swing, 2.5);
  std::vector<Feature> features(small.pixels().size());
  for (std::size_t i = 0; i < features.size(); ++i) {
    const Rgb& c = slow.pixels()[i];
    features[i] = {c.r, c.g, c.b, 2.0f * swing.pixels()[i]};
  }
  return features;
}

// Length of skeleton in every pixel of the reduced photo.
ScalarImage skeleton_length(const Skeleton& skeleton, Size small, double scale) {
  ScalarImage length(small, 0.0f);
  for (const Node& node : skeleton.nodes()) {
    if (node.parent == kNone) continue;
    const Vec2 a = skeleton[node.parent].xy() * scale, b = node.xy() * scale;
    const int steps = std::max(1, static_cast<int>(std::ceil((b - a).norm() * 2.0)));
    for (int s = 0; s < steps; ++s) {
      const Vec2 p = a + (s + 0.5) / steps * (b - a);
      const int x = static_cast<int>(std::lround(p.x())), y = static_cast<int>(std::lround(p.y()));
      if (length.contains(x, y)) length(x, y) += static_cast<float>((b - a).norm() / steps);
    }
  }
  return length;
}

// Does the region end at an edge? Gradual changes (a sky darkening downwards) are no border: the mean colour step across
// it must reach half of what separates the two sides at large.
bool has_hard_border(const std::vector<Feature>& features, const Mask& region) {
  const int w = region.width(), h = region.height();
  const ScalarImage to_outer = distance_to(invert(region)), to_inner = distance_to(region);
  Feature in{}, out{};
  double near_in = 0.0, near_out = 0.0, step = 0.0, steps = 0.0;
  constexpr int kReach = 6;  // px of the reduced photo, wider than the blur of an edge
  for (int y = 0; y < h; ++y) {
    for (int x = 0; x < w; ++x) {
      const Feature& f = features[static_cast<std::size_t>(y) * w + x];
      const bool inside = region(x, y) != 0;
      const float d = inside ? to_outer(x, y) : to_inner(x, y);
      if (d >= 8.0f && d <= 20.0f) {
        Feature& side = inside ? in : out;
        for (int k = 0; k < 3; ++k) side[k] += f[k];
        (inside ? near_in : near_out) += 1.0;
      }
      for (const auto& [dx, dy] : {std::pair{kReach, 0}, {0, kReach}}) {
        if (x + dx >= w || y + dy >= h || (region(x + dx, y + dy) != 0) == inside) continue;
        const Feature& g = features[static_cast<std::size_t>(y + dy) * w + x + dx];
        Feature a = f, b = g;
        a[3] = b[3] = 0.0f;
        step += std::sqrt(distance2(a, b));
        steps += 1.0;
      }
    }
  }
  if (near_in == 0.0 || near_out == 0.0 || steps == 0.0) return false;
  for (int k = 0; k < 3; ++k) in[k] /= static_cast<float>(near_in), out[k] /= static_cast<float>(near_out);
  const double apart = std::sqrt(distance2(in, out));
  constexpr double kApart = 10.0;  // Lab; nearer grounds are one ground
  return apart > kApart && step / steps > 0.5 * apart;
}

// Redraws the border of a reduced mask on the full photo: pixels near it go to the side whose local colour they share.
Mask refine_border(const ColorImage& photo, const ColorImage& small_photo, const Mask& small) {
  const Size size = photo.size();
  const double scale = static_cast<double>(size.width) / small.width();
  constexpr double kBand = 2.0;  // px of the reduced photo
  const ScalarImage to_in = distance_to(small), to_out = distance_to(invert(small));
  ScalarImage sure_in(small.size(), 0.0f), sure_out(small.size(), 0.0f), doubt(small.size(), 0.0f);
  for (std::size_t i = 0; i < small.pixels().size(); ++i) {
    sure_in.pixels()[i] = to_out.pixels()[i] > kBand ? 1.0f : 0.0f;
    sure_out.pixels()[i] = to_in.pixels()[i] > kBand ? 1.0f : 0.0f;
    doubt.pixels()[i] = 1.0f - sure_in.pixels()[i] - sure_out.pixels()[i];
  }
  const ColorImage small_lab = lab_from_srgb(small_photo);
  const ColorImage in = resize(masked_blur(small_lab, sure_in, 2.0 * kBand), size);
  const ColorImage out = resize(masked_blur(small_lab, sure_out, 2.0 * kBand), size);
  const ScalarImage unsure = resize(doubt, size);
  const ColorImage calm = gaussian_blur(photo, 0.7);
  Mask mask = resize_nearest(small, size);
  for (std::size_t i = 0; i < mask.pixels().size(); ++i) {
    if (unsure.pixels()[i] <= 0.0f) continue;
    const Rgb c = lab_from_srgb(calm.pixels()[i]);
    mask.pixels()[i] = delta_e(c, in.pixels()[i]) < delta_e(c, out.pixels()[i]) ? 255 : 0;
  }
  const int speck = static_cast<int>(16.0 * scale * scale);
  return fill_small_holes(drop_small_components(mask, speck), speck);
}

double median_of(std::vector<float> values) {
  if (values.empty()) return 0.0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// Median and a robust standard deviation of a field where the mask is 0 (every seventh pixel).
std::pair<double, double> robust_spread(const ScalarImage& field, const Mask& without) {
  std::vector<float> values;
  for (std::size_t i = 0; i < field.pixels().size(); i += 7) {
    if (!without.pixels()[i]) values.push_back(field.pixels()[i]);
  }
  const double middle = median_of(values);
  for (float& v : values) v = static_cast<float>(std::abs(v - middle));
  return {middle, 1.4826 * median_of(std::move(values))};
}

// Components of `weak` that hold a pixel of `strong` and satisfy `keep(pixels, width, height)`.
template <class Keep>
Mask hysteresis(const Mask& weak, const Mask& strong, Keep keep) {
  int count = 0;
  const LabelImage label = label_components(weak, true, count);
  struct Extent { int x0 = 1 << 30, y0 = 1 << 30, x1 = -1, y1 = -1, pixels = 0; bool strong = false; };
  std::vector<Extent> extent(static_cast<std::size_t>(count));
  for (int y = 0; y < weak.height(); ++y) {
    for (int x = 0; x < weak.width(); ++x) {
      if (label(x, y) == kNone) continue;
      Extent& e = extent[label(x, y)];
      e.x0 = std::min(e.x0, x), e.x1 = std::max(e.x1, x), e.y0 = std::min(e.y0, y), e.y1 = std::max(e.y1, y);
      ++e.pixels;
      e.strong = e.strong || strong(x, y);
    }
  }
  Mask out(weak.size(), 0);
  for (std::size_t i = 0; i < out.pixels().size(); ++i) {
    const int l = label.pixels()[i];
    if (l == kNone) continue;
    const Extent& e = extent[l];
    if (e.strong && keep(e.pixels, e.x1 - e.x0 + 1, e.y1 - e.y0 + 1)) out.pixels()[i] = 255;
  }
  return out;
}

// Blobs that stand out from their surround wherever `banned` is 0.
Mask find_blobs(const ColorImage& lab, const Mask& banned) {
  ScalarImage weight(lab.size());
  for (std::size_t i = 0; i < weight.pixels().size(); ++i) weight.pixels()[i] = banned.pixels()[i] ? 0.0f : 1.0f;
  const ColorImage slow = masked_blur(lab, weight, 12.0);
  ScalarImage apart(lab.size());
  parallel_for(
      lab.height(),
      [&](int y) {
        for (int x = 0; x < lab.width(); ++x) apart(x, y) = delta_e(lab(x, y), slow(x, y));
      },
      32);
  const auto [middle, spread] = robust_spread(apart, banned);
  const float strong = static_cast<float>(std::max(22.0, middle + 9.0 * spread)), weak = 0.5f * strong;
  Mask candidates = threshold(apart, weak);
  for (std::size_t i = 0; i < candidates.pixels().size(); ++i) {
    if (banned.pixels()[i]) candidates.pixels()[i] = 0;
  }
  const double largest = 0.01 * lab.width() * lab.height();
  return hysteresis(candidates, threshold(apart, strong), [&](int pixels, int w, int h) {
    const double longer = std::max(w, h), thickness = pixels / longer;
    return pixels >= 4 && pixels < largest && longer < 3.0 * thickness + 4.0;  // no ridges: elongation below 3
  });
}

// Texture is found all over the ground; the twigs of a crown before the sky are as dense, but in one place.
bool is_everywhere(const Mask& shadow, const Mask& without, double mean_share) {
  constexpr int kCell = 64;  // px
  int cells = 0, covered = 0;
  for (int y0 = 0; y0 + kCell <= shadow.height(); y0 += kCell) {
    for (int x0 = 0; x0 + kCell <= shadow.width(); x0 += kCell) {
      int ground = 0, marked = 0;
      for (int y = y0; y < y0 + kCell; ++y) {
        for (int x = x0; x < x0 + kCell; ++x) {
          if (without(x, y)) continue;
          ++ground;
          marked += shadow(x, y) != 0;
        }
      }
      if (ground < kCell * kCell / 4) continue;
      ++cells;
      covered += marked > 0.3 * mean_share * ground;
    }
  }
  return covered > 0.6 * cells;
}

}  // namespace

std::vector<OptionField> describe(HabitatOptions& o) {
  return {
      flag("habitat-auto", o.automatic, "find what lies outside the branches' habitat by colour and texture"),
      number("habitat-classes", o.classes, 2, 12, "", "kinds of ground told apart"),
      number("outside-density", o.outside_density, 0.0, 1.0, "", "share of the mean skeleton density below which a kind of ground is outside"),
      number("outside-area", o.outside_area, 0.0, 1.0, "", "share of the photo a kind of ground must cover to be outside"),
      number("texture-share", o.texture_share, 0.0, 1.0, "", "share of the ground above which ridges off the skeleton are texture"),
  };
}

Mask find_outside(const ColorImage& photo, const Skeleton& skeleton, const HabitatOptions& options, Rng rng,
                  const Monitor& monitor) {
  Mask none(photo.size(), 0);
  const double scale = std::min(1.0, static_cast<double>(kMapSide) / std::max(photo.width(), photo.height()));
  const Size small_size{std::max(1, static_cast<int>(photo.width() * scale)), std::max(1, static_cast<int>(photo.height() * scale))};
  const ColorImage small = resize(photo, small_size);
  const std::vector<Feature> features = ground_features(small);
  const Clusters clusters = k_means(features, options.classes, rng.child("habitat"));
  monitor.report(0.5);
  const ScalarImage length = skeleton_length(skeleton, small_size, scale);
  std::vector<double> lived(clusters.centres.size(), 0.0), area(clusters.centres.size(), 0.0);
  for (std::size_t i = 0; i < features.size(); ++i) {
    lived[clusters.label[i]] += length.pixels()[i];
    area[clusters.label[i]] += 1.0;
  }
  double all = 0.0;
  for (const double l : lived) all += l;
  if (all <= 0.0) return none;
  const double mean = all / static_cast<double>(features.size());
  Mask empty(small_size, 0);
  for (std::size_t i = 0; i < features.size(); ++i) {
    const int k = clusters.label[i];
    if (lived[k] < options.outside_density * mean * area[k]) empty.pixels()[i] = 255;
  }
  // Regions, not classes: a class may hold the surround and a dark spot of the ground.
  int count = 0;
  const LabelImage parts = label_components(fill_small_holes(empty, 30), true, count);
  Mask outside(small_size, 0);
  double covered = 0.0;
  for (int part = 0; part < count; ++part) {
    Mask region(small_size, 0);
    double pixels = 0.0;
    for (std::size_t i = 0; i < features.size(); ++i) {
      if (parts.pixels()[i] == part) region.pixels()[i] = 255, pixels += 1.0;
    }
    if (pixels < 0.1 * options.outside_area * static_cast<double>(features.size())) continue;
    if (!has_hard_border(features, region)) continue;
    covered += pixels;
    outside = add(outside, region);
  }
  if (covered < options.outside_area * static_cast<double>(features.size())) return none;
  monitor.report(0.8);
  return refine_border(photo, small, outside);
}

Mask find_outliers(const ColorImage& photo, const Mask& branches, const Mask& beside, const Mask& outside) {
  const ColorImage lab = lab_from_srgb(gaussian_blur(photo, 1.2));
  constexpr double kBank = 4.0;  // px of a branch's rim that are no ground to compare with
  const Mask water = dilate(erode(branches, 2.0 * kBank), kBank);
  const Mask on_ground = find_blobs(lab, add(beside, outside)), on_water = find_blobs(lab, add(invert(water), outside));
  return dilate(add(on_ground, on_water), 3.0);
}

Mask find_shadow(const ColorImage& photo, Polarity polarity, const Mask& branches, const Mask& outside) {
  constexpr int kRadius = 7;  // px; ridges up to 15 px wide (PICTURES 12.3-2)
  const ScalarImage smooth = gaussian_blur(luma(photo), 1.2);
  const ScalarImage ridge = top_hat(smooth, kRadius, polarity != Polarity::Dark);
  const Mask near = dilate(branches, 4.0);
  const Mask off = add(near, outside);
  const auto [middle, spread] = robust_spread(ridge, off);
  // Floors found by eye on a dark sky; above them the photo's own noise decides (a fixed share of the branches' contrast
  // marked half of plain asphalt, PICTURES 12.1-7).
  const float weak = static_cast<float>(middle + std::max(3.0 / 255.0, 2.5 * spread));
  const float strong = static_cast<float>(middle + std::max(7.0 / 255.0, 5.0 * spread));
  Mask candidates = threshold(ridge, weak);
  for (std::size_t i = 0; i < candidates.pixels().size(); ++i) {
    if (off.pixels()[i]) candidates.pixels()[i] = 0;
  }
  const Mask lines = hysteresis(candidates, threshold(ridge, strong), [](int pixels, int w, int h) {
    const double extent = std::hypot(w, h);
    return extent > 10.0 && pixels < 0.35 * extent * extent;  // longer than wide
  });
  return lines;
}

double embedded_share(const Mask& lines, const Mask& own, const Mask& branches) {
  constexpr double kLine = 3.0;    // px; half the width up to which own colours are lines themselves
  constexpr double kAround = 5.0;  // px
  constexpr double kTouch = 0.1;   // of what lies around a line
  ScalarImage things(own.size(), 0.0f);
  const Mask wide = dilate(erode(own, kLine), kLine);
  for (std::size_t i = 0; i < wide.pixels().size(); ++i) {
    if (wide.pixels()[i] && !branches.pixels()[i]) things.pixels()[i] = 1.0f;
  }
  things = gaussian_blur(things, kAround);
  int count = 0;
  const LabelImage part = label_components(lines, true, count);
  std::vector<double> pixels(static_cast<std::size_t>(count), 0.0), theirs(static_cast<std::size_t>(count), 0.0);
  for (std::size_t i = 0; i < lines.pixels().size(); ++i) {
    if (!lines.pixels()[i]) continue;
    pixels[part.pixels()[i]] += 1.0;
    theirs[part.pixels()[i]] += things.pixels()[i];
  }
  double all = 0.0, embedded = 0.0;
  for (std::size_t k = 0; k < pixels.size(); ++k) {
    all += pixels[k];
    if (theirs[k] > kTouch * pixels[k]) embedded += pixels[k];
  }
  return all > 0.0 ? embedded / all : 0.0;
}

Habitat find_habitat(const Exemplar& exemplar, const HabitatOptions& options, Rng rng, const Monitor& monitor) {
  const ColorImage& photo = exemplar.photo.color;
  Habitat habitat;
  habitat.role = exemplar.regions;
  if (habitat.role.empty()) habitat.role = Image<std::uint8_t>(photo.size(), static_cast<std::uint8_t>(RegionRole::Habitat));
  const auto is = [&](std::size_t i, RegionRole role) { return habitat.role.pixels()[i] == static_cast<std::uint8_t>(role); };
  habitat.outside = Mask(photo.size(), 0);
  const Mask found = options.automatic ? find_outside(photo, exemplar.skeleton, options, rng, monitor.stage("outside", 0.0, 0.4))
                                       : Mask(photo.size(), 0);
  Mask ignored(photo.size(), 0);
  const bool says_outside = std::any_of(exemplar.annotation.regions.begin(), exemplar.annotation.regions.end(),
                                        [](const Region& r) { return r.role == RegionRole::Outside; });
  for (std::size_t i = 0; i < found.pixels().size(); ++i) {
    // Who draws an outside region has said where the habitat ends.
    if (found.pixels()[i] && is(i, RegionRole::Habitat) && !says_outside) {
      habitat.role.pixels()[i] = static_cast<std::uint8_t>(RegionRole::Outside);
    }
    if (is(i, RegionRole::Outside) || is(i, RegionRole::Keep)) habitat.outside.pixels()[i] = 255;
    if (is(i, RegionRole::Ignore) || is(i, RegionRole::Landmark)) ignored.pixels()[i] = 255;
  }
  const Mask branches = branch_zone(exemplar.skeleton, photo.size(), [](double r) { return 1.3 * r + 2.0; });
  const Mask inside = branch_zone(exemplar.skeleton, photo.size(), [](double r) { return r; });
  // The glow and the banks beside a branch are no blobs.
  const Mask beside = branch_zone(exemplar.skeleton, photo.size(), [](double r) { return 2.5 * r + 8.0; });
  habitat.outliers = add(find_outliers(photo, inside, beside, habitat.outside), ignored);
  monitor.report(0.7);
  Apron apron = measure_apron(exemplar, habitat.outside);
  Mask shadow = find_shadow(photo, exemplar.polarity, branches, habitat.outside);
  // Measured: ridges 0.5, a bare tree 0.3, all others about 0. Kept or lifted all together; part of them leaves ruins.
  constexpr double kEmbedded = 0.4;
  if (embedded_share(shadow, apron.own, branches) > kEmbedded) shadow = Mask(shadow.size(), 0);
  habitat.own = std::move(apron.own);
  habitat.apron = apron.reach;
  double ground = 0.0, marked = 0.0;
  for (std::size_t i = 0; i < shadow.pixels().size(); ++i) {
    if (branches.pixels()[i] || habitat.outside.pixels()[i]) continue;
    ground += 1.0;
    marked += shadow.pixels()[i] != 0;
  }
  habitat.shadow = shadow;
  habitat.shadow_share = ground > 0.0 ? marked / ground : 0.0;
  habitat.shadow_is_texture = habitat.shadow_share > options.texture_share && is_everywhere(shadow, add(branches, habitat.outside), habitat.shadow_share);
  const int percent = static_cast<int>(std::lround(100.0 * habitat.shadow_share));
  if (percent > 0) {
    monitor.note("branch-like lines nobody annotated cover " + std::to_string(percent) + " % of the background" +
                 (habitat.shadow_is_texture ? ": taken for its texture" : ""));
  }
  monitor.report(1.0);
  return habitat;
}

}  // namespace ramify
