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

template <class T>
Image<T> blur_direct(const Image<T>& image, double sigma) {
  const std::vector<float> kernel = gaussian_kernel(sigma);
  const int reach = static_cast<int>(kernel.size()) / 2;
  const int w = image.width(), h = image.height();
  Image<T> across(image.size()), out(image.size());
  parallel_for(h, [&](int y) {
    std::vector<T> line(w + 2 * reach);
    for (int x = 0; x < w + 2 * reach; ++x) line[x] = image(mirrored(x - reach, w), y);
    T* to = across.row(y);
    for (int x = 0; x < w; ++x) {
      T sum{};
      for (int k = 0; k < 2 * reach + 1; ++k) sum = sum + kernel[k] * line[x + k];
      to[x] = sum;
    }
  }, 16);
  parallel_for(h, [&](int y) {
    T* to = out.row(y);
    for (int k = -reach; k <= reach; ++k) {
      const T* from = across.row(mirrored(y + k, h));
      const float weight = kernel[k + reach];
      for (int x = 0; x < w; ++x) to[x] = to[x] + weight * from[x];
    }
  }, 16);
  return out;
}

// Bilinear upsampling keeps a wide blur smooth: its bends are far longer than a reduced pixel.
template <class T>
Image<T> enlarge(const Image<T>& small, Size size) {
  Image<T> out(size);
  const double sx = static_cast<double>(small.width()) / size.width, sy = static_cast<double>(small.height()) / size.height;
  parallel_for(size.height, [&](int y) {
    for (int x = 0; x < size.width; ++x) {
      out(x, y) = sample_bilinear(small, Vec2((x + 0.5) * sx - 0.5, (y + 0.5) * sy - 0.5));
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
  for (std::size_t i = 0; i < weighted.pixels().size(); ++i) {
    weighted.pixels()[i] = times(image.pixels()[i], weight.pixels()[i]);
  }
  Image<T> sum = blur(weighted, sigma);
  const ScalarImage total = blur(weight, sigma);
  Image<T> plain;
  for (std::size_t i = 0; i < sum.pixels().size(); ++i) {
    const float w = total.pixels()[i];
    if (w > 1e-6f) {
      sum.pixels()[i] = times(sum.pixels()[i], 1.0f / w);
    } else {
      if (plain.empty()) plain = blur(image, sigma);
      sum.pixels()[i] = plain.pixels()[i];
    }
  }
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
  Image<double> columns(mask.size());
  parallel_for(w, [&](int x) {
    std::vector<double> f(h), d(h), z(h + 1);
    std::vector<int> v(h);
    for (int y = 0; y < h; ++y) f[y] = mask(x, y) ? 0.0 : kFar;
    squared_distances(f, d, v, z);
    for (int y = 0; y < h; ++y) columns(x, y) = std::min(d[y], kFar);
  }, 32);
  ScalarImage out(mask.size());
  parallel_for(h, [&](int y) {
    std::vector<double> f(columns.row(y), columns.row(y) + w), d(w), z(w + 1);
    std::vector<int> v(w);
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
