// SPDX-License-Identifier: GPL-3.0-or-later
// A recipe inside an XMP packet (ISO 16684-1), the form in which TIFF and WebP carry text. Private to this layer.
#pragma once

#include <string>

namespace ramify {

std::string xmp_of_recipe(const std::string& recipe);  // empty for an empty recipe

// The recipe in a packet that xmp_of_recipe wrote; empty when there is none.
std::string recipe_of_xmp(const std::string& xmp);

}  // namespace ramify
