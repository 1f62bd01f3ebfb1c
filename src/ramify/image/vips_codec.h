// SPDX-License-Identifier: GPL-3.0-or-later
// Pixels of PNG, JPEG, TIFF and WebP to and from memory with libvips. Private to this layer.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "ramify/image/image_format.h"
#include "ramify/image/image_io.h"

namespace ramify {

enum class ColorModel { Grey, Rgb, Cmyk };
enum class SampleType { U8, U16, F32 };

// Pixels as a decoder gives them: interleaved, row by row, alpha last.
struct Samples {
  Size size;
  ColorModel model = ColorModel::Rgb;
  SampleType type = SampleType::U8;
  bool alpha = false;
  std::vector<unsigned char> bytes;

  int color_channels() const { return model == ColorModel::Grey ? 1 : model == ColorModel::Rgb ? 3 : 4; }
  int channels() const { return color_channels() + (alpha ? 1 : 0); }
};

// `file` must hold a picture of this format whose header says `size`. Throws InputError. `warnings` gets a sentence for
// everything that is not used (further pages).
Samples decode_samples(ImageFormat format, std::string_view file, Size size, bool allow_truncated,
                       const std::string& name, std::vector<std::string>& warnings);

// Throws OutputError when libvips fails. `xmp` is stored in TIFF and WebP files unless it is empty.
std::string encode_samples(ImageFormat format, const Samples& samples, int quality, const std::string& xmp);

// The CMYK profile that libvips brings along, for pictures that have none; empty when the system has none.
std::string fallback_cmyk_profile();

}  // namespace ramify
