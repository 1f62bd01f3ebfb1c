// SPDX-License-Identifier: GPL-3.0-or-later
// Private: an Image's pixels as a cv::Mat header, without a copy. For .cpp files only.
#pragma once

#include <opencv2/core.hpp>

#include "ramify/image/image.h"

namespace ramify {

template <class T>
struct CvType;
template <>
struct CvType<Rgb> { static constexpr int value = CV_32FC3; };
template <>
struct CvType<float> { static constexpr int value = CV_32FC1; };
template <>
struct CvType<std::uint8_t> { static constexpr int value = CV_8UC1; };
template <>
struct CvType<std::uint16_t> { static constexpr int value = CV_16UC1; };
template <>
struct CvType<std::int32_t> { static constexpr int value = CV_32SC1; };
template <>
struct CvType<Eigen::Vector2f> { static constexpr int value = CV_32FC2; };

template <class T>
cv::Mat cv_view(Image<T>& image) {
  return {image.height(), image.width(), CvType<T>::value, image.pixels().data()};
}

// Read-only by agreement: OpenCV has no constant matrices.
template <class T>
cv::Mat cv_view(const Image<T>& image) {
  return {image.height(), image.width(), CvType<T>::value, const_cast<T*>(image.pixels().data())};
}

// Pins OpenCV to one plain code path, so that results do not depend on the CPU or on its thread pool (the threads are
// ours). Called by every function of this layer that uses OpenCV.
void settle_opencv();

}  // namespace ramify
