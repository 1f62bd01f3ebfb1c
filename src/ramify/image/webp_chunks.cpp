// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>

#include "ramify/core/error.h"
#include "ramify/image/image_container.h"
#include "ramify/image/recipe_xmp.h"

namespace ramify {
namespace {

constexpr std::size_t kRiffHeader = 12;
constexpr unsigned kHasProfile = 0x20, kHasExif = 0x08, kHasXmp = 0x04, kIsAnimated = 0x02;

void put_little32(std::string& out, std::size_t value) {
  for (int shift = 0; shift < 32; shift += 8) out += static_cast<char>((value >> shift) & 0xFF);
}

void put_chunk(std::string& out, std::string_view type, std::string_view data) {
  out += type;
  put_little32(out, data.size());
  out += data;
  if (data.size() % 2) out += '\0';
}

// The size a pixel chunk claims; 0 x 0 for other chunks and for headers too short to say.
Size size_in(std::string_view type, std::string_view data) {
  if (type == "VP8X" && data.size() >= 10) {
    return {static_cast<int>(1 + (little32(data, 4) & 0xFFFFFF)), static_cast<int>(1 + (little32(data, 6) >> 8))};
  }
  if (type == "VP8 " && data.size() >= 10) {
    return {static_cast<int>(little16(data, 6) & 0x3FFF), static_cast<int>(little16(data, 8) & 0x3FFF)};
  }
  if (type == "VP8L" && data.size() >= 5) {
    const std::uint32_t packed = little32(data, 1);
    return {static_cast<int>(1 + (packed & 0x3FFF)), static_cast<int>(1 + ((packed >> 14) & 0x3FFF))};
  }
  return {};
}

// The extended header without the flags of what we take out.
std::string plain_header(std::string_view data, ImageContainer& out) {
  std::string header(data);
  const unsigned flags = static_cast<unsigned char>(header[0]);
  if (flags & kIsAnimated) out.warnings.push_back("it is an animation; its first picture was used");
  header[0] = static_cast<char>(flags & ~(kHasProfile | kHasExif | kHasXmp));
  return header;
}

void read_chunk(std::string_view type, std::string_view data, ImageContainer& out, std::string& pixels) {
  if (type == "ICCP") {
    out.profile = data;
  } else if (type == "EXIF") {
    out.orientation =
        exif_orientation(data.starts_with("Exif") ? data.substr(std::min<std::size_t>(6, data.size())) : data);
  } else if (type == "XMP ") {
    const std::string recipe = recipe_of_xmp(std::string(data));
    if (!recipe.empty()) out.texts[kRecipeKey] = recipe;
  } else if (type == "VP8X" && !data.empty()) {
    put_chunk(pixels, type, plain_header(data, out));
  } else {
    put_chunk(pixels, type, data);
  }
}

}  // namespace

ImageContainer read_webp_container(std::string_view bytes, const std::string& name) {
  ImageContainer out;
  const std::size_t claimed = 8 + std::size_t{little32(bytes, 4)};
  out.truncated = claimed > bytes.size();
  const std::size_t end = std::min(claimed, bytes.size());
  std::string pixels;
  for (std::size_t at = kRiffHeader; at + 8 <= end;) {
    const std::string_view type = bytes.substr(at, 4);
    const std::size_t length = little32(bytes, at + 4), rest = end - at - 8;
    out.truncated = out.truncated || length > rest;
    const std::string_view data = bytes.substr(at + 8, std::min(length, rest));
    if (out.size.width == 0) out.size = size_in(type, data);
    read_chunk(type, data, out, pixels);
    at += 8 + std::min(length, rest) + length % 2;
  }
  if (out.size.width == 0 || out.size.height == 0) {
    throw InputError(name, out.truncated ? "is cut off: the file ends before the WebP header is complete"
                                         : "is not a valid WebP: it holds no picture");
  }
  out.pixels = "RIFF";
  put_little32(out.pixels, 4 + pixels.size());
  out.pixels += "WEBP" + pixels;
  return out;
}

}  // namespace ramify
