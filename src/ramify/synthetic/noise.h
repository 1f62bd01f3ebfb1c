// SPDX-License-Identifier: GPL-3.0-or-later
// Random fields with a power-law spectrum: most natural surfaces - clouds, soil, plaster, tissue - look like one or
// several of them (ALGORITHMS 3.4).
#pragma once

#include <vector>

#include "ramify/core/random.h"
#include "ramify/image/image.h"

namespace ramify {

struct NoiseBand {
  double coarse = 256.0;     // px, longest wavelength, > 0
  double fine = 2.0;         // px, shortest wavelength, >= 2
  double slope = 2.0;        // power ~ frequency^-slope; 2 = equal contrast in every octave, 3 = cloudy
  double stretch_x = 1.0;    // wavelengths along x are this much longer
  double stretch_y = 1.0;
};

// Zero mean, standard deviation 1 over the picture. Sums of cubic B-spline lattices, one an octave.
ScalarImage power_noise(Size size, const NoiseBand& band, const Rng& rng);

// Independent normal numbers, one a pixel.
ScalarImage white_noise(Size size, const Rng& rng);

// One-dimensional, smooth, about standard deviation 1, with one random value every half wavelength.
class LineNoise {
 public:
  LineNoise(double length, double wavelength, Rng rng);
  double at(double position) const;  // px from the start; constant beyond both ends

 private:
  double spacing_;
  std::vector<double> values_;
};

// The plane cut into the cells of jittered points, one a square of `pitch` px (Worley 1996).
struct CellSample {
  float nearest = 0.0f;   // px to the nearest point
  float border = 0.0f;    // px to the border of its cell, 0 on the border
  std::uint32_t id = 0;   // random number of the cell
};
Image<CellSample> cells(Size size, double pitch, double jitter, const Rng& rng);

// image(p) taken at p + amount * (dx, dy)(p), bilinear.
ScalarImage warped(const ScalarImage& image, const ScalarImage& dx, const ScalarImage& dy, double amount);

}  // namespace ramify
