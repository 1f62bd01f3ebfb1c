// SPDX-License-Identifier: GPL-3.0-or-later
// What a picture file says before a pixel is decoded: size, orientation, colour profile, texts. Each reader walks the
// file's own structure (chunks, segments, directories), so that limits hold before any memory is spent, cut files are
// recognised, and compressed metadata cannot blow up: what the pixel decoder gets holds pixels and nothing else.
//
// Sources: PNG 1.2 specification; ITU T.81 annex B; TIFF 6.0 and BigTIFF; WebP container specification; Exif 2.32.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "ramify/core/types.h"

namespace ramify {

struct ImageContainer {
  Size size;                                 // px, before orientation
  int orientation = 1;                       // Exif 1..8
  std::string pixels;                        // the file without metadata, for the decoder
  std::string profile;                       // ICC, empty when there is none
  bool associated_alpha = false;             // colours are multiplied with alpha (TIFF)
  bool truncated = false;                    // the file ends before its structure does
  std::map<std::string, std::string> texts;  // UTF-8
  std::vector<std::string> warnings;
};

// Each throws InputError when the structure is broken in another way than by being cut off.
ImageContainer read_png_container(std::string_view bytes, const std::string& name);
ImageContainer read_jpeg_container(std::string_view bytes, const std::string& name);
ImageContainer read_tiff_container(std::string_view bytes, const std::string& name);
ImageContainer read_webp_container(std::string_view bytes, const std::string& name);

// The orientation in an Exif block (which starts with a TIFF header), 1 when there is none or it makes no sense.
int exif_orientation(std::string_view exif);

// Big- and little-endian numbers; the caller has checked that they lie inside.
inline std::uint32_t byte_at(std::string_view bytes, std::size_t at) {
  return static_cast<unsigned char>(bytes[at]);
}
inline std::uint32_t big16(std::string_view b, std::size_t at) {
  return (byte_at(b, at) << 8) | byte_at(b, at + 1);
}
inline std::uint32_t big32(std::string_view b, std::size_t at) {
  return (big16(b, at) << 16) | big16(b, at + 2);
}
inline std::uint32_t little16(std::string_view b, std::size_t at) {
  return (byte_at(b, at + 1) << 8) | byte_at(b, at);
}
inline std::uint32_t little32(std::string_view b, std::size_t at) {
  return (little16(b, at + 2) << 16) | little16(b, at);
}

// Our own text inside pictures: the recipe under this name (texts["ramify-recipe"]).
inline constexpr const char* kRecipeKey = "ramify-recipe";

// `png` with an sRGB chunk and, unless `text` is empty, an iTXt chunk (UTF-8, not compressed) after the header.
std::string png_with_text(const std::string& png, const std::string& key, const std::string& text);

}  // namespace ramify
