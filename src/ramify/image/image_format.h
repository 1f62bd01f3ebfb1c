// SPDX-License-Identifier: GPL-3.0-or-later
// What kind of picture file this is: by its first bytes when reading, by the extension of the name when writing.
#pragma once

#include <string>
#include <string_view>

namespace ramify {

enum class ImageFormat { Unknown, Png, Jpeg, Tiff, Exr, Webp };

ImageFormat format_of_bytes(std::string_view bytes);
ImageFormat format_of_name(std::string_view path);  // Unknown when the extension is none of ours

const char* format_name(ImageFormat format);  // "PNG"

// What the bytes look like when they are none of our formats: "an HTML page", "a ZIP archive", "text", "binary data".
std::string describe_content(std::string_view bytes);

}  // namespace ramify
