// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/exemplar/rectification.h"

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>

#include "ramify/core/error.h"
#include "ramify/core/options.h"
#include "ramify/core/parallel.h"
#include "ramify/image/sample.h"

namespace ramify {
namespace {

constexpr int kMostSamples = 8;  // per axis

// How many samples per axis one target pixel needs: the longest axis of its footprint in the source, in px.
int samples_for(const Homography& source_from_target, const Vec2& p) {
  const Eigen::Matrix2d j = jacobian(source_from_target, p);
  const double stretch = Eigen::JacobiSVD<Eigen::Matrix2d>(j).singularValues()[0];
  return std::clamp(static_cast<int>(std::ceil(stretch - 1e-9)), 1, kMostSamples);
}

bool covers(const ColorImage& source, const Mask& alpha, const Vec2& q) {
  if (q.x() < -0.5 || q.y() < -0.5 || q.x() > source.width() - 0.5 || q.y() > source.height() - 0.5) return false;
  return alpha.empty() || alpha.clamped(static_cast<int>(std::lround(q.x())), static_cast<int>(std::lround(q.y()))) > 0;
}

}  // namespace

Rectification rectification_from_corners(const std::array<Vec2, 4>& corners, double pixel_limit) {
  if (const char* why = fault_of_corners(corners)) {
    throw InputError("corners", std::string("the quadrilateral cannot be rectified: ") + why);
  }
  const auto side = [&](int i, int k) { return (corners[i] - corners[k]).norm(); };
  const double width = std::round(std::max(side(0, 1), side(3, 2))), height = std::round(std::max(side(0, 3), side(1, 2)));
  if (width * height > pixel_limit) {
    throw LimitError("the rectified picture would have " + number_text(width) + " x " + number_text(height) + " pixels");
  }
  Rectification r;
  r.size = {std::max(2, static_cast<int>(width)), std::max(2, static_cast<int>(height))};
  const double right = r.size.width - 1, bottom = r.size.height - 1;
  r.rectified_from_photo = homography_from_corners(
      corners, {Vec2(0, 0), Vec2(right, 0), Vec2(right, bottom), Vec2(0, bottom)});
  return r;
}

Warped warp_picture(const ColorImage& source, const Mask& alpha, const Homography& target_from_source, Size target,
                    const Monitor& monitor) {
  const Homography source_from_target = inverse(target_from_source);
  Warped out{ColorImage(target), Mask(target)};
  parallel_for(target.height, [&](int y) {
    monitor.check();
    for (int x = 0; x < target.width; ++x) {
      const Vec2 p(x, y);
      if (!in_front(source_from_target, p)) continue;
      const int n = samples_for(source_from_target, p);
      Rgb sum;
      int inside = 0;
      for (int k = 0; k < n * n; ++k) {
        const Vec2 at(x + (k % n + 0.5) / n - 0.5, y + (k / n + 0.5) / n - 0.5);
        const Vec2 q = apply(source_from_target, at);
        if (!in_front(source_from_target, at) || !covers(source, alpha, q)) continue;
        sum = sum + sample_lanczos3(source, q);
        ++inside;
      }
      if (inside == 0) continue;
      out.color(x, y) = (1.0f / static_cast<float>(inside)) * sum;
      out.valid(x, y) = static_cast<std::uint8_t>(255 * inside / (n * n));
    }
  }, 4);
  return out;
}

ColorImage distort_back(const ColorImage& photo, const ColorImage& rectified, const Homography& rectified_from_photo,
                        const Monitor& monitor) {
  const Warped warped = warp_picture(rectified, {}, inverse(rectified_from_photo), photo.size(), monitor);
  ColorImage out = photo;
  for (std::size_t i = 0; i < out.pixels().size(); ++i) {
    const float a = static_cast<float>(warped.valid.pixels()[i]) / 255.0f;
    out.pixels()[i] = (1.0f - a) * photo.pixels()[i] + a * warped.color.pixels()[i];
  }
  return out;
}

}  // namespace ramify
