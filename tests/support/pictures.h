// SPDX-License-Identifier: GPL-3.0-or-later
// Small pictures with known pixels for the tests of reading and writing.
#pragma once

#include <cstdlib>
#include <string>

#include "ramify/core/random.h"
#include "ramify/image/image.h"

// Random levels of the given depth, so that writing at that depth loses nothing.
inline ramify::ColorImage level_noise(int width, int height, int bits, std::uint64_t seed = 1) {
  ramify::ColorImage image(width, height);
  ramify::Rng rng(seed);
  const int top = (1 << bits) - 1;
  for (ramify::Rgb& pixel : image.pixels()) {
    for (int c = 0; c < 3; ++c) pixel[c] = static_cast<float>(rng.below(top + 1)) / static_cast<float>(top);
  }
  return image;
}

inline ramify::Mask mask_noise(int width, int height, std::uint64_t seed = 2) {
  ramify::Mask mask(width, height);
  ramify::Rng rng(seed);
  for (auto& value : mask.pixels()) value = static_cast<std::uint8_t>(rng.below(256));
  return mask;
}

// The value that make_pictures.py gives to channel c at (x, y), 0..1.
inline float made_level(int x, int y, int c) {
  return static_cast<float>((7 * x + 13 * y + 50 * c) % 256) / 255.0f;
}

// Runs a Python script of tests/support; true when it ends with 0.
inline bool run_python(const std::string& script, const std::string& argument) {
  return std::system(
             (std::string(RAMIFY_PYTHON) + " '" RAMIFY_TEST_FOLDER "/support/" + script + "' '" + argument + "'")
                 .c_str()) == 0;
}
