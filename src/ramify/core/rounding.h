// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cmath>

namespace ramify {

// std::lround for what lies within the range of int, without a call into the library, which costs as much as reading a pixel.
inline int round_to_int(double v) { return static_cast<int>(v + std::copysign(0.49999999999999994, v)); }

}  // namespace ramify
