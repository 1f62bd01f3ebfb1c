// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/image/image_format.h"

#include <algorithm>
#include <array>
#include <cctype>

namespace ramify {
namespace {

using namespace std::string_view_literals;

struct Magic {
  std::size_t offset;
  std::string_view bytes;
  std::string_view meaning;
};

// Formats people do hand in by mistake. The first that fits wins.
constexpr std::array kForeign{
    Magic{0, "GIF87a"sv, "a GIF picture"},
    Magic{0, "GIF89a"sv, "a GIF picture"},
    Magic{0, "BM"sv, "a BMP picture"},
    Magic{0, "%PDF"sv, "a PDF document"},
    Magic{0, "%!PS"sv, "a PostScript document"},
    Magic{0, "PK\x03\x04"sv, "a ZIP archive (or an office document)"},
    Magic{0, "\x1f\x8b"sv, "a gzip archive"},
    Magic{0, "7z\xbc\xaf\x27\x1c"sv, "a 7-Zip archive"},
    Magic{0,
          "\xfd"
          "7zXZ"sv,
          "an xz archive"},
    Magic{0, "8BPS"sv, "a Photoshop document"},
    Magic{0, "\xff\x0a"sv, "a JPEG XL picture"},
    Magic{4, "JXL "sv, "a JPEG XL picture"},
    Magic{4, "jP  "sv, "a JPEG 2000 picture"},
    Magic{4, "ftypavif"sv, "an AVIF picture"},
    Magic{4, "ftypheic"sv, "a HEIC picture"},
    Magic{4, "ftypmif1"sv, "a HEIF picture"},
    Magic{4, "ftyp"sv, "a video"},
    Magic{0, "#?RADIANCE"sv, "a Radiance HDR picture"},
    Magic{0,
          "\x7f"
          "ELF"sv,
          "a program"},
    Magic{0, "version https://git-lfs"sv, "a Git LFS pointer, not the file it stands for"},
};

bool starts_with_at(std::string_view bytes, std::size_t offset, std::string_view magic) {
  return bytes.size() >= offset + magic.size() && bytes.substr(offset, magic.size()) == magic;
}

std::string lower(std::string_view text) {
  std::string out(text);
  std::transform(out.begin(), out.end(), out.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return out;
}

}  // namespace

ImageFormat format_of_bytes(std::string_view bytes) {
  if (starts_with_at(bytes, 0, "\x89PNG\r\n\x1a\n"sv)) return ImageFormat::Png;
  if (starts_with_at(bytes, 0, "\xff\xd8\xff"sv)) return ImageFormat::Jpeg;
  for (const std::string_view magic : {"II*\0"sv, "MM\0*"sv, "II+\0"sv, "MM\0+"sv}) {
    if (starts_with_at(bytes, 0, magic)) return ImageFormat::Tiff;
  }
  if (starts_with_at(bytes, 0, "\x76\x2f\x31\x01"sv)) return ImageFormat::Exr;
  if (starts_with_at(bytes, 0, "RIFF"sv) && starts_with_at(bytes, 8, "WEBP"sv)) return ImageFormat::Webp;
  return ImageFormat::Unknown;
}

ImageFormat format_of_name(std::string_view path) {
  const std::size_t dot = path.rfind('.');
  if (dot == std::string_view::npos || path.find('/', dot) != std::string_view::npos) return ImageFormat::Unknown;
  const std::string extension = lower(path.substr(dot + 1));
  if (extension == "png") return ImageFormat::Png;
  if (extension == "jpg" || extension == "jpeg") return ImageFormat::Jpeg;
  if (extension == "tif" || extension == "tiff") return ImageFormat::Tiff;
  if (extension == "exr") return ImageFormat::Exr;
  if (extension == "webp") return ImageFormat::Webp;
  return ImageFormat::Unknown;
}

const char* format_name(ImageFormat format) {
  switch (format) {
    case ImageFormat::Png:
      return "PNG";
    case ImageFormat::Jpeg:
      return "JPEG";
    case ImageFormat::Tiff:
      return "TIFF";
    case ImageFormat::Exr:
      return "OpenEXR";
    case ImageFormat::Webp:
      return "WebP";
    case ImageFormat::Unknown:
      break;
  }
  return "unknown";
}

std::string describe_content(std::string_view bytes) {
  for (const Magic& magic : kForeign) {
    if (starts_with_at(bytes, magic.offset, magic.bytes)) return std::string(magic.meaning);
  }
  const std::string head = lower(bytes.substr(0, 1024));
  if (head.find("<svg") != std::string::npos) return "an SVG drawing";
  if (head.find("<html") != std::string::npos || head.find("<!doctype html") != std::string::npos)
    return "an HTML page";
  if (head.starts_with("<?xml")) return "an XML document";
  if (!head.empty() && (head[0] == '{' || head[0] == '[')) return "JSON text";
  const bool text =
      std::all_of(head.begin(), head.end(), [](unsigned char c) { return c >= 0x20 || (c >= 9 && c <= 13); });
  return text ? "text" : "binary data of an unknown kind";
}

}  // namespace ramify
