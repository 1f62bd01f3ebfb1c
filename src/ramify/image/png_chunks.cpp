// SPDX-License-Identifier: GPL-3.0-or-later
#include <zlib.h>

#include <array>

#include "ramify/core/error.h"
#include "ramify/image/image_container.h"

namespace ramify {
namespace {

constexpr std::size_t kSignature = 8;
constexpr std::size_t kFrame = 12;                // length, type and checksum around a chunk's data
constexpr std::size_t kInflateLimit = 10u << 20;  // bytes of one text or profile, as OpenImageIO allows

struct Chunk {
  std::string_view type;
  std::string_view data;
};

std::uint32_t chunk_crc(std::string_view type_and_data) {
  return static_cast<std::uint32_t>(
      crc32_z(0, reinterpret_cast<const Bytef*>(type_and_data.data()), type_and_data.size()));
}

void put_big32(std::string& out, std::uint32_t value) {
  for (int shift = 24; shift >= 0; shift -= 8) out += static_cast<char>((value >> shift) & 0xFF);
}

void put_chunk(std::string& out, std::string_view type, std::string_view data) {
  put_big32(out, static_cast<std::uint32_t>(data.size()));
  std::string body(type);
  body += data;
  out += body;
  put_big32(out, chunk_crc(body));
}

// False when the data is broken or larger than the limit.
bool inflate_limited(std::string_view packed, std::string& out) {
  z_stream stream{};
  if (inflateInit(&stream) != Z_OK) return false;
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(packed.data()));
  stream.avail_in = static_cast<uInt>(packed.size());
  std::array<char, 1 << 14> buffer;
  int state = Z_OK;
  while (state == Z_OK && out.size() <= kInflateLimit) {
    stream.next_out = reinterpret_cast<Bytef*>(buffer.data());
    stream.avail_out = static_cast<uInt>(buffer.size());
    state = inflate(&stream, Z_NO_FLUSH);
    out.append(buffer.data(), buffer.size() - stream.avail_out);
  }
  inflateEnd(&stream);
  return state == Z_STREAM_END && out.size() <= kInflateLimit;
}

std::string utf8_from_latin1(std::string_view text) {
  std::string out;
  for (const unsigned char c : text) {
    if (c < 0x80) {
      out += static_cast<char>(c);
    } else {
      out += static_cast<char>(0xC0 | (c >> 6));
      out += static_cast<char>(0x80 | (c & 0x3F));
    }
  }
  return out;
}

// Cuts `rest` behind its first NUL and returns what stood before it; false without a NUL.
bool take_field(std::string_view& rest, std::string& field) {
  const std::size_t end = rest.find('\0');
  if (end == std::string_view::npos) return false;
  field = rest.substr(0, end);
  rest.remove_prefix(end + 1);
  return true;
}

// tEXt, zTXt, iTXt. False when it cannot be read.
bool read_text(const Chunk& chunk, std::map<std::string, std::string>& texts) {
  std::string_view rest = chunk.data;
  std::string key, text, ignored;
  if (!take_field(rest, key) || key.empty() || key.size() > 79) return false;
  bool packed = chunk.type == "zTXt";
  const bool international = chunk.type == "iTXt";
  if (packed && (rest.empty() || rest[0] != 0)) return false;
  if (packed) rest.remove_prefix(1);
  if (international) {
    if (rest.size() < 2) return false;
    packed = rest[0] == 1;
    rest.remove_prefix(2);
    if (!take_field(rest, ignored) || !take_field(rest, ignored)) return false;  // language, translated key
  }
  if (packed && !inflate_limited(rest, text)) return false;
  if (!packed) text = rest;
  texts[utf8_from_latin1(key)] = international ? text : utf8_from_latin1(text);
  return true;
}

bool read_profile(std::string_view data, std::string& profile) {
  std::string name;
  if (!take_field(data, name) || data.empty() || data[0] != 0) return false;
  data.remove_prefix(1);
  return inflate_limited(data, profile);
}

Size read_header(std::string_view data, const std::string& name) {
  if (data.size() != 13) throw InputError(name, "is not a valid PNG: its header has the wrong length");
  const std::uint32_t width = big32(data, 0), height = big32(data, 4);
  if (width == 0 || height == 0)
    throw InputError(name, "has no pixels (" + std::to_string(width) + " x " + std::to_string(height) + ")");
  if (width > 0x7FFFFFFFu || height > 0x7FFFFFFFu)
    throw InputError(name, "is not a valid PNG: its size is out of range");
  return {static_cast<int>(width), static_cast<int>(height)};
}

// What stands beside the pixels. Anything that cannot be read is left out with a warning.
void read_metadata(const Chunk& chunk, ImageContainer& out) {
  bool fine = true;
  if (chunk.type == "tEXt" || chunk.type == "zTXt" || chunk.type == "iTXt") fine = read_text(chunk, out.texts);
  if (chunk.type == "eXIf") out.orientation = exif_orientation(chunk.data);
  if (chunk.type == "iCCP" && !read_profile(chunk.data, out.profile)) {
    fine = false;
    out.profile.clear();
  }
  if (!fine) {
    out.warnings.push_back("its " + std::string(chunk.type) + " block is broken or unpacks to more than " +
                           std::to_string(kInflateLimit >> 20) + " MB; it was ignored");
  }
}

}  // namespace

ImageContainer read_png_container(std::string_view bytes, const std::string& name) {
  ImageContainer out;
  out.pixels = bytes.substr(0, kSignature);
  out.truncated = true;
  std::size_t at = kSignature;
  while (at + kFrame <= bytes.size()) {
    const std::size_t length = big32(bytes, at);
    const Chunk chunk{bytes.substr(at + 4, 4), bytes.substr(at + 8, length)};
    const bool first = out.size.width == 0;
    if (first != (chunk.type == "IHDR"))
      throw InputError(name, "is not a valid PNG: it must have one header at its start");
    if (length > bytes.size() - at - kFrame) {  // keep what is there of the pixels, for allow_truncated
      if (chunk.type == "IDAT") put_chunk(out.pixels, chunk.type, chunk.data);
      break;
    }
    if (chunk_crc(bytes.substr(at + 4, 4 + length)) != big32(bytes, at + 8 + length)) {
      throw InputError(name, "is damaged: the checksum of its block '" + printable(std::string(chunk.type)) +
                                 "' at byte " + std::to_string(at) + " is wrong");
    }
    if (first) out.size = read_header(chunk.data, name);
    if (chunk.type == "IHDR" || chunk.type == "PLTE" || chunk.type == "tRNS" || chunk.type == "IDAT") {
      put_chunk(out.pixels, chunk.type, chunk.data);
    } else {
      read_metadata(chunk, out);
    }
    if (chunk.type == "IEND") {
      out.truncated = false;
      break;
    }
    at += kFrame + length;
  }
  if (out.size.width == 0) throw InputError(name, "is cut off: the file ends before the PNG header is complete");
  put_chunk(out.pixels, "IEND", "");
  return out;
}

std::string png_with_text(const std::string& png, const std::string& key, const std::string& text) {
  const std::size_t header_end = kSignature + kFrame + 13;
  std::string out = png.substr(0, header_end);
  put_chunk(out, "sRGB", std::string_view("\0", 1));  // perceptual intent
  if (!text.empty()) {
    const std::string plain(5, '\0');  // end of the key, not compressed, method 0, no language, no translated key
    put_chunk(out, "iTXt", key + plain + text);
  }
  out.append(png, header_end);
  return out;
}

}  // namespace ramify
