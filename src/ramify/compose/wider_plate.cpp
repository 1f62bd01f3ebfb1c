// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/compose/wider_plate.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "ramify/image/filter.h"
#include "ramify/image/sample.h"

namespace ramify {
namespace {

constexpr int kStep = 8;  // px between starts that are tried and between pixels compared

// What is being continued; always to the right, other edges are turned there first.
struct Sheet {
  ColorImage color;
  VectorImage source;
  Mask outside, landmark;
};

template <class T>
Image<T> mirrored(const Image<T>& image) {
  Image<T> out(image.size());
  for (int y = 0; y < image.height(); ++y) std::reverse_copy(image.row(y), image.row(y) + image.width(), out.row(y));
  return out;
}

template <class T>
Image<T> transposed(const Image<T>& image) {
  Image<T> out(image.height(), image.width());
  for (int y = 0; y < image.height(); ++y) {
    for (int x = 0; x < image.width(); ++x) out(y, x) = image(x, y);
  }
  return out;
}

Sheet mirrored(const Sheet& s) { return {mirrored(s.color), mirrored(s.source), mirrored(s.outside), mirrored(s.landmark)}; }
Sheet transposed(const Sheet& s) { return {transposed(s.color), transposed(s.source), transposed(s.outside), transposed(s.landmark)}; }

Sheet piece_of(const Sheet& s, int x0, int width) {
  const int h = s.color.height();
  return {crop(s.color, x0, 0, width, h), crop(s.source, x0, 0, width, h), crop(s.outside, x0, 0, width, h), crop(s.landmark, x0, 0, width, h)};
}

template <class T>
void lay(Image<T>& onto, const Image<T>& piece, int x0) {
  for (int y = 0; y < piece.height(); ++y) std::copy_n(piece.row(y), piece.width(), onto.row(y) + x0);
}

void lay(Sheet& onto, const Sheet& piece, int x0) {
  lay(onto.color, piece.color, x0), lay(onto.source, piece.source, x0), lay(onto.outside, piece.outside, x0), lay(onto.landmark, piece.landmark, x0);
}

double square(const Rgb& a) { return a.r * a.r + a.g * a.g + a.b * a.b; }

// Which columns, from `from` on, show no landmark and are laid out about like the right edge.
std::vector<bool> usable_columns(const Sheet& s, int from) {
  constexpr double kUnlike = 0.08;  // of a column's pixels
  const int w = s.color.width(), h = s.color.height();
  std::vector<bool> usable(static_cast<std::size_t>(w), false);
  for (int x = from; x < w; ++x) {
    int unlike = 0, landmark = 0;
    for (int y = 0; y < h; ++y) {
      unlike += (s.outside(x, y) != 0) != (s.outside(w - 1, y) != 0);
      landmark += s.landmark(x, y) != 0;
    }
    usable[static_cast<std::size_t>(x)] = landmark == 0 && unlike <= kUnlike * h;
  }
  return usable;
}

// The longest run [first, last) of them.
std::pair<int, int> longest_run(const std::vector<bool>& usable) {
  std::pair<int, int> best{0, 0};
  for (int x = 0, first = 0; x < static_cast<int>(usable.size()); ++x) {
    if (!usable[static_cast<std::size_t>(x)]) first = x + 1;
    else if (x + 1 - first > best.second - best.first) best = {first, x + 1};
  }
  return best;
}

// How badly the columns from `start` fit over those from `at` on. Slow tones count: quick ones are left to the cut.
double misfit(const ColorImage& tail, const Mask& tail_outside, const ColorImage& tone, const Mask& outside, int start) {
  constexpr double kShape = 0.1;  // of an outside pixel over one that is not
  double sum = 0.0;
  for (int y = 0; y < tail.height(); y += kStep) {
    for (int x = 0; x < tail.width(); x += kStep) {
      sum += square(tail(x, y) - tone(start + x, y)) + kShape * ((tail_outside(x, y) != 0) != (outside(start + x, y) != 0));
    }
  }
  return sum;
}

// One of the starts that do about as well as the best: that fit, and go on for `wanted` px, so that nothing is seen to
// repeat.
std::optional<int> draw_start(const Sheet& tail, const Sheet& from, const ColorImage& tone, std::pair<int, int> usable,
                              int least, int wanted, Rng& rng) {
  constexpr double kAsWell = 1.3, kShort = 2.0;
  const ColorImage tail_tone = gaussian_blur(tail.color, kStep);
  std::vector<double> costs;
  for (int s = usable.first; s + tail.color.width() + least <= usable.second; s += kStep) {
    const double missing = std::max(0.0, 1.0 - static_cast<double>(usable.second - s - tail.color.width()) / wanted);
    costs.push_back((1.0 + kShort * missing) * misfit(tail_tone, tail.outside, tone, from.outside, s));
  }
  if (costs.empty()) return std::nullopt;
  const double most = kAsWell * *std::min_element(costs.begin(), costs.end());
  std::vector<int> good;
  for (std::size_t i = 0; i < costs.size(); ++i) {
    if (costs[i] <= most) good.push_back(usable.first + kStep * static_cast<int>(i));
  }
  return good[static_cast<std::size_t>(rng.below(static_cast<int>(good.size())))];
}

// For every row the first column that shows b: the cheapest connected cut, within the middle half.
std::vector<int> cut_between(const Sheet& a, const Sheet& b) {
  constexpr double kShape = 1.0;
  const int w = a.color.width(), h = a.color.height(), first = w / 4, count = std::max(1, w / 2);
  Image<double> cost(count, h);
  for (int y = 0; y < h; ++y) {
    for (int k = 0; k < count; ++k) {
      const int x = first + k;
      double c = square(a.color(x, y) - b.color(x, y)) + kShape * ((a.outside(x, y) != 0) != (b.outside(x, y) != 0));
      if (y > 0) c += std::min({cost(k, y - 1), cost.clamped(k - 1, y - 1), cost.clamped(k + 1, y - 1)});
      cost(k, y) = c;
    }
  }
  std::vector<int> cut(static_cast<std::size_t>(h));
  int k = static_cast<int>(std::min_element(cost.row(h - 1), cost.row(h - 1) + count) - cost.row(h - 1));
  for (int y = h - 1; y >= 0; --y) {
    cut[static_cast<std::size_t>(y)] = first + k;
    if (y == 0) break;
    const int last = k;
    for (const int to : {last - 1, last + 1}) {
      if (to >= 0 && to < count && cost(to, y - 1) < cost(k, y - 1)) k = to;
    }
  }
  return cut;
}

// Bands of a and b, each parted at the cut as softly as the band is slow.
ColorImage blend_bands(ColorImage a, ColorImage b, const std::vector<int>& cut) {
  ScalarImage side(a.size());
  for (int y = 0; y < a.height(); ++y) {
    for (int x = 0; x < a.width(); ++x) side(x, y) = x >= cut[static_cast<std::size_t>(y)] ? 1.0f : 0.0f;
  }
  ColorImage out(a.size());
  const double slowest = a.width() / 10.0;  // the cut is 2.5 of these from where a and b end
  for (double sigma = 1.0;; sigma = std::min(3.0 * sigma, slowest)) {
    const bool last = sigma >= slowest;
    const ColorImage calm_a = last ? ColorImage(a.size()) : gaussian_blur(a, sigma);
    const ColorImage calm_b = last ? ColorImage(b.size()) : gaussian_blur(b, sigma);
    const ScalarImage soft = gaussian_blur(side, std::min(sigma, slowest));
    for (std::size_t i = 0; i < out.pixels().size(); ++i) {
      const float t = std::clamp((soft.pixels()[i] - 0.01f) / 0.98f, 0.0f, 1.0f);
      out.pixels()[i] = out.pixels()[i] + (1.0f - t) * (a.pixels()[i] - calm_a.pixels()[i]) + t * (b.pixels()[i] - calm_b.pixels()[i]);
    }
    if (last) return out;
    a = calm_a, b = calm_b;
  }
}

Sheet join(const Sheet& a, Sheet b) {
  const std::vector<int> cut = cut_between(a, b);
  b.color = blend_bands(a.color, b.color, cut);
  for (int y = 0; y < b.color.height(); ++y) {
    for (int x = 0; x < cut[static_cast<std::size_t>(y)]; ++x) {
      b.source(x, y) = a.source(x, y), b.outside(x, y) = a.outside(x, y), b.landmark(x, y) = a.landmark(x, y);
    }
  }
  return b;
}

// Columns from `end` on reflect the `margin` columns before it, back and forth.
void reflect(Sheet& wide, int end, int margin) {
  margin = std::clamp(margin, 1, end);
  for (int x = end; x < wide.color.width(); ++x) {
    const int k = (x - end) % (2 * margin);
    lay(wide, piece_of(wide, end - 1 - (k < margin ? k : 2 * margin - 1 - k), 1), x);
  }
}

// The last `own` columns are the photo's, and pieces come from there.
Sheet continued_right(const Sheet& sheet, int own, int add, int margin, Rng rng) {
  const int w = sheet.color.width(), h = sheet.color.height();
  if (add <= 0) return sheet;
  Sheet wide{ColorImage(w + add, h), VectorImage(w + add, h), Mask(w + add, h), Mask(w + add, h)};
  lay(wide, sheet, 0);
  const std::vector<bool> columns = usable_columns(sheet, w - own);
  const std::pair<int, int> usable = longest_run(columns);
  const int tail_length = static_cast<int>(std::find(columns.rbegin(), columns.rend(), false) - columns.rbegin());
  const int overlap = std::min(own / 6, tail_length);
  int end = w;
  if (margin >= own && overlap > std::max(kStep, own / 16)) {
    const ColorImage tone = gaussian_blur(sheet.color, kStep);
    while (end < w + add) {
      const Sheet tail = piece_of(wide, end - overlap, overlap);
      const std::optional<int> start =
          draw_start(tail, sheet, tone, usable, std::min(add, own / 6), std::min(add, own / 2), rng);
      if (!start) break;  // the first time, or never
      const int more = std::min(usable.second - *start - overlap, w + add - end);
      lay(wide, join(tail, piece_of(sheet, *start, overlap)), end - overlap);
      lay(wide, piece_of(sheet, *start + overlap, more), end);
      end += more;
    }
  }
  if (end == w) reflect(wide, end, tail_length > kStep ? std::min(margin, tail_length) : std::min(margin, own));
  return wide;
}

}  // namespace

WiderPlate widen_plate(const ColorImage& plate, const WiderPlateJob& job, Rng rng) {
  Sheet sheet{plate, VectorImage(plate.size()), job.outside, job.landmark};
  for (int y = 0; y < plate.height(); ++y) {
    for (int x = 0; x < plate.width(); ++x) sheet.source(x, y) = Eigen::Vector2f(static_cast<float>(x), static_cast<float>(y));
  }
  const auto right = [&](const Sheet& s, int edge) {
    const int own = edge % 2 == 0 ? plate.width() : plate.height();
    return continued_right(s, own, job.add[edge], job.margins[edge], rng.child("edge", static_cast<std::uint64_t>(edge)));
  };
  sheet = right(mirrored(right(sheet, 2)), 0);  // mirrored now
  sheet = transposed(mirrored(sheet));
  sheet = right(mirrored(right(sheet, 3)), 1);
  sheet = transposed(mirrored(sheet));
  return {std::max(0, job.add[0]), std::max(0, job.add[1]), std::move(sheet.color), std::move(sheet.source)};
}

}  // namespace ramify
