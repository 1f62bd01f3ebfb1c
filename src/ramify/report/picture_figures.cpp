// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/report/picture_figures.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "ramify/image/color.h"
#include "ramify/image/filter.h"
#include "ramify/report/width_figures.h"
#include "ramify/skeleton/draw.h"
#include "ramify/skeleton/statistics.h"

namespace ramify {
namespace {

constexpr double kZone = 4.0;      // px beyond the branches' edges
constexpr int kBlock = 48;         // px, for copies in place (PICTURES 10)
constexpr double kBlockShare = 0.15;
constexpr double kCopied = 0.98;
constexpr int kLowPass = 25;       // px

Mask half_of(const Mask& mask, bool right) {
  Mask half = mask;
  for (int y = 0; y < mask.height(); ++y) {
    for (int x = 0; x < mask.width(); ++x) {
      if ((x >= mask.width() / 2) != right) half(x, y) = 0;
    }
  }
  return half;
}

Rgb mean_color(const ColorImage& lab, const Mask& where) {
  std::array<double, 3> sum{};
  double count = 0.0;
  for (std::size_t i = 0; i < where.pixels().size(); ++i) {
    if (!where.pixels()[i]) continue;
    for (int c = 0; c < 3; ++c) sum[c] += lab.pixels()[i][c];
    ++count;
  }
  count = std::max(count, 1.0);
  return {static_cast<float>(sum[0] / count), static_cast<float>(sum[1] / count), static_cast<float>(sum[2] / count)};
}

double correlation(const ColorImage& a, const ColorImage& b, int x0, int y0, bool flip_x, bool flip_y) {
  double sa = 0, sb = 0, saa = 0, sbb = 0, sab = 0;
  for (int y = y0; y < y0 + kBlock; ++y) {
    for (int x = x0; x < x0 + kBlock; ++x) {
      const double u = a(flip_x ? a.width() - 1 - x : x, flip_y ? a.height() - 1 - y : y).r, v = b(x, y).r;
      sa += u, sb += v, saa += u * u, sbb += v * v, sab += u * v;
    }
  }
  const double n = kBlock * kBlock, va = saa - sa * sa / n, vb = sbb - sb * sb / n;
  return va > 1e-9 && vb > 1e-9 ? (sab - sa * sb / n) / std::sqrt(va * vb) : 0.0;
}

// Box blur by running sums, clamped at the frame.
ColorImage box_blur(const ColorImage& image, int side) {
  const int reach = side / 2;
  ColorImage rows(image.size()), out(image.size());
  const auto blur_line = [&](int count, const auto& get, const auto& put) {
    std::array<double, 3> sum{};
    for (int k = -reach; k <= reach; ++k) {
      for (int c = 0; c < 3; ++c) sum[c] += get(std::clamp(k, 0, count - 1))[c];
    }
    for (int i = 0; i < count; ++i) {
      Rgb mean;
      for (int c = 0; c < 3; ++c) mean[c] = static_cast<float>(sum[c] / side);
      put(i, mean);
      for (int c = 0; c < 3; ++c) {
        sum[c] += get(std::min(i + reach + 1, count - 1))[c] - get(std::max(i - reach, 0))[c];
      }
    }
  };
  for (int y = 0; y < image.height(); ++y) {
    blur_line(image.width(), [&](int x) -> const Rgb& { return image(x, y); }, [&](int x, const Rgb& v) { rows(x, y) = v; });
  }
  for (int x = 0; x < image.width(); ++x) {
    blur_line(image.height(), [&](int y) -> const Rgb& { return rows(x, y); }, [&](int y, const Rgb& v) { out(x, y) = v; });
  }
  return out;
}

bool same_lines(const Skeleton& a, const Skeleton& b) {
  if (a.count() != b.count() || !(a.size == b.size)) return false;
  for (int i = 0; i < a.count(); ++i) {
    if ((a[i].xy() - b[i].xy()).norm() > 0.5 || a[i].parent != b[i].parent) return false;
  }
  return true;
}

}  // namespace

Mask branch_zone(const Skeleton& skeleton, Size canvas) {
  const ScalarImage distance = draw_signed_distance(skeleton, canvas, kZone + 1.0);
  Mask zone(canvas);
  for (std::size_t i = 0; i < zone.pixels().size(); ++i) zone.pixels()[i] = distance.pixels()[i] <= kZone ? 255 : 0;
  return zone;
}

double measure_sharpness(const ColorImage& lab, const Mask& where) {
  double sum = 0.0, count = 0.0;
  for (int y = 0; y < lab.height(); ++y) {
    for (int x = 0; x < lab.width(); ++x) {
      if (!where(x, y)) continue;
      sum += std::abs(lab.clamped(x - 1, y).r + lab.clamped(x + 1, y).r + lab.clamped(x, y - 1).r + lab.clamped(x, y + 1).r -
                      4.0f * lab(x, y).r);
      ++count;
    }
  }
  return count > 0.0 ? sum / count : std::numeric_limits<double>::quiet_NaN();
}

double measure_copied_blocks(const ColorImage& photo_lab, const ColorImage& result_lab, const Mask& result_zone) {
  int blocks = 0;
  std::array<int, 3> copied{};
  for (int y = 0; y + kBlock <= result_lab.height(); y += kBlock) {
    for (int x = 0; x + kBlock <= result_lab.width(); x += kBlock) {
      int inside = 0;
      for (int j = y; j < y + kBlock; ++j) {
        for (int i = x; i < x + kBlock; ++i) inside += result_zone(i, j) != 0;
      }
      if (inside <= kBlockShare * kBlock * kBlock) continue;
      ++blocks;
      copied[0] += correlation(photo_lab, result_lab, x, y, false, false) > kCopied;
      copied[1] += correlation(photo_lab, result_lab, x, y, true, false) > kCopied;
      copied[2] += correlation(photo_lab, result_lab, x, y, false, true) > kCopied;
    }
  }
  return static_cast<double>(*std::max_element(copied.begin(), copied.end())) / std::max(blocks, 1);
}

double measure_lowpass_difference(const ColorImage& a, const ColorImage& b, const Mask& where) {
  const ColorImage la = box_blur(lab_from_srgb(a), kLowPass), lb = box_blur(lab_from_srgb(b), kLowPass);
  std::vector<double> differences;
  for (std::size_t i = 0; i < where.pixels().size(); ++i) {
    if (where.pixels()[i]) differences.push_back(delta_e(la.pixels()[i], lb.pixels()[i]));
  }
  return quantile(std::move(differences), 0.5);
}

std::vector<Figure> compare_pictures(const PictureSubject& exemplar, const PictureSubject& result, const Provenance& provenance,
                                     Rng rng, const Monitor& monitor) {
  std::vector<Figure> figures;
  const ColorImage lab_a = lab_from_srgb(exemplar.color), lab_b = lab_from_srgb(result.color);
  const Mask zone_a = branch_zone(exemplar.skeleton, lab_a.size()), zone_b = branch_zone(result.skeleton, lab_b.size());
  monitor.report(0.2);
  const auto compare_part = [&](const std::string& key, const std::string& label, const Mask& a, const Mask& b) {
    const double sharp = measure_sharpness(lab_a, a);
    const double halves = measure_sharpness(lab_a, half_of(a, true)) / measure_sharpness(lab_a, half_of(a, false));
    Figure figure{"sharpness_" + key, "sharpness of " + label + " / the exemplar's", "", {}, measure_sharpness(lab_b, b) / sharp, halves, "", {}};
    figures.push_back(judged(figure, 0.85, 1.15, "0.85 to 1.15"));
    figures.push_back({key + "_colour_shift", "mean colour of " + label + ", shift", "dE", {},
                       delta_e(mean_color(lab_a, a), mean_color(lab_b, b)),
                       delta_e(mean_color(lab_a, half_of(a, false)), mean_color(lab_a, half_of(a, true))), "", Verdict::None});
  };
  compare_part("branch", "branches", zone_a, zone_b);
  compare_part("rest", "the rest", invert(zone_a), invert(zone_b));
  const double own = measure_repetition(exemplar.color, rng.child("repetition", 0), monitor.stage("repetition", 0.3, 0.6));
  Figure repeated{"repeated_share", "repeated patches", "", own, measure_repetition(result.color, rng.child("repetition", 1), monitor.stage("repetition", 0.6, 0.9)), {}, "", {}};
  figures.push_back(judged(repeated, 0.0, own + 0.02, "at most the exemplar's + 0.02"));
  if (lab_a.size() == lab_b.size()) {
    Figure copied{"blocks_copied_in_place", "branch blocks copied in place", "", {}, measure_copied_blocks(lab_a, lab_b, zone_b), {}, "", {}};
    figures.push_back(judged(copied, 0.0, 0.05, "at most 0.05"));
  }
  if (same_lines(exemplar.skeleton, result.skeleton)) {
    Figure rebuilt{"lowpass_difference", "low-pass colour difference at the branches, median", "dE", {},
                   measure_lowpass_difference(exemplar.color, result.color, zone_b), {}, "", {}};
    const double most = provenance.glow ? 7.0 : 4.0;  // PICTURES 10
    figures.push_back(judged(rebuilt, 0.0, most, provenance.glow ? "at most 7, as light is emitted" : "at most 4"));
  }
  const WidthRatio own_width = measure_width_ratio(exemplar.color, exemplar.skeleton, provenance.glow);
  const WidthRatio width = measure_width_ratio(result.color, result.skeleton, provenance.glow);
  if (own_width.samples > 0 && width.samples > 0) {
    Figure middle{"radius_remeasured", "radius measured again / the skeleton's, over the exemplar's own", "", own_width.middle,
                  width.middle / own_width.middle, {}, "", {}};
    figures.push_back(judged(middle, 0.9, 1.1, "0.90 to 1.10"));
    figures.push_back({"radius_scatter", "its median deviation", "", own_width.deviation, width.deviation, {}, "", Verdict::None});
  }
  if (provenance.owner) {
    Figure seams{"seam_ratio", "step across seams / beside them", "", {}, measure_seam_ratio(result.color, *provenance.owner), {}, "", {}};
    if (lab_a.size() == lab_b.size()) seams.spread = measure_seam_ratio(exemplar.color, *provenance.owner);
    figures.push_back(judged(seams, 0.9, 1.12, "0.90 to 1.12"));
  }
  if (provenance.owner && provenance.source) {
    Figure offset{"offset_peak", "fragment pixels moved by one common offset", "", {}, measure_offset_peak(*provenance.owner, *provenance.source), {}, "", {}};
    figures.push_back(judged(offset, 0.0, 0.03, "at most 0.03"));
  }
  return figures;
}

}  // namespace ramify
