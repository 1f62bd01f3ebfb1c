// SPDX-License-Identifier: GPL-3.0-or-later
#include <openssl/sha.h>

#include <array>

#include "ramify/image/image_io.h"

namespace ramify {

std::string sha256_hex(const std::string& bytes) {
  static const char* digits = "0123456789abcdef";
  std::array<unsigned char, SHA256_DIGEST_LENGTH> digest;
  SHA256(reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size(), digest.data());
  std::string hex;
  for (const unsigned char byte : digest) {
    hex += digits[byte >> 4];
    hex += digits[byte & 15];
  }
  return hex;
}

}  // namespace ramify
