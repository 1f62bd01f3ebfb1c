// SPDX-License-Identifier: GPL-3.0-or-later
#include <optional>

#include "ramify/core/error.h"
#include "ramify/image/image_container.h"

namespace ramify {
namespace {

using namespace std::string_view_literals;

constexpr unsigned kStartOfImage = 0xD8, kEndOfImage = 0xD9, kStartOfScan = 0xDA, kApp0 = 0xE0, kApp1 = 0xE1,
                   kApp2 = 0xE2, kApp14 = 0xEE, kApp15 = 0xEF, kComment = 0xFE;

bool stands_alone(unsigned marker) {
  return marker == 0x01 || (marker >= 0xD0 && marker <= 0xD7);
}

bool is_frame_header(unsigned marker) {
  return marker >= 0xC0 && marker <= 0xCF && marker != 0xC4 && marker != 0xC8 && marker != 0xCC;
}

// The pieces of a profile that is spread over several APP2 segments, by their number.
struct ProfilePieces {
  std::map<unsigned, std::string> pieces;
  unsigned expected = 0;
};

void read_metadata(unsigned marker, std::string_view data, ImageContainer& out, ProfilePieces& profile) {
  constexpr std::string_view kIcc = "ICC_PROFILE\0"sv, kExif = "Exif\0\0"sv;
  if (marker == kApp1 && data.starts_with(kExif)) out.orientation = exif_orientation(data.substr(kExif.size()));
  if (marker == kApp2 && data.starts_with(kIcc) && data.size() > kIcc.size() + 2) {
    profile.expected = static_cast<unsigned char>(data[kIcc.size() + 1]);
    profile.pieces[static_cast<unsigned char>(data[kIcc.size()])] = data.substr(kIcc.size() + 2);
  }
}

Size read_frame_header(std::string_view data, const std::string& name) {
  if (data.size() < 6) throw InputError(name, "is not a valid JPEG: its frame header is too short");
  const int height = static_cast<int>(big16(data, 1)), width = static_cast<int>(big16(data, 3));
  if (width == 0 || height == 0) {
    throw InputError(name, "has no pixels (" + std::to_string(width) + " x " + std::to_string(height) + ")");
  }
  return {width, height};
}

// The first position at or after `at` where a marker follows compressed data; the file's size when there is none.
std::size_t end_of_scan(std::string_view bytes, std::size_t at) {
  for (; at + 1 < bytes.size(); ++at) {
    const unsigned next = static_cast<unsigned char>(bytes[at + 1]);
    if (bytes[at] == '\xff' && next != 0x00 && next != 0xFF && !stands_alone(next)) return at;
  }
  return bytes.size();
}

struct Segment {
  unsigned marker = 0;
  std::string_view whole, data;  // a scan's compressed data belongs to `whole`
};

// The segment at or after `at`, which moves behind it; nothing when the file ends before it does. Stray bytes between
// segments are skipped, as libjpeg does.
std::optional<Segment> next_segment(std::string_view bytes, std::size_t& at, const std::string& name) {
  for (; at + 2 <= bytes.size(); ++at) {
    const unsigned marker = byte_at(bytes, at + 1);
    if (bytes[at] != '\xff' || marker == 0xFF || marker == 0x00 || marker == kStartOfImage || stands_alone(marker))
      continue;
    if (marker == kEndOfImage) return Segment{marker, {}, {}};
    if (at + 4 > bytes.size()) return std::nullopt;
    const std::size_t length = big16(bytes, at + 2);
    if (length < 2) throw InputError(name, "is not a valid JPEG: an empty segment at byte " + std::to_string(at));
    if (at + 2 + length > bytes.size()) return std::nullopt;
    const std::size_t begin = at;
    at = marker == kStartOfScan ? end_of_scan(bytes, begin + 2 + length) : begin + 2 + length;
    return Segment{marker, bytes.substr(begin, at - begin), bytes.substr(begin + 4, length - 2)};
  }
  return std::nullopt;
}

bool is_metadata(unsigned marker) {
  return marker == kComment || (marker >= kApp0 && marker <= kApp15 && marker != kApp0 && marker != kApp14);
}

}  // namespace

ImageContainer read_jpeg_container(std::string_view bytes, const std::string& name) {
  ImageContainer out;
  ProfilePieces profile;
  out.pixels = bytes.substr(0, 2);
  std::size_t at = 2;
  std::optional<Segment> segment;
  while ((segment = next_segment(bytes, at, name)) && segment->marker != kEndOfImage) {
    if (is_frame_header(segment->marker) && out.size.width == 0) out.size = read_frame_header(segment->data, name);
    if (is_metadata(segment->marker)) {
      read_metadata(segment->marker, segment->data, out, profile);
    } else {
      out.pixels += segment->whole;
    }
  }
  out.truncated = !segment;
  if (out.size.width == 0) throw InputError(name, "is cut off: the file ends before the JPEG header is complete");
  out.pixels += "\xff\xd9";
  if (profile.pieces.size() == profile.expected) {
    for (const auto& [number, piece] : profile.pieces) out.profile += piece;
  } else {
    out.warnings.push_back("parts of its colour profile are missing; sRGB was assumed");
  }
  return out;
}

}  // namespace ramify
