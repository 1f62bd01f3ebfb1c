// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/image/image_container.h"

namespace ramify {
namespace {

unsigned byte_at(std::string_view bytes, std::size_t at) { return static_cast<unsigned char>(bytes[at]); }

}  // namespace

std::uint32_t big16(std::string_view b, std::size_t at) { return (byte_at(b, at) << 8) | byte_at(b, at + 1); }
std::uint32_t little16(std::string_view b, std::size_t at) { return (byte_at(b, at + 1) << 8) | byte_at(b, at); }
std::uint32_t big32(std::string_view b, std::size_t at) { return (big16(b, at) << 16) | big16(b, at + 2); }
std::uint32_t little32(std::string_view b, std::size_t at) { return (little16(b, at + 2) << 16) | little16(b, at); }

int exif_orientation(std::string_view exif) {
  constexpr std::uint32_t kOrientation = 0x0112, kShort = 3;
  if (exif.size() < 10) return 1;
  const bool big = exif.substr(0, 2) == "MM";
  if (!big && exif.substr(0, 2) != "II") return 1;
  const auto read16 = [&](std::size_t at) { return big ? big16(exif, at) : little16(exif, at); };
  const auto read32 = [&](std::size_t at) { return big ? big32(exif, at) : little32(exif, at); };
  const std::size_t directory = read32(4);
  if (directory > exif.size() - 2) return 1;
  const std::size_t count = read16(directory);
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t entry = directory + 2 + 12 * i;
    if (entry + 12 > exif.size()) return 1;
    if (read16(entry) != kOrientation || read16(entry + 2) != kShort) continue;
    const int value = static_cast<int>(read16(entry + 8));
    return value >= 1 && value <= 8 ? value : 1;
  }
  return 1;
}

}  // namespace ramify
