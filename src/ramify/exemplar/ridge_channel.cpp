// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/exemplar/ridge_channel.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>

#include "ramify/core/parallel.h"
#include "ramify/image/ridge.h"

namespace ramify {
namespace {

double linear(double v) { return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4); }
double lab_curve(double t) { return t > 216.0 / 24389.0 ? std::cbrt(t) : (24389.0 / 27.0 * t + 16.0) / 116.0; }

// CIE Lab (D65), each axis divided by 100.
Eigen::Vector3d lab(const Rgb& c) {
  const double r = linear(std::clamp(c.r, 0.0f, 1.0f)), g = linear(std::clamp(c.g, 0.0f, 1.0f)),
               b = linear(std::clamp(c.b, 0.0f, 1.0f));
  const double x = lab_curve((0.4124 * r + 0.3576 * g + 0.1805 * b) / 0.95047);
  const double y = lab_curve(0.2126 * r + 0.7152 * g + 0.0722 * b);
  const double z = lab_curve((0.0193 * r + 0.1192 * g + 0.9505 * b) / 1.08883);
  return {1.16 * y - 0.16, 5.0 * (x - y), 2.0 * (y - z)};
}

// Axis k of the photo's colours, the largest variance first, its largest component positive.
Eigen::Vector3d principal_axis(const ColorImage& photo, int k) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  Eigen::Matrix3d second = Eigen::Matrix3d::Zero();
  for (const Rgb& c : photo.pixels()) {
    const Eigen::Vector3d v(c.r, c.g, c.b);
    mean += v;
    second += v * v.transpose();
  }
  const double n = static_cast<double>(photo.pixels().size());
  mean /= n;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(Eigen::Matrix3d(second / n - mean * mean.transpose()));
  Eigen::Vector3d axis = solver.eigenvectors().col(2 - k);
  int largest = 0;
  axis.cwiseAbs().maxCoeff(&largest);
  return axis[largest] < 0 ? Eigen::Vector3d(-axis) : axis;
}

ColorImage reduced(const ColorImage& photo, int step) {
  ColorImage out((photo.width() + step - 1) / step, (photo.height() + step - 1) / step);
  for (int y = 0; y < out.height(); ++y) {
    for (int x = 0; x < out.width(); ++x) {
      Rgb sum;
      for (int j = 0; j < step; ++j) {
        for (int i = 0; i < step; ++i) sum = sum + photo.clamped(x * step + i, y * step + j);
      }
      out(x, y) = (1.0f / static_cast<float>(step * step)) * sum;
    }
  }
  return out;
}

double quantile(std::vector<float> values, double q) {
  if (values.empty()) return 0.0;
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(q * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

double contrast_score(const RidgeField& field, const Mask& excluded, int step) {
  std::vector<float> values;
  for (int y = 0; y < field.strength.height(); ++y) {
    for (int x = 0; x < field.strength.width(); ++x) {
      if (excluded.empty() || !excluded.clamped(x * step, y * step)) values.push_back(field.strength(x, y));
    }
  }
  const double strong = quantile(values, 0.97);
  std::vector<float> positive;
  for (const float v : values) {
    if (v > 0.0f) positive.push_back(v);
  }
  return strong / (quantile(positive, 0.5) + 1e-4);
}

// Are the strongest ridges as white as the picture can be?
bool ridges_glow(const ColorImage& photo, const RidgeField& field) {
  const double strong = quantile(field.strength.pixels(), 0.995);
  std::vector<float> whites;
  for (std::size_t i = 0; i < photo.pixels().size(); ++i) {
    const Rgb& c = photo.pixels()[i];
    if (field.strength.pixels()[i] >= strong) whites.push_back(std::max({c.r, c.g, c.b}));
  }
  std::vector<float> all;
  for (const Rgb& c : photo.pixels()) all.push_back(std::max({c.r, c.g, c.b}));
  return quantile(whites, 0.5) > 0.93 && quantile(all, 0.5) < 0.5;
}

}  // namespace

ScalarImage channel_picture(const ColorImage& photo, Channel channel) {
  ScalarImage out(photo.size());
  const bool principal = channel == Channel::Principal1 || channel == Channel::Principal2;
  const Eigen::Vector3d axis =
      principal ? principal_axis(photo, channel == Channel::Principal2) : Eigen::Vector3d::Zero();
  parallel_for(photo.height(), [&](int y) {
    for (int x = 0; x < photo.width(); ++x) {
      const Rgb& c = photo(x, y);
      switch (channel) {
        case Channel::Red: out(x, y) = c.r; break;
        case Channel::Green: out(x, y) = c.g; break;
        case Channel::Blue: out(x, y) = c.b; break;
        case Channel::Principal1:
        case Channel::Principal2: out(x, y) = static_cast<float>(axis.dot(Eigen::Vector3d(c.r, c.g, c.b))); break;
        case Channel::GreenRed: out(x, y) = static_cast<float>(lab(c)[1]); break;
        case Channel::BlueYellow: out(x, y) = static_cast<float>(lab(c)[2]); break;
        case Channel::Auto:
        case Channel::Luminance: out(x, y) = static_cast<float>(lab(c)[0]); break;
      }
    }
  }, 16);
  return out;
}

ChannelChoice choose_channel(const ColorImage& photo, const Mask& excluded, double max_radius, Channel channel,
                             const Polarity* polarity, const Monitor& monitor) {
  const int step = std::max(1, std::max(photo.width(), photo.height()) / 640);
  const ColorImage small = reduced(photo, step);
  ChannelChoice best;
  for (int c = 1; c <= static_cast<int>(Channel::Principal2); ++c) {
    if (channel != Channel::Auto && c != static_cast<int>(channel)) continue;
    const ScalarImage picture = channel_picture(small, static_cast<Channel>(c));
    for (const bool bright : {false, true}) {
      if (polarity && bright != (*polarity != Polarity::Dark)) continue;
      monitor.check();
      RidgeOptions ridge{bright, 1.0, std::clamp(max_radius / step, 1.5, 4.0)};
      const RidgeField field = ridge_field(picture, ridge, monitor);
      const double score = contrast_score(field, excluded, step);
      if (score <= best.score) continue;
      best = {static_cast<Channel>(c), bright ? Polarity::Bright : Polarity::Dark, score};
      if (bright && ridges_glow(small, field)) best.polarity = Polarity::Glow;
    }
  }
  if (polarity) best.polarity = *polarity;
  return best;
}

ScalarImage flattened(const ScalarImage& picture, double sigma) {
  const ScalarImage mean = gaussian_filter(picture, sigma);
  ScalarImage square(picture.size());
  for (std::size_t i = 0; i < square.pixels().size(); ++i) {
    const float d = picture.pixels()[i] - mean.pixels()[i];
    square.pixels()[i] = d * d;
  }
  const ScalarImage variance = gaussian_filter(square, sigma);
  std::vector<float> deviations;
  for (const float v : variance.pixels()) deviations.push_back(std::sqrt(std::max(v, 0.0f)));
  const float typical = static_cast<float>(quantile(deviations, 0.5)) + 2.0f / 255.0f;
  ScalarImage out(picture.size());
  for (std::size_t i = 0; i < out.pixels().size(); ++i) {
    out.pixels()[i] = (picture.pixels()[i] - mean.pixels()[i]) / (deviations[i] + typical);
  }
  return out;
}

}  // namespace ramify
