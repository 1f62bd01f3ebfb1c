// SPDX-License-Identifier: GPL-3.0-or-later
// `compare A B`: what two files name (exemplar, picture with recipe, skeleton), measured against each other.
#pragma once

#include <string>
#include <vector>

#include "ramify/core/monitor.h"
#include "ramify/image/image_io.h"

namespace ramify {

struct ComparisonRequest {
  std::string first;   // the measure: exemplar, picture with recipe, or skeleton
  std::string second;  // what is judged
  std::vector<std::string> inputs;  // further folders where the inputs of a picture's recipe may lie
  LoadLimits limits;
};

// The bytes of the report `path` names by its ending (.html .svg .json). A picture's skeleton is grown again from its
// recipe, whose inputs are looked for beside it, beside `first` and in `inputs`. Throws InputError.
std::string comparison_text(const ComparisonRequest& request, const std::string& path, const Monitor& monitor);

}  // namespace ramify
