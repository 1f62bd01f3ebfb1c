// SPDX-License-Identifier: GPL-3.0-or-later
// The one front door for pictures: the type is found by magic bytes (never by the name), header and limits are checked
// before anything is decoded, truncated files are refused, orientation and colour profile are applied once.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "ramify/image/image.h"

namespace ramify {

struct LoadLimits {
  double pixels = 256e6;               // largest width x height
  std::size_t file_bytes = 1u << 30;   // largest file
  bool allow_truncated = false;        // a cut file gives what can be read, with a warning
};

struct LoadedImage {
  ColorImage color;                    // sRGB-encoded, 0..1, not clamped for float files
  Mask alpha;                          // empty when the file has none
  int bits = 8;                        // 8, 16 or 32 (float)
  std::string sha256;                  // of the file's bytes
  std::map<std::string, std::string> texts;  // PNG texts, TIFF description, EXR string attributes; ours: "ramify-recipe"
  std::vector<std::string> warnings;   // sentences: wrong extension, broken profile, NaN cleaned with a count, …
};

// PNG, JPEG, TIFF, OpenEXR, WebP. Throws InputError or LimitError. `name` stands in messages.
// load_image also picks up the recipe that lies beside a JPEG (recipe_path).
LoadedImage load_image(const std::string& path, const LoadLimits& limits = {});
LoadedImage decode_image(const std::string& bytes, const std::string& name, const LoadLimits& limits = {});

struct SaveOptions {
  int bits = 8;                        // see fitting_bits; 16 means half and 32 float in EXR, 32 float in TIFF
  int quality = 95;                    // JPEG, WebP: 1..100; WebP is lossless at 100
  bool dither = false;                 // 8 bits: hide steps in smooth dark skies with one level of fixed noise
  std::string recipe = {};             // JSON stored inside the file; for JPEG in recipe_path(path)
};

// The format is chosen by the extension of `path` (.png .jpg .jpeg .tif .tiff .exr .webp); throws OptionError for
// others before any work. Integers are rounded and clamped. Equal pictures and options give equal bytes. Whole or not
// at all; throws OutputError, and OptionError for a depth the format cannot hold.
void check_image_name(const std::string& path);
void save_image(const std::string& path, const ColorImage& image, const SaveOptions& options = {});
void save_image(const std::string& path, const ColorImage& image, const Mask& alpha, const SaveOptions& options = {});
std::string encode_image(const std::string& path, const ColorImage& image, const Mask* alpha, const SaveOptions& options);

// The depth of the path's format that is nearest to the wanted one without losing any, if it has one:
// PNG 8 or 16, JPEG and WebP 8, TIFF 8, 16 or 32, EXR 16 or 32.
int fitting_bits(const std::string& path, int bits);

std::string recipe_path(const std::string& path);  // PATH.recipe.json

// Masks and fields, exactly: 8-bit grey PNG; 16-bit grey PNG; 32-bit float TIFF (values as they are).
Mask load_mask(const std::string& path, const LoadLimits& limits = {});       // luminance, 0..255
ScalarImage load_scalar(const std::string& path, const LoadLimits& limits = {});  // luminance 0..1, or the float values
void save_mask(const std::string& path, const Mask& mask);
void save_mask16(const std::string& path, const Image<std::uint16_t>& values);
void save_scalar(const std::string& path, const ScalarImage& values);

std::string sha256_hex(const std::string& bytes);

}  // namespace ramify
