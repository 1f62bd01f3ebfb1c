// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <cstdint>

#include "ramify/core/error.h"
#include "ramify/image/exr_codec.h"
#include "ramify/image/image_container.h"

namespace ramify {
namespace {

constexpr std::size_t kFirstHeader = 8;  // behind the magic number and the version
constexpr std::uint32_t kDeepFlag = 0x800, kMultipartFlag = 0x1000;
constexpr std::int64_t kLongestSide = 1 << 30;

// What decides how large the file claims to be.
struct Part {
  std::int64_t x0 = 0, y0 = 0, x1 = -1, y1 = -1;
  std::int64_t tile_width = 0, tile_height = 0;  // 0 = lines
  bool deep = false;
};

std::int64_t signed32(std::string_view bytes, std::size_t at) {
  return static_cast<std::int32_t>(little32(bytes, at));
}

void read_attribute(std::string_view attribute, std::string_view value, Part& part) {
  if (attribute == "dataWindow" && value.size() == 16) {
    part.x0 = signed32(value, 0), part.y0 = signed32(value, 4), part.x1 = signed32(value, 8),
    part.y1 = signed32(value, 12);
  } else if (attribute == "tiles" && value.size() == 9) {
    part.tile_width = little32(value, 0), part.tile_height = little32(value, 4);
  } else if (attribute == "type") {
    part.deep = value.starts_with("deep");
  }
}

// Reads one header from `at` and moves `at` behind it.
Part read_part(std::string_view bytes, std::size_t& at, const std::string& name) {
  const auto cut = [&] { return InputError(name, "is cut off or damaged: its OpenEXR header does not end"); };
  Part part;
  while (true) {
    const std::size_t name_end = bytes.find('\0', at);
    if (name_end == std::string_view::npos) throw cut();
    const std::string_view attribute = bytes.substr(at, name_end - at);
    at = name_end + 1;
    if (attribute.empty()) return part;
    const std::size_t type_end = bytes.find('\0', at);
    if (type_end == std::string_view::npos || bytes.size() - type_end < 5) throw cut();
    const std::size_t length = little32(bytes, type_end + 1), value = type_end + 5;
    if (length > bytes.size() - value) throw cut();
    read_attribute(attribute, bytes.substr(value, length), part);
    at = value + length;
  }
}

void check_part(const Part& part, std::size_t file_bytes, const std::string& name) {
  const std::int64_t width = part.x1 - part.x0 + 1, height = part.y1 - part.y0 + 1;
  if (part.deep) throw InputError(name, "is a deep OpenEXR picture; flatten it first");
  if (width <= 0 || height <= 0) {
    throw InputError(name, "has no pixels (" + std::to_string(width) + " x " + std::to_string(height) + ")");
  }
  if (width > kLongestSide || height > kLongestSide)
    throw InputError(name, "is not a valid OpenEXR: its size is out of range");
  // The file starts with the place of every block, 8 bytes each; a block has at most 256 lines (DWAB).
  const bool tiled = part.tile_width > 0 && part.tile_height > 0;
  const double blocks = tiled
                            ? std::ceil(double(width) / part.tile_width) * std::ceil(double(height) / part.tile_height)
                            : std::ceil(height / 256.0);
  if (8.0 * blocks > static_cast<double>(file_bytes)) {
    throw InputError(name, "is cut off or damaged: it claims " + std::to_string(width) + " x " +
                               std::to_string(height) + " pixels but has only " + std::to_string(file_bytes) +
                               " bytes");
  }
}

}  // namespace

Size read_exr_size(std::string_view bytes, const std::string& name) {
  if (bytes.size() < kFirstHeader)
    throw InputError(name, "is cut off: the file ends before the OpenEXR header is complete");
  const std::uint32_t version = little32(bytes, 4);
  if (version & kDeepFlag) throw InputError(name, "is a deep OpenEXR picture; flatten it first");
  std::size_t at = kFirstHeader;
  const Part first = read_part(bytes, at, name);
  check_part(first, bytes.size(), name);
  while ((version & kMultipartFlag) && at < bytes.size() && bytes[at] != '\0') {
    check_part(read_part(bytes, at, name), bytes.size(), name);
  }
  return {static_cast<int>(first.x1 - first.x0 + 1), static_cast<int>(first.y1 - first.y0 + 1)};
}

}  // namespace ramify
