// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/core/error.h"

#include <cstdint>

namespace ramify {
namespace {

// Length of the well-formed UTF-8 sequence at `i`, or 0. Overlong forms, surrogates and C1 controls do not count.
std::size_t utf8_length(const std::string& s, std::size_t i) {
  const auto byte = [&](std::size_t k) { return k < s.size() ? static_cast<unsigned char>(s[k]) : 0u; };
  const unsigned a = byte(i);
  if (a < 0x80) return 1;
  const std::size_t n = a >= 0xF0 && a < 0xF5 ? 4 : a >= 0xE0 ? 3 : a >= 0xC2 ? 2 : 0;
  if (n == 0 || a >= 0xF5) return 0;
  std::uint32_t code = a & (0xFFu >> (n + 1));
  for (std::size_t k = 1; k < n; ++k) {
    if ((byte(i + k) & 0xC0u) != 0x80u) return 0;
    code = (code << 6) | (byte(i + k) & 0x3Fu);
  }
  const bool overlong = (n == 3 && code < 0x800) || (n == 4 && code < 0x10000);
  const bool forbidden = (code >= 0xD800 && code <= 0xDFFF) || code > 0x10FFFF || code < 0xA0;
  return overlong || forbidden ? 0 : n;
}

}  // namespace

std::string printable(const std::string& text, std::size_t limit) {
  static const char* hex = "0123456789abcdef";
  std::string out;
  for (std::size_t i = 0; i < text.size();) {
    if (out.size() >= limit) return out + "…";
    const unsigned char c = static_cast<unsigned char>(text[i]);
    const std::size_t n = utf8_length(text, i);
    if (n == 0 || c < 0x20 || c == 0x7F) {
      out += "\\x";
      out += hex[c >> 4];
      out += hex[c & 15];
      ++i;
    } else {
      out += text.substr(i, n);
      i += n;
    }
  }
  return out;
}

}  // namespace ramify
