// SPDX-License-Identifier: GPL-3.0-or-later
// The size of what is made, as users write it, against what is allowed.
#pragma once

#include <string>

#include "ramify/image/image_io.h"

namespace ramify {

// "1600x1076" in px. Throws OptionError for --size.
Size parse_canvas(const std::string& text);

// Throws LimitError that names the memory needed, at `bytes_per_pixel` for all that the work keeps.
void check_canvas(Size size, const LoadLimits& limits, int bytes_per_pixel = 120);

}  // namespace ramify
