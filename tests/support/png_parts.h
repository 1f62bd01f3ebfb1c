// SPDX-License-Identifier: GPL-3.0-or-later
// PNG files put together by hand, right or wrong as a test wants them.
#pragma once

#include <zlib.h>

#include <string>

inline std::string big_endian(std::uint32_t value) {
  std::string out;
  for (int shift = 24; shift >= 0; shift -= 8) out += static_cast<char>((value >> shift) & 0xFF);
  return out;
}

inline std::string png_chunk(const std::string& type, const std::string& data) {
  const std::string body = type + data;
  const auto crc = crc32(0, reinterpret_cast<const Bytef*>(body.data()), static_cast<uInt>(body.size()));
  return big_endian(static_cast<std::uint32_t>(data.size())) + body + big_endian(static_cast<std::uint32_t>(crc));
}

// zlib data of `count` zero bytes, made piece by piece.
inline std::string deflated_zeros(std::size_t count) {
  z_stream stream{};
  deflateInit(&stream, 9);
  std::string zeros(1 << 16, '\0'), buffer(1 << 16, '\0'), out;
  for (bool last = false; !last;) {
    const std::size_t n = std::min(count, zeros.size());
    count -= n;
    last = count == 0;
    stream.next_in = reinterpret_cast<Bytef*>(zeros.data());
    stream.avail_in = static_cast<uInt>(n);
    do {
      stream.next_out = reinterpret_cast<Bytef*>(buffer.data());
      stream.avail_out = static_cast<uInt>(buffer.size());
      deflate(&stream, last ? Z_FINISH : Z_NO_FLUSH);
      out.append(buffer.data(), buffer.size() - stream.avail_out);
    } while (stream.avail_out == 0);
  }
  deflateEnd(&stream);
  return out;
}

inline const std::string kPngSignature("\x89PNG\r\n\x1a\n");

inline std::string png_header(std::uint32_t width, std::uint32_t height, int bits, int color) {
  return kPngSignature + png_chunk("IHDR", big_endian(width) + big_endian(height) + static_cast<char>(bits) +
                                               static_cast<char>(color) + std::string(3, '\0'));
}

// A black grey PNG with `extra` chunks behind the header.
inline std::string black_png(std::uint32_t width, std::uint32_t height, int bits, const std::string& extra = "") {
  return png_header(width, height, bits, 0) + extra +
         png_chunk("IDAT", deflated_zeros((std::size_t{width} * bits + 7) / 8 * height + height)) +
         png_chunk("IEND", "");
}

// `png` with a chunk put behind its header.
inline std::string with_chunk(const std::string& png, const std::string& chunk) {
  return png.substr(0, 33) + chunk + png.substr(33);
}
