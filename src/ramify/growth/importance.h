// SPDX-License-Identifier: GPL-3.0-or-later
// What matters in a picture, as dendritic stylization sees it: edges first, then darkness (Long & Mould 2009, section 4.1;
// ALGORITHMS 8.5).
#pragma once

#include <vector>

#include "ramify/core/options.h"
#include "ramify/image/image.h"

namespace ramify {

struct ImportanceOptions {
  double edges = 3.0;     // weight of the gradient's magnitude against 1 for darkness
  double blur = 1.0;      // px, sigma of the blur before the gradient is taken
  bool light = false;     // light is important instead of dark
};
std::vector<OptionField> describe(ImportanceOptions& options);

// 0 (nothing) to 1 per pixel: (edges * G + darkness) / (edges + 1), where G is the gradient's magnitude over its 99th
// percentile, at most 1.
ScalarImage importance_map(const ColorImage& picture, const ImportanceOptions& options);

}  // namespace ramify
