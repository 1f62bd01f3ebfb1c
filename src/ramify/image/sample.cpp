// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/image/sample.h"

#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "ramify/core/rounding.h"
#include "ramify/image/cv_view.h"

namespace ramify {
namespace {

template <class T>
T blend(const T& a, const T& b, float t) { return (1.0f - t) * a + t * b; }

template <class T>
T bilinear(const Image<T>& image, const Vec2& p) {
  const double fx = std::floor(p.x()), fy = std::floor(p.y());
  const int x = static_cast<int>(fx), y = static_cast<int>(fy);
  const float tx = static_cast<float>(p.x() - fx), ty = static_cast<float>(p.y() - fy);
  return blend(blend(image.clamped(x, y), image.clamped(x + 1, y), tx),
               blend(image.clamped(x, y + 1), image.clamped(x + 1, y + 1), tx), ty);
}

// Lanczos-3 kernel tabulated at 1/1024 px: the table costs less than a sine per tap and errs by less than 1e-4.
constexpr int kLanczosSteps = 1024;
const std::array<std::array<float, 6>, kLanczosSteps + 1>& lanczos_table() {
  static const auto table = [] {
    std::array<std::array<float, 6>, kLanczosSteps + 1> t{};
    for (int s = 0; s <= kLanczosSteps; ++s) {
      double sum = 0.0;
      std::array<double, 6> w{};
      for (int k = 0; k < 6; ++k) {
        const double x = kPi * (static_cast<double>(s) / kLanczosSteps - (k - 2));
        w[k] = std::abs(x) < 1e-9 ? 1.0 : std::abs(x) >= 3.0 * kPi ? 0.0 : 3.0 * std::sin(x) * std::sin(x / 3.0) / (x * x);
        sum += w[k];
      }
      for (int k = 0; k < 6; ++k) t[s][k] = static_cast<float>(w[k] / sum);
    }
    return t;
  }();
  return table;
}

template <class T>
T lanczos3(const Image<T>& image, const Vec2& p) {
  const double fx = std::floor(p.x()), fy = std::floor(p.y());
  const int x = static_cast<int>(fx), y = static_cast<int>(fy);
  const auto& wx = lanczos_table()[round_to_int((p.x() - fx) * kLanczosSteps)];
  const auto& wy = lanczos_table()[round_to_int((p.y() - fy) * kLanczosSteps)];
  const bool inside = x >= 2 && y >= 2 && x + 3 < image.width() && y + 3 < image.height();
  T out{};
  for (int j = 0; j < 6; ++j) {
    T line{};
    if (inside) {
      const T* row = image.row(y - 2 + j) + (x - 2);
      for (int i = 0; i < 6; ++i) line = line + wx[i] * row[i];
    } else {
      for (int i = 0; i < 6; ++i) line = line + wx[i] * image.clamped(x - 2 + i, y - 2 + j);
    }
    out = out + wy[j] * line;
  }
  return out;
}

template <class T>
Image<T> resized(const Image<T>& image, Size size, int mode) {
  settle_opencv();
  Image<T> out(size);
  if (out.empty() || image.empty()) return out;
  cv::Mat target = cv_view(out);
  cv::resize(cv_view(image), target, target.size(), 0, 0, mode);
  return out;
}

int resize_mode(Size from, Size to) {
  return to.width < from.width || to.height < from.height ? cv::INTER_AREA : cv::INTER_CUBIC;
}

}  // namespace

float sample_bilinear(const ScalarImage& image, const Vec2& p) { return bilinear(image, p); }
Rgb sample_bilinear(const ColorImage& image, const Vec2& p) { return bilinear(image, p); }
Rgb sample_lanczos3(const ColorImage& image, const Vec2& p) { return lanczos3(image, p); }
float sample_lanczos3(const ScalarImage& image, const Vec2& p) { return lanczos3(image, p); }

ColorImage resize(const ColorImage& image, Size size) { return resized(image, size, resize_mode(image.size(), size)); }
ScalarImage resize(const ScalarImage& image, Size size) { return resized(image, size, resize_mode(image.size(), size)); }
Mask resize_nearest(const Mask& image, Size size) { return resized(image, size, cv::INTER_NEAREST); }
LabelImage resize_nearest(const LabelImage& image, Size size) {
  LabelImage out(size);
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x)
      out(x, y) = image.clamped((2 * x + 1) * image.width() / (2 * size.width), (2 * y + 1) * image.height() / (2 * size.height));
  return out;
}

}  // namespace ramify
