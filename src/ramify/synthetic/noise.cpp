// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/synthetic/noise.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "ramify/core/parallel.h"
#include "ramify/image/sample.h"

namespace ramify {
namespace {

constexpr int kRowGrain = 16;

// Weights of the four lattice values around a position, uniform cubic B-spline.
struct SplineTap {
  int first = 0;
  std::array<float, 4> weight{};
};

SplineTap spline_tap(double position) {
  const double cell = std::floor(position);
  const float t = static_cast<float>(position - cell), u = 1.0f - t;
  return {static_cast<int>(cell),
          {u * u * u / 6.0f, (3.0f * t * t * t - 6.0f * t * t + 4.0f) / 6.0f,
           (3.0f * u * u * u - 6.0f * u * u + 4.0f) / 6.0f, t * t * t / 6.0f}};
}

// Adds amplitude times a lattice of normal numbers, `step_x` x `step_y` px apart.
void add_octave(ScalarImage& field, double step_x, double step_y, float amplitude, const Rng& rng) {
  const int columns = static_cast<int>(field.width() / step_x) + 5, rows = static_cast<int>(field.height() / step_y) + 5;
  ScalarImage lattice(columns, rows);
  parallel_for(rows, [&](int j) {
    Rng row_rng = rng.child("row", j);
    for (int i = 0; i < columns; ++i) lattice(i, j) = static_cast<float>(row_rng.normal());
  }, kRowGrain);
  std::vector<SplineTap> taps(field.width());
  for (int x = 0; x < field.width(); ++x) taps[x] = spline_tap(x / step_x);
  parallel_for(field.height(), [&](int y) {
    const SplineTap tap = spline_tap(y / step_y);
    std::vector<float> row(columns);
    for (int i = 0; i < columns; ++i)
      for (int k = 0; k < 4; ++k) row[i] += amplitude * tap.weight[k] * lattice(i, tap.first + k);
    float* out = field.row(y);
    for (int x = 0; x < field.width(); ++x) {
      const float* at = row.data() + taps[x].first;
      const auto& w = taps[x].weight;
      out[x] += w[0] * at[0] + w[1] * at[1] + w[2] * at[2] + w[3] * at[3];
    }
  }, kRowGrain);
}

// The sums are taken row by row and then in order: the same for any number of threads.
void standardize(ScalarImage& field) {
  std::vector<double> sum(field.height()), square(field.height());
  parallel_for(field.height(), [&](int y) {
    for (int x = 0; x < field.width(); ++x) {
      sum[y] += field(x, y);
      square[y] += static_cast<double>(field(x, y)) * field(x, y);
    }
  }, kRowGrain);
  double total = 0.0, total_square = 0.0;
  for (int y = 0; y < field.height(); ++y) total += sum[y], total_square += square[y];
  const double count = static_cast<double>(field.width()) * field.height();
  const double mean = total / count;
  const double deviation = std::sqrt(std::max(1e-12, total_square / count - mean * mean));
  for (float& value : field.pixels()) value = static_cast<float>((value - mean) / deviation);
}

}  // namespace

ScalarImage power_noise(Size size, const NoiseBand& band, const Rng& rng) {
  ScalarImage field(size);
  int octave = 0;
  for (double wavelength = band.coarse; wavelength >= band.fine; wavelength /= 2.0, ++octave)
    add_octave(field, std::max(1.0, wavelength * band.stretch_x / 2.0), std::max(1.0, wavelength * band.stretch_y / 2.0),
               static_cast<float>(std::pow(wavelength / band.coarse, (band.slope - 2.0) / 2.0)),
               rng.child("octave", octave));
  standardize(field);
  return field;
}

ScalarImage white_noise(Size size, const Rng& rng) {
  ScalarImage field(size);
  parallel_for(size.height, [&](int y) {
    Rng row_rng = rng.child("row", y);
    for (int x = 0; x < size.width; ++x) field(x, y) = static_cast<float>(row_rng.normal());
  }, kRowGrain);
  return field;
}

LineNoise::LineNoise(double length, double wavelength, Rng rng) : spacing_(std::max(wavelength / 2.0, 1e-3)) {
  const int count = static_cast<int>(std::max(0.0, length) / spacing_) + 5;
  // The cubic B-spline lattice has a standard deviation of about 0.69 (1-D).
  for (int i = 0; i < count; ++i) values_.push_back(rng.normal() / 0.69);
}

double LineNoise::at(double position) const {
  const double last = static_cast<double>(values_.size()) - 4.0 - 1e-9;
  const SplineTap tap = spline_tap(std::clamp(position / spacing_, 0.0, last));
  double value = 0.0;
  for (int k = 0; k < 4; ++k) value += tap.weight[k] * values_[tap.first + k];
  return value;
}

Image<CellSample> cells(Size size, double pitch, double jitter, const Rng& rng) {
  const int columns = static_cast<int>(size.width / pitch) + 5, rows = static_cast<int>(size.height / pitch) + 5;
  struct Point { float x, y; std::uint32_t id; };
  Image<Point> points(columns, rows);
  for (int j = 0; j < rows; ++j) {
    Rng row_rng = rng.child("row", j);
    for (int i = 0; i < columns; ++i) {
      const double x = (i - 1.5 + jitter * (row_rng.uniform() - 0.5)) * pitch;
      const double y = (j - 1.5 + jitter * (row_rng.uniform() - 0.5)) * pitch;
      points(i, j) = {static_cast<float>(x), static_cast<float>(y), row_rng.next()};
    }
  }
  Image<CellSample> out(size);
  parallel_for(size.height, [&](int y) {
    const int j0 = static_cast<int>(y / pitch) + 2;
    for (int x = 0; x < size.width; ++x) {
      const int i0 = static_cast<int>(x / pitch) + 2;
      float d1 = 1e30f, d2 = 1e30f;
      Point p1{}, p2{};
      for (int j = std::max(0, j0 - 2); j <= std::min(rows - 1, j0 + 1); ++j)
        for (int i = std::max(0, i0 - 2); i <= std::min(columns - 1, i0 + 1); ++i) {
          const Point& p = points(i, j);
          const float d = (p.x - x) * (p.x - x) + (p.y - y) * (p.y - y);
          if (d < d1) d2 = d1, p2 = p1, d1 = d, p1 = p;
          else if (d < d2) d2 = d, p2 = p;
        }
      const float apart = std::hypot(p2.x - p1.x, p2.y - p1.y);
      out(x, y) = {std::sqrt(d1), (d2 - d1) / (2.0f * std::max(apart, 1e-3f)), p1.id};
    }
  }, kRowGrain);
  return out;
}

ScalarImage warped(const ScalarImage& image, const ScalarImage& dx, const ScalarImage& dy, double amount) {
  ScalarImage out(image.size());
  parallel_for(image.height(), [&](int y) {
    for (int x = 0; x < image.width(); ++x)
      out(x, y) = sample_bilinear(image, Vec2(x + amount * dx(x, y), y + amount * dy(x, y)));
  }, kRowGrain);
  return out;
}

}  // namespace ramify
