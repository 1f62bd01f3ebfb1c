// SPDX-License-Identifier: GPL-3.0-or-later
// OpenEXR files to and from memory. The file holds linear light, premultiplied with alpha; our pictures are
// sRGB-encoded and not premultiplied. Private to this layer.
#pragma once

#include <string>
#include <string_view>

#include "ramify/image/image_io.h"

namespace ramify {

// The first part's size from the header alone. Throws InputError for deep files, and for files that claim more blocks
// than they have bytes for.
Size read_exr_size(std::string_view bytes, const std::string& name);

// The first part; fills color, alpha, bits, texts and warnings. Throws InputError.
LoadedImage decode_exr(std::string_view bytes, bool allow_truncated, const std::string& name);

// bits: 16 (half) or 32. The recipe becomes a string attribute. ZIP compression.
std::string encode_exr(const ColorImage& image, const Mask* alpha, int bits, const std::string& recipe);

}  // namespace ramify
