// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <cstring>
#include <optional>

#include "ramify/core/atomic_file.h"
#include "ramify/core/error.h"
#include "ramify/core/parallel.h"
#include "ramify/core/random.h"
#include "ramify/image/exr_codec.h"
#include "ramify/image/image_container.h"
#include "ramify/image/image_format.h"
#include "ramify/image/image_io.h"
#include "ramify/image/recipe_xmp.h"
#include "ramify/image/vips_codec.h"

namespace ramify {
namespace {

// Rounded to the nearest level; what lies outside 0..1 is clamped, NaN becomes 0. `shift` in levels is the dither.
unsigned level_of(float value, unsigned top, double shift) {
  if (!(value > 0.0f)) return 0;
  if (value >= 1.0f) return top;
  return static_cast<unsigned>(std::clamp(std::floor(value * double{1} * top + 0.5 + shift), 0.0, double{1} * top));
}

Samples quantize(const ColorImage& image, const Mask* alpha, int bits, bool dither) {
  Samples out;
  out.size = image.size();
  out.type = bits == 8 ? SampleType::U8 : bits == 16 ? SampleType::U16 : SampleType::F32;
  out.alpha = alpha != nullptr;
  const int channels = out.channels(), width = image.width();
  const std::size_t sample = bits / 8, stride = sample * channels * width;
  out.bytes.resize(stride * image.height());
  parallel_for(
      image.height(),
      [&](int y) {
        unsigned char* to = out.bytes.data() + stride * y;
        const auto put = [&](auto value) {
          std::memcpy(to, &value, sizeof value);
          to += sizeof value;
        };
        for (int x = 0; x < width; ++x) {
          for (int c = 0; c < 3; ++c) {
            const float value = image(x, y)[c];
            const double shift = dither ? hash01(0x646974686572, x, y, c) - 0.5 : 0.0;
            if (bits == 8) put(static_cast<std::uint8_t>(level_of(value, 255, shift)));
            if (bits == 16) put(static_cast<std::uint16_t>(level_of(value, 65535, 0.0)));
            if (bits == 32) put(value);
          }
          if (!alpha) continue;
          const std::uint8_t opacity = (*alpha)(x, y);
          if (bits == 8) put(opacity);
          if (bits == 16) put(static_cast<std::uint16_t>(opacity * 257));
          if (bits == 32) put(static_cast<float>(opacity) / 255.0f);
        }
      },
      16);
  return out;
}

template <class T>
Samples grey_samples(const Image<T>& values, SampleType type) {
  Samples out;
  out.size = values.size();
  out.model = ColorModel::Grey;
  out.type = type;
  const auto* begin = reinterpret_cast<const unsigned char*>(values.pixels().data());
  out.bytes.assign(begin, begin + values.pixels().size() * sizeof(T));
  return out;
}

void require_extension(const std::string& path, ImageFormat format) {
  if (format_of_name(path) != format) {
    throw OutputError(printable(path, 300), "masks are written as .png and fields of numbers as .tif; change the name");
  }
}

// Whether `image` fits into the format at all, before any work.
void check_fits(const std::string& path, ImageFormat format, Size size, bool alpha, int bits) {
  const std::string name = printable(path, 300), kind = format_name(format);
  if (size.width <= 0 || size.height <= 0) throw OutputError(name, "the picture has no pixels");
  if (fitting_bits(path, bits) != bits) {
    throw OptionError(
        "depth", std::to_string(bits),
        kind + " holds " + std::to_string(fitting_bits(path, bits)) + " bits; choose that depth or another format");
  }
  const int longest = format == ImageFormat::Jpeg ? 65500 : format == ImageFormat::Webp ? 16383 : 1 << 30;
  if (std::max(size.width, size.height) > longest) {
    throw OutputError(name,
                      kind + " pictures have at most " + std::to_string(longest) + " px a side; write a .png or .tif");
  }
  if (alpha && format == ImageFormat::Jpeg)
    throw OutputError(name, "JPEG cannot hold transparency; write a .png or .tif");
}

std::string encode_with_vips(ImageFormat format, const ColorImage& image, const Mask* alpha,
                             const SaveOptions& options) {
  const bool dither = options.dither && options.bits == 8;
  const std::string file = encode_samples(format, quantize(image, alpha, options.bits, dither), options.quality,
                                          format == ImageFormat::Png ? "" : xmp_of_recipe(options.recipe));
  return format == ImageFormat::Png ? png_with_text(file, kRecipeKey, options.recipe) : file;
}

// Both files of a JPEG with a recipe are on the disk before either gets its name.
void save(const std::string& path, const ColorImage& image, const Mask* alpha, const SaveOptions& options) {
  const std::string bytes = encode_image(path, image, alpha, options);
  AtomicFile picture(path);
  picture.write(bytes);
  std::optional<AtomicFile> recipe;
  if (format_of_name(path) == ImageFormat::Jpeg && !options.recipe.empty()) {
    recipe.emplace(recipe_path(path));
    recipe->write(options.recipe);
  }
  picture.commit();
  if (recipe) recipe->commit();
}

}  // namespace

void check_image_name(const std::string& path) {
  if (format_of_name(path) != ImageFormat::Unknown) return;
  throw OptionError("output", printable(path, 300), "the name must end with .png, .jpg, .tif, .exr or .webp");
}

int fitting_bits(const std::string& path, int bits) {
  switch (format_of_name(path)) {
    case ImageFormat::Png:
      return bits <= 8 ? 8 : 16;
    case ImageFormat::Tiff:
      return bits <= 8 ? 8 : bits <= 16 ? 16 : 32;
    case ImageFormat::Exr:
      return bits <= 16 ? 16 : 32;
    case ImageFormat::Jpeg:
    case ImageFormat::Webp:
    case ImageFormat::Unknown:
      break;
  }
  return 8;
}

std::string recipe_path(const std::string& path) {
  return path + ".recipe.json";
}

std::string encode_image(const std::string& path, const ColorImage& image, const Mask* alpha,
                         const SaveOptions& options) {
  check_image_name(path);
  const ImageFormat format = format_of_name(path);
  check_fits(path, format, image.size(), alpha != nullptr, options.bits);
  return format == ImageFormat::Exr ? encode_exr(image, alpha, options.bits, options.recipe)
                                    : encode_with_vips(format, image, alpha, options);
}

void save_image(const std::string& path, const ColorImage& image, const SaveOptions& options) {
  save(path, image, nullptr, options);
}

void save_image(const std::string& path, const ColorImage& image, const Mask& alpha, const SaveOptions& options) {
  save(path, image, alpha.empty() ? nullptr : &alpha, options);
}

void save_mask(const std::string& path, const Mask& mask) {
  require_extension(path, ImageFormat::Png);
  write_file(path, encode_samples(ImageFormat::Png, grey_samples(mask, SampleType::U8), 0, ""));
}

void save_mask16(const std::string& path, const Image<std::uint16_t>& values) {
  require_extension(path, ImageFormat::Png);
  write_file(path, encode_samples(ImageFormat::Png, grey_samples(values, SampleType::U16), 0, ""));
}

void save_scalar(const std::string& path, const ScalarImage& values) {
  require_extension(path, ImageFormat::Tiff);
  write_file(path, encode_samples(ImageFormat::Tiff, grey_samples(values, SampleType::F32), 0, ""));
}

}  // namespace ramify
