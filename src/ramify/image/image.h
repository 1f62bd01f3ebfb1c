// SPDX-License-Identifier: GPL-3.0-or-later
// Typed pictures. An Image owns its pixels and copies deeply; cv::Mat appears only in .cpp files, through
// image/cv_view.h.
#pragma once

#include <cstdint>
#include <stdexcept>
#include <utility>
#include <vector>

#include "ramify/core/types.h"

namespace ramify {

// sRGB-encoded colour, 0..1 per channel, not clamped. Photos are matched, cut and blended as people see them; light is
// added in linear light inside the function that does so.
struct Rgb {
  float r = 0.0f, g = 0.0f, b = 0.0f;
  friend bool operator==(const Rgb&, const Rgb&) = default;
  float& operator[](int c) { return c == 0 ? r : c == 1 ? g : b; }
  float operator[](int c) const { return c == 0 ? r : c == 1 ? g : b; }
};
static_assert(sizeof(Rgb) == 3 * sizeof(float));
inline Rgb operator+(const Rgb& a, const Rgb& b) { return {a.r + b.r, a.g + b.g, a.b + b.b}; }
inline Rgb operator-(const Rgb& a, const Rgb& b) { return {a.r - b.r, a.g - b.g, a.b - b.b}; }
inline Rgb operator*(float s, const Rgb& a) { return {s * a.r, s * a.g, s * a.b}; }

template <class T>
class Image {
 public:
  Image() = default;
  Image(int width, int height, const T& fill = T{})
      : width_(width), height_(height), pixels_(checked_area(width, height), fill) {}
  explicit Image(Size size, const T& fill = T{}) : Image(size.width, size.height, fill) {}

  int width() const { return width_; }
  int height() const { return height_; }
  Size size() const { return {width_, height_}; }
  bool empty() const { return pixels_.empty(); }
  bool contains(int x, int y) const { return x >= 0 && y >= 0 && x < width_ && y < height_; }

  T& operator()(int x, int y) { return pixels_[static_cast<std::size_t>(y) * width_ + x]; }
  const T& operator()(int x, int y) const { return pixels_[static_cast<std::size_t>(y) * width_ + x]; }
  // The pixel nearest inside the picture.
  const T& clamped(int x, int y) const {
    return (*this)(x < 0 ? 0 : x >= width_ ? width_ - 1 : x, y < 0 ? 0 : y >= height_ ? height_ - 1 : y);
  }

  T* row(int y) { return pixels_.data() + static_cast<std::size_t>(y) * width_; }
  const T* row(int y) const { return pixels_.data() + static_cast<std::size_t>(y) * width_; }
  std::vector<T>& pixels() & { return pixels_; }
  const std::vector<T>& pixels() const& { return pixels_; }
  std::vector<T> pixels() && { return std::move(pixels_); }  // safe to loop over the pixels of a temporary

  friend bool operator==(const Image&, const Image&) = default;

 private:
  static std::size_t checked_area(int width, int height) {
    if (width < 0 || height < 0) throw std::invalid_argument("Image: negative size");
    return static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  }

  int width_ = 0;
  int height_ = 0;
  std::vector<T> pixels_;
};

using ColorImage = Image<Rgb>;
using ScalarImage = Image<float>;
using Mask = Image<std::uint8_t>;        // 0 = no, 255 = yes; masks drawn with coverage use the values between
using LabelImage = Image<std::int32_t>;  // kNone = no label
using VectorImage = Image<Eigen::Vector2f>;

}  // namespace ramify
