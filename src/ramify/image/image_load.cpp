// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <optional>

#include "ramify/core/atomic_file.h"
#include "ramify/core/error.h"
#include "ramify/core/parallel.h"
#include "ramify/image/color.h"
#include "ramify/image/color_profile.h"
#include "ramify/image/exr_codec.h"
#include "ramify/image/image_container.h"
#include "ramify/image/image_format.h"
#include "ramify/image/image_io.h"
#include "ramify/image/vips_codec.h"

namespace ramify {
namespace {

ImageContainer read_container(ImageFormat format, const std::string& bytes, const std::string& name) {
  switch (format) {
    case ImageFormat::Png:
      return read_png_container(bytes, name);
    case ImageFormat::Jpeg:
      return read_jpeg_container(bytes, name);
    case ImageFormat::Tiff:
      return read_tiff_container(bytes, name);
    case ImageFormat::Webp:
      return read_webp_container(bytes, name);
    case ImageFormat::Exr:
    case ImageFormat::Unknown:
      break;
  }
  throw std::invalid_argument("read_container: no container of ours");
}

void check_format(ImageFormat format, const std::string& bytes, const std::string& name) {
  if (bytes.empty()) throw InputError(name, "is empty");
  if (format == ImageFormat::Unknown) {
    throw InputError(name, "is " + describe_content(bytes) + "; ramify reads PNG, JPEG, TIFF, OpenEXR and WebP");
  }
}

void check_pixels(Size size, const std::string& name, const LoadLimits& limits) {
  const double pixels = double{1} * size.width * size.height;
  if (pixels > limits.pixels) {
    throw LimitError(name + ": " + std::to_string(size.width) + " x " + std::to_string(size.height) +
                     " pixels are more than the limit of " + std::to_string(static_cast<long long>(limits.pixels)) +
                     "; shrink the picture or raise --limit-pixels");
  }
}

void check_complete(const ImageContainer& file, const std::string& name, const LoadLimits& limits) {
  if (file.truncated && !limits.allow_truncated) {
    throw InputError(name,
                     "is cut off before its end; get the whole file, or pass --allow-truncated to use what is there");
  }
}

// The samples of one row as numbers, 0..1 for integers.
void read_row(const Samples& samples, int y, std::vector<float>& values) {
  const std::size_t count = static_cast<std::size_t>(samples.size.width) * samples.channels();
  values.resize(count);
  const std::size_t first = count * y;
  if (samples.type == SampleType::U8) {
    for (std::size_t i = 0; i < count; ++i) values[i] = static_cast<float>(samples.bytes[first + i]) / 255.0f;
  } else if (samples.type == SampleType::U16) {
    for (std::size_t i = 0; i < count; ++i) {
      std::uint16_t value;
      std::memcpy(&value, &samples.bytes[2 * (first + i)], 2);
      values[i] = static_cast<float>(value) / 65535.0f;
    }
  } else {
    std::memcpy(values.data(), &samples.bytes[4 * first], 4 * count);
  }
}

// Which profile applies, if any. CMYK needs one; elsewhere sRGB is assumed without.
std::optional<ColorProfile> choose_profile(const ImageContainer& file, ColorModel model, const std::string& name,
                                           std::vector<std::string>& warnings) {
  std::optional<ColorProfile> profile;
  if (!file.profile.empty()) {
    profile.emplace(file.profile, model);
    if (!profile->usable()) {
      warnings.push_back("its colour profile is broken or made for another kind of picture; " +
                         std::string(model == ColorModel::Cmyk ? "a common CMYK profile" : "sRGB") + " was assumed");
      profile.reset();
    }
  }
  if (!profile && model == ColorModel::Cmyk) {
    profile.emplace(fallback_cmyk_profile(), model);
    if (!profile->usable()) throw InputError(name, "is CMYK without a usable colour profile; convert it to RGB first");
  }
  if (profile && profile->is_srgb()) profile.reset();
  return profile;
}

// NaN and infinite values become 0. Returns how many.
int clean(std::vector<float>& values) {
  int bad = 0;
  for (float& value : values) {
    if (std::isfinite(value)) continue;
    value = 0.0f;
    ++bad;
  }
  return bad;
}

void split_row(const std::vector<float>& values, const Samples& samples, const ColorProfile* profile, bool associated,
               Rgb* color, std::uint8_t* alpha) {
  const int width = samples.size.width, colors = samples.color_channels(), channels = samples.channels();
  std::vector<float> packed(static_cast<std::size_t>(width) * colors);
  for (int x = 0; x < width; ++x) {
    const float* pixel = &values[static_cast<std::size_t>(x) * channels];
    float opacity = 1.0f;
    if (samples.alpha) {
      opacity = std::clamp(pixel[colors], 0.0f, 1.0f);
      alpha[x] = static_cast<std::uint8_t>(std::lround(255.0f * opacity));
    }
    const float scale = associated && opacity > 0.0f ? 1.0f / opacity : 1.0f;
    for (int c = 0; c < colors; ++c) packed[static_cast<std::size_t>(x) * colors + c] = pixel[c] * scale;
  }
  if (profile) {
    profile->convert(packed.data(), color, width);
    return;
  }
  for (int x = 0; x < width; ++x) {
    const float* pixel = &packed[static_cast<std::size_t>(x) * colors];
    color[x] = colors == 1 ? Rgb{pixel[0], pixel[0], pixel[0]} : Rgb{pixel[0], pixel[1], pixel[2]};
  }
}

void convert_samples(const Samples& samples, const ImageContainer& file, const std::string& name, LoadedImage& out) {
  const std::optional<ColorProfile> profile = choose_profile(file, samples.model, name, out.warnings);
  out.bits = samples.type == SampleType::U8 ? 8 : samples.type == SampleType::U16 ? 16 : 32;
  out.color = ColorImage(samples.size);
  if (samples.alpha) out.alpha = Mask(samples.size);
  std::vector<int> bad(samples.size.height, 0);
  parallel_for(
      samples.size.height,
      [&](int y) {
        std::vector<float> values;
        read_row(samples, y, values);
        bad[y] = clean(values);
        split_row(values, samples, profile ? &*profile : nullptr, file.associated_alpha, out.color.row(y),
                  samples.alpha ? out.alpha.row(y) : nullptr);
      },
      16);
  long long total = 0;
  for (const int count : bad) total += count;
  if (total > 0) out.warnings.push_back(std::to_string(total) + " values were not finite and became 0");
}

// The picture turned and mirrored as an Exif orientation asks for.
template <class T>
Image<T> oriented(const Image<T>& from, int orientation) {
  const bool swapped = orientation >= 5;
  const int w = from.width(), h = from.height();
  Image<T> to(swapped ? h : w, swapped ? w : h);
  for (int y = 0; y < to.height(); ++y) {
    for (int x = 0; x < to.width(); ++x) {
      int u = swapped ? y : x, v = swapped ? x : y;
      const bool mirror_u = orientation == 2 || orientation == 3 || orientation == 7 || orientation == 8;
      const bool mirror_v = orientation == 3 || orientation == 4 || orientation == 6 || orientation == 7;
      if (mirror_u) u = w - 1 - u;
      if (mirror_v) v = h - 1 - v;
      to(x, y) = from(u, v);
    }
  }
  return to;
}

LoadedImage decode_container(ImageFormat format, const std::string& bytes, const std::string& name,
                             const LoadLimits& limits) {
  LoadedImage out;
  ImageContainer file = read_container(format, bytes, name);
  check_pixels(file.size, name, limits);
  check_complete(file, name, limits);
  if (file.truncated) out.warnings.push_back("it is cut off before its end; the missing part was filled");
  out.warnings.insert(out.warnings.end(), file.warnings.begin(), file.warnings.end());
  const Samples samples = decode_samples(format, file.pixels, file.size, limits.allow_truncated, name, out.warnings);
  convert_samples(samples, file, name, out);
  if (file.orientation > 1) {
    out.color = oriented(out.color, file.orientation);
    if (!out.alpha.empty()) out.alpha = oriented(out.alpha, file.orientation);
  }
  out.texts = std::move(file.texts);
  return out;
}

}  // namespace

LoadedImage decode_image(const std::string& bytes, const std::string& path, const LoadLimits& limits) {
  const std::string name = printable(path, 300);
  const ImageFormat format = format_of_bytes(bytes);
  check_format(format, bytes, name);
  if (format == ImageFormat::Exr) check_pixels(read_exr_size(bytes, name), name, limits);
  LoadedImage out = format == ImageFormat::Exr ? decode_exr(bytes, limits.allow_truncated, name)
                                               : decode_container(format, bytes, name, limits);
  out.sha256 = sha256_hex(bytes);
  if (format_of_name(path) != format) {
    out.warnings.insert(out.warnings.begin(),
                        "it is a " + std::string(format_name(format)) + " file, whatever its name says");
  }
  return out;
}

LoadedImage load_image(const std::string& path, const LoadLimits& limits) {
  LoadedImage out = decode_image(read_file(path, limits.file_bytes), path, limits);
  const std::string recipe = recipe_path(path);
  std::error_code ignored;
  if (out.texts.count(kRecipeKey) == 0 && std::filesystem::is_regular_file(recipe, ignored)) {
    out.texts[kRecipeKey] = read_file(recipe, limits.file_bytes);
  }
  return out;
}

ScalarImage load_scalar(const std::string& path, const LoadLimits& limits) {
  const LoadedImage loaded = load_image(path, limits);
  ScalarImage out(loaded.color.size());
  std::transform(loaded.color.pixels().begin(), loaded.color.pixels().end(), out.pixels().begin(),
                 [](const Rgb& c) { return c.r == c.g && c.g == c.b ? c.r : luma(c); });  // grey stays exact
  return out;
}

Mask load_mask(const std::string& path, const LoadLimits& limits) {
  const ScalarImage values = load_scalar(path, limits);
  Mask out(values.size());
  for (std::size_t i = 0; i < out.pixels().size(); ++i) {
    out.pixels()[i] = static_cast<std::uint8_t>(std::lround(255.0f * std::clamp(values.pixels()[i], 0.0f, 1.0f)));
  }
  return out;
}

}  // namespace ramify
