// SPDX-License-Identifier: GPL-3.0-or-later
// Moving pictures: an animated WebP, which browsers and picture viewers play without a plug-in.
#pragma once

#include <functional>
#include <string>

#include "ramify/core/monitor.h"
#include "ramify/image/image.h"

namespace ramify {

struct AnimationFrame {
  ColorImage color;      // sRGB-encoded
  Mask alpha;            // straight; empty = opaque
  int milliseconds = 40;
};

struct AnimationOptions {
  int quality = 90;     // 1..100; 100 is lossless
  int loops = 0;        // 0 = for ever
  std::string recipe = {};  // JSON stored inside the file
};

// The file's bytes. Frames are asked for in order, one at a time. All must have this size, at most 16383 px a side.
// Throws LimitError for larger ones, OutputError when libwebp fails.
std::string encode_animation(Size size, int count, const std::function<AnimationFrame(int)>& frame,
                             const AnimationOptions& options, const Monitor& monitor);

}  // namespace ramify
