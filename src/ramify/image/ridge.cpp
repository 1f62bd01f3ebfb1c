// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/image/ridge.h"

#include <algorithm>
#include <cmath>

#include "ramify/core/parallel.h"

namespace ramify {
namespace {

// Sampled Gaussian or its derivative, corrected so that it acts on polynomials up to its order exactly.
std::vector<float> kernel(double sigma, int order) {
  const int half = std::max(1, static_cast<int>(std::ceil(4.0 * sigma)));
  std::vector<double> k(static_cast<std::size_t>(2 * half + 1));
  double sum = 0.0;
  for (int i = -half; i <= half; ++i) sum += k[i + half] = std::exp(-0.5 * i * i / (sigma * sigma));
  for (double& v : k) v /= sum;
  if (order == 1) {
    double moment = 0.0;
    for (int i = -half; i <= half; ++i) moment += i * i * k[i + half];
    for (int i = -half; i <= half; ++i) k[i + half] *= i / moment;
  } else if (order == 2) {
    double second = 0.0, fourth = 0.0;
    for (int i = -half; i <= half; ++i) second += i * i * k[i + half];
    for (int i = -half; i <= half; ++i) fourth += i * i * (i * i - second) * k[i + half];
    for (int i = -half; i <= half; ++i) k[i + half] *= 2.0 * (i * i - second) / fourth;
  }
  return {k.begin(), k.end()};
}

int mirrored(int i, int n) {
  if (n == 1) return 0;
  const int period = 2 * n - 2;
  i = ((i % period) + period) % period;
  return i < n ? i : period - i;
}

// Correlation along x, rows in parallel.
ScalarImage filter_rows(const ScalarImage& in, const std::vector<float>& k) {
  const int half = static_cast<int>(k.size()) / 2, width = in.width();
  ScalarImage out(in.size());
  parallel_for(in.height(), [&](int y) {
    std::vector<float> padded(static_cast<std::size_t>(width + 2 * half));
    for (int i = 0; i < width + 2 * half; ++i) padded[i] = in(mirrored(i - half, width), y);
    float* row = out.row(y);
    for (std::size_t j = 0; j < k.size(); ++j) {
      const float weight = k[j];
      const float* source = padded.data() + j;
      for (int x = 0; x < width; ++x) row[x] += weight * source[x];
    }
  }, 16);
  return out;
}

// Correlation along y, rows in parallel.
ScalarImage filter_columns(const ScalarImage& in, const std::vector<float>& k) {
  const int half = static_cast<int>(k.size()) / 2, width = in.width();
  ScalarImage out(in.size());
  parallel_for(in.height(), [&](int y) {
    float* row = out.row(y);
    for (std::size_t j = 0; j < k.size(); ++j) {
      const float weight = k[j];
      const float* source = in.row(mirrored(y + static_cast<int>(j) - half, in.height()));
      for (int x = 0; x < width; ++x) row[x] += weight * source[x];
    }
  }, 16);
  return out;
}

float bilinear(const ScalarImage& image, double x, double y) {
  const int ix = static_cast<int>(std::floor(x)), iy = static_cast<int>(std::floor(y));
  const float fx = static_cast<float>(x - ix), fy = static_cast<float>(y - iy);
  return (1 - fy) * ((1 - fx) * image.clamped(ix, iy) + fx * image.clamped(ix + 1, iy)) +
         fy * ((1 - fx) * image.clamped(ix, iy + 1) + fx * image.clamped(ix + 1, iy + 1));
}

struct ScaleResponse {
  ScalarImage sato, strength;
  VectorImage tangent;
};

// One scale on one picture; sigma in px of that picture.
ScaleResponse respond(const ScalarImage& picture, double sigma, bool bright) {
  const ScalarImage smooth = gaussian_filter(picture, sigma);
  ScaleResponse r{ScalarImage(picture.size()), ScalarImage(picture.size()),
                  VectorImage(picture.size(), Eigen::Vector2f(1, 0))};
  const float sign = bright ? -1.0f : 1.0f, norm = static_cast<float>(sigma * sigma);
  parallel_for(picture.height(), [&](int y) {
    for (int x = 0; x < picture.width(); ++x) {
      // Second differences of the smoothed picture: from sigma 0.7 on as good as derivative kernels, and four times cheaper.
      const float here = smooth(x, y);
      const float xx = smooth.clamped(x + 1, y) - 2.0f * here + smooth.clamped(x - 1, y);
      const float yy = smooth.clamped(x, y + 1) - 2.0f * here + smooth.clamped(x, y - 1);
      const float xy = 0.25f * (smooth.clamped(x + 1, y + 1) - smooth.clamped(x - 1, y + 1) -
                                smooth.clamped(x + 1, y - 1) + smooth.clamped(x - 1, y - 1));
      const float a = norm * sign * xx, b = norm * sign * xy, c = norm * sign * yy;
      const float mean = 0.5f * (a + c), spread = std::sqrt(0.25f * (a - c) * (a - c) + b * b);
      const float across = mean + spread, along = mean - spread;  // across: most positive = most line-like
      if (across <= 0.0f || across < std::abs(along)) continue;
      Eigen::Vector2f normal = a >= c ? Eigen::Vector2f(spread + 0.5f * (a - c), b)
                                      : Eigen::Vector2f(b, spread + 0.5f * (c - a));
      const float length = normal.norm();
      normal = length > 0.0f ? Eigen::Vector2f(normal / length) : Eigen::Vector2f(0, 1);
      const double reach = 2.0 * sigma;
      const float left = -sign * (here - bilinear(smooth, x + reach * normal.x(), y + reach * normal.y()));
      const float right = -sign * (here - bilinear(smooth, x - reach * normal.x(), y - reach * normal.y()));
      const float low = std::max(0.0f, std::min(left, right)), high = std::max(left, right);
      const float balance = high > 0.0f ? std::min(1.0f, 2.5f * low / high) : 0.0f;
      r.sato(x, y) = across;
      r.strength(x, y) = across * balance;
      r.tangent(x, y) = Eigen::Vector2f(-normal.y(), normal.x());
    }
  }, 16);
  return r;
}

ScalarImage halved(const ScalarImage& picture) {
  const ScalarImage smooth = gaussian_filter(picture, 1.0);
  ScalarImage out((picture.width() + 1) / 2, (picture.height() + 1) / 2);
  for (int y = 0; y < out.height(); ++y) {
    for (int x = 0; x < out.width(); ++x) out(x, y) = smooth.clamped(2 * x, 2 * y);
  }
  return out;
}

// Keeps the stronger response; `step` maps picture pixels to the reduced ones.
void keep_stronger(RidgeField& field, const ScaleResponse& r, int step, double sigma) {
  parallel_for(field.sato.height(), [&](int y) {
    for (int x = 0; x < field.sato.width(); ++x) {
      const double u = static_cast<double>(x) / step, v = static_cast<double>(y) / step;
      const int nx = static_cast<int>(u + 0.5), ny = static_cast<int>(v + 0.5);
      const float sato = step == 1 ? r.sato(x, y) : bilinear(r.sato, u, v);
      const float strength = step == 1 ? r.strength(x, y) : bilinear(r.strength, u, v);
      field.sato(x, y) = std::max(field.sato(x, y), sato);
      if (strength <= field.strength(x, y)) continue;
      field.strength(x, y) = strength;
      field.sigma(x, y) = static_cast<float>(sigma);
      field.tangent(x, y) = r.tangent.clamped(nx, ny);
    }
  }, 16);
}

}  // namespace

ScalarImage gaussian_filter(const ScalarImage& picture, double sigma, int order_x, int order_y) {
  return filter_columns(filter_rows(picture, kernel(sigma, order_x)), kernel(sigma, order_y));
}

RidgeField ridge_field(const ScalarImage& picture, const RidgeOptions& options, const Monitor& monitor) {
  const Size size = picture.size();
  RidgeField field{ScalarImage(size), ScalarImage(size), ScalarImage(size, static_cast<float>(options.min_sigma)),
                   VectorImage(size, Eigen::Vector2f(1, 0))};
  ScalarImage level = picture;
  int step = 1;
  double carried = 0.0;  // px of the level: smoothing already in it
  for (double sigma = options.min_sigma; sigma <= options.max_sigma * 1.0001; sigma *= std::sqrt(2.0)) {
    monitor.check();
    while (sigma / step > 4.0 && std::min(level.width(), level.height()) > 16) {
      level = halved(level);
      step *= 2;
      carried = 0.5 * std::sqrt(carried * carried + 1.0);
    }
    const double wanted = sigma / step;
    const double missing = std::sqrt(std::max(wanted * wanted - carried * carried, 0.25));
    keep_stronger(field, respond(level, missing, options.bright), step, sigma);
  }
  return field;
}

}  // namespace ramify
