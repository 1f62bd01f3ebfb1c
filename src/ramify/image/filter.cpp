// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/image/filter.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "ramify/core/parallel.h"
#include "ramify/image/sample.h"

namespace ramify {
namespace {

int mirrored(int i, int n) {
  if (n == 1) return 0;
  const int period = 2 * (n - 1);
  i = ((i % period) + period) % period;
  return i < n ? i : period - i;
}

std::vector<float> gaussian_kernel(double sigma) {
  const int reach = std::max(1, static_cast<int>(std::ceil(4.0 * sigma)));
  std::vector<float> kernel(2 * reach + 1);
  double sum = 0.0;
  for (int i = -reach; i <= reach; ++i) sum += std::exp(-0.5 * i * i / (sigma * sigma));
  for (int i = -reach; i <= reach; ++i) {
    kernel[i + reach] = static_cast<float>(std::exp(-0.5 * i * i / (sigma * sigma)) / sum);
  }
  return kernel;
}

inline const float* values(const float* pixel) { return pixel; }
inline const float* values(const Rgb* pixel) { return &pixel->r; }
inline float* values(float* pixel) { return pixel; }
inline float* values(Rgb* pixel) { return &pixel->r; }

// out[i] = sum over k of kernel[k] * from(k)[i], for i = 0 … count - 1, summed in the order of k.
template <class From>
void weighted_sum(const std::vector<float>& kernel, const From& from, int count, float* out) {
  constexpr int kBlock = 16;  // sums that are kept in registers
  const int taps = static_cast<int>(kernel.size());
  int i = 0;
  for (; i + kBlock <= count; i += kBlock) {
    float sum[kBlock] = {};
    for (int k = 0; k < taps; ++k) {
      const float weight = kernel[k];
      const float* row = from(k) + i;
      for (int j = 0; j < kBlock; ++j) sum[j] += weight * row[j];
    }
    std::copy(sum, sum + kBlock, out + i);
  }
  for (; i < count; ++i) {
    float sum = 0.0f;
    for (int k = 0; k < taps; ++k) sum += kernel[k] * from(k)[i];
    out[i] = sum;
  }
}

template <class T>
Image<T> blur_direct(const Image<T>& image, double sigma) {
  constexpr int kChannels = sizeof(T) / sizeof(float);
  const std::vector<float> kernel = gaussian_kernel(sigma);
  const int reach = static_cast<int>(kernel.size()) / 2;
  const int w = image.width(), h = image.height();
  Image<T> across(image.size()), out(image.size());
  parallel_for(h, [&](int y) {
    std::vector<T> line(w + 2 * reach);
    std::copy(image.row(y), image.row(y) + w, line.begin() + reach);
    for (int x = 0; x < reach; ++x) {
      line[x] = image(mirrored(x - reach, w), y);
      line[w + reach + x] = image(mirrored(w + x, w), y);
    }
    weighted_sum(kernel, [&](int k) { return values(line.data()) + kChannels * k; }, kChannels * w, values(across.row(y)));
  }, 16);
  parallel_for(h, [&](int y) {
    std::vector<const float*> rows(kernel.size());
    for (int k = -reach; k <= reach; ++k) rows[k + reach] = values(across.row(mirrored(y + k, h)));
    weighted_sum(kernel, [&](int k) { return rows[k]; }, kChannels * w, values(out.row(y)));
  }, 16);
  return out;
}

// Bilinear upsampling keeps a wide blur smooth: its bends are far longer than a reduced pixel.
template <class T>
Image<T> enlarge(const Image<T>& small, Size size) {
  struct Place {
    int low, high;
    float share;
  };
  const auto places = [](int from, int to) {
    const double scale = static_cast<double>(from) / to;
    std::vector<Place> out(static_cast<std::size_t>(to));
    for (int i = 0; i < to; ++i) {
      const double p = (i + 0.5) * scale - 0.5, whole = std::floor(p);
      const int low = static_cast<int>(whole);
      out[i] = {std::clamp(low, 0, from - 1), std::clamp(low + 1, 0, from - 1), static_cast<float>(p - whole)};
    }
    return out;
  };
  const std::vector<Place> columns = places(small.width(), size.width), rows = places(small.height(), size.height);
  Image<T> out(size);
  parallel_for(size.height, [&](int y) {
    const T *above = small.row(rows[y].low), *below = small.row(rows[y].high);
    const float ty = rows[y].share;
    T* to = out.row(y);
    for (int x = 0; x < size.width; ++x) {
      const auto& [low, high, tx] = columns[x];
      const T upper = (1.0f - tx) * above[low] + tx * above[high], lower = (1.0f - tx) * below[low] + tx * below[high];
      to[x] = (1.0f - ty) * upper + ty * lower;
    }
  }, 16);
  return out;
}

template <class T>
Image<T> blur(const Image<T>& image, double sigma) {
  if (!(sigma > 0.0) || image.empty()) return image;
  const int shorter = std::min(image.width(), image.height());
  const int factor = std::min(static_cast<int>(sigma / 6.0), shorter / 4);
  if (factor < 2) return blur_direct(image, sigma);
  const Size reduced{(image.width() + factor - 1) / factor, (image.height() + factor - 1) / factor};
  const double scale = static_cast<double>(reduced.width) / image.width();
  // The reduction itself is a box of one reduced pixel and the enlargement a tent: variance 1/12 + 1/6 of its square.
  const double own = std::sqrt(std::max(0.25, sigma * sigma * scale * scale - 0.25));
  return enlarge(blur_direct(resize(image, reduced), own), image.size());
}

float times(float a, float w) { return a * w; }
Rgb times(const Rgb& a, float w) { return w * a; }

template <class T>
Image<T> weighted_blur(const Image<T>& image, const ScalarImage& weight, double sigma) {
  Image<T> weighted(image.size());
  parallel_for(image.height(), [&](int y) {
    for (int x = 0; x < image.width(); ++x) weighted(x, y) = times(image(x, y), weight(x, y));
  }, 32);
  Image<T> sum = blur(weighted, sigma);
  const ScalarImage total = blur(weight, sigma);
  constexpr float kNothing = 1e-6f;
  const auto& totals = total.pixels();
  Image<T> plain;
  if (std::any_of(totals.begin(), totals.end(), [](float w) { return !(w > kNothing); })) plain = blur(image, sigma);
  parallel_for(image.height(), [&](int y) {
    for (int x = 0; x < image.width(); ++x) {
      const float w = total(x, y);
      sum(x, y) = w > kNothing ? times(sum(x, y), 1.0f / w) : plain(x, y);
    }
  }, 32);
  return sum;
}

// Lower envelope of parabolas: squared distances along one line (Felzenszwalb and Huttenlocher 2012, section 2.1).
constexpr double kFar = 1e15;
void squared_distances(std::vector<double>& f, std::vector<double>& out, std::vector<int>& v, std::vector<double>& z) {
  const int n = static_cast<int>(f.size());
  int k = 0;
  v[0] = 0;
  z[0] = -1e30;
  z[1] = 1e30;
  for (int q = 1; q < n; ++q) {
    const auto meet = [&](int p) {
      return ((f[q] + static_cast<double>(q) * q) - (f[p] + static_cast<double>(p) * p)) / (2.0 * (q - p));
    };
    double s = meet(v[k]);
    while (s <= z[k]) s = meet(v[--k]);
    v[++k] = q;
    z[k] = s;
    z[k + 1] = 1e30;
  }
  k = 0;
  for (int q = 0; q < n; ++q) {
    while (z[k + 1] < q) ++k;
    out[q] = static_cast<double>(q - v[k]) * (q - v[k]) + f[v[k]];
  }
}

}  // namespace

ScalarImage gaussian_blur(const ScalarImage& image, double sigma) { return blur(image, sigma); }
ColorImage gaussian_blur(const ColorImage& image, double sigma) { return blur(image, sigma); }
ColorImage masked_blur(const ColorImage& image, const ScalarImage& weight, double sigma) {
  return weighted_blur(image, weight, sigma);
}
ScalarImage masked_blur(const ScalarImage& image, const ScalarImage& weight, double sigma) {
  return weighted_blur(image, weight, sigma);
}

Gradient gradient(const ScalarImage& image) {
  Gradient out{ScalarImage(image.size()), ScalarImage(image.size())};
  const int w = image.width(), h = image.height();
  for (int y = 0; y < h; ++y) {
    for (int x = 0; x < w; ++x) {
      const int x0 = std::max(0, x - 1), x1 = std::min(w - 1, x + 1), y0 = std::max(0, y - 1), y1 = std::min(h - 1, y + 1);
      out.dx(x, y) = x1 > x0 ? (image(x1, y) - image(x0, y)) / static_cast<float>(x1 - x0) : 0.0f;
      out.dy(x, y) = y1 > y0 ? (image(x, y1) - image(x, y0)) / static_cast<float>(y1 - y0) : 0.0f;
    }
  }
  return out;
}

ScalarImage distance_to(const Mask& mask) {
  const int w = mask.width(), h = mask.height();
  // Along columns, row by row: px to the nearest pixel above or below; h where there is none.
  constexpr int kStrip = 256;  // columns
  Image<std::int32_t> steps(mask.size());
  parallel_for((w + kStrip - 1) / kStrip, [&](int strip) {
    const int x0 = strip * kStrip, x1 = std::min(w, x0 + kStrip);
    for (int y = 0; y < h; ++y) {
      const std::uint8_t* on = mask.row(y);
      std::int32_t* to = steps.row(y);
      const std::int32_t* above = y > 0 ? steps.row(y - 1) : nullptr;
      for (int x = x0; x < x1; ++x) to[x] = on[x] ? 0 : above ? std::min(above[x] + 1, h) : h;
    }
    for (int y = h - 2; y >= 0; --y) {
      std::int32_t* to = steps.row(y);
      const std::int32_t* below = steps.row(y + 1);
      for (int x = x0; x < x1; ++x) to[x] = std::min(to[x], below[x] + 1);
    }
  });
  ScalarImage out(mask.size());
  parallel_for(h, [&](int y) {
    std::vector<double> f(w), d(w), z(w + 1);
    std::vector<int> v(w);
    const std::int32_t* from = steps.row(y);
    for (int x = 0; x < w; ++x) f[x] = from[x] < h ? static_cast<double>(from[x]) * from[x] : kFar;
    squared_distances(f, d, v, z);
    for (int x = 0; x < w; ++x) {
      out(x, y) = d[x] >= 0.5 * kFar ? std::numeric_limits<float>::infinity() : static_cast<float>(std::sqrt(d[x]));
    }
  }, 32);
  return out;
}

Mask dilate(const Mask& mask, double radius) {
  const ScalarImage d = distance_to(mask);
  Mask out(mask.size());
  for (std::size_t i = 0; i < out.pixels().size(); ++i) out.pixels()[i] = d.pixels()[i] <= radius ? 255 : 0;
  return out;
}

Mask erode(const Mask& mask, double radius) { return invert(dilate(invert(mask), radius)); }

Mask invert(const Mask& mask) {
  Mask out(mask.size());
  for (std::size_t i = 0; i < out.pixels().size(); ++i) out.pixels()[i] = mask.pixels()[i] ? 0 : 255;
  return out;
}

Mask threshold(const ScalarImage& image, float above) {
  Mask out(image.size());
  for (std::size_t i = 0; i < out.pixels().size(); ++i) out.pixels()[i] = image.pixels()[i] > above ? 255 : 0;
  return out;
}

double mean_of(const Mask& mask) {
  const auto zeros = std::count(mask.pixels().begin(), mask.pixels().end(), 0);
  return mask.empty() ? 0.0 : 1.0 - static_cast<double>(zeros) / static_cast<double>(mask.pixels().size());
}

LabelImage label_components(const Mask& mask, bool eight_connected, int& count) {
  LabelImage labels(mask.size(), kNone);
  count = 0;
  std::vector<Eigen::Vector2i> queue;
  for (int y0 = 0; y0 < mask.height(); ++y0) {
    for (int x0 = 0; x0 < mask.width(); ++x0) {
      if (!mask(x0, y0) || labels(x0, y0) != kNone) continue;
      labels(x0, y0) = count;
      queue.assign(1, {x0, y0});
      while (!queue.empty()) {
        const Eigen::Vector2i p = queue.back();
        queue.pop_back();
        for (int dy = -1; dy <= 1; ++dy) {
          for (int dx = -1; dx <= 1; ++dx) {
            const int x = p.x() + dx, y = p.y() + dy;
            if ((!eight_connected && dx != 0 && dy != 0) || !mask.contains(x, y)) continue;
            if (!mask(x, y) || labels(x, y) != kNone) continue;
            labels(x, y) = count;
            queue.push_back({x, y});
          }
        }
      }
      ++count;
    }
  }
  return labels;
}

Mask drop_small_components(const Mask& mask, int pixels) {
  int count = 0;
  const LabelImage labels = label_components(mask, true, count);
  std::vector<int> areas(static_cast<std::size_t>(count), 0);
  for (const int label : labels.pixels()) {
    if (label != kNone) ++areas[label];
  }
  Mask out(mask.size());
  for (std::size_t i = 0; i < out.pixels().size(); ++i) {
    const int label = labels.pixels()[i];
    out.pixels()[i] = label != kNone && areas[label] >= pixels ? 255 : 0;
  }
  return out;
}

Mask fill_small_holes(const Mask& mask, int pixels) {
  int count = 0;
  const LabelImage labels = label_components(invert(mask), false, count);
  std::vector<int> areas(static_cast<std::size_t>(count), 0);
  for (int y = 0; y < mask.height(); ++y) {
    for (int x = 0; x < mask.width(); ++x) {
      const bool rim = x == 0 || y == 0 || x == mask.width() - 1 || y == mask.height() - 1;
      // A region on the frame may go on outside: never a hole.
      if (labels(x, y) != kNone && areas[labels(x, y)] <= pixels) areas[labels(x, y)] += rim ? pixels + 1 : 1;
    }
  }
  Mask out(mask.size());
  for (std::size_t i = 0; i < out.pixels().size(); ++i) {
    const int label = labels.pixels()[i];
    out.pixels()[i] = label == kNone || areas[label] < pixels ? 255 : 0;
  }
  return out;
}

}  // namespace ramify
