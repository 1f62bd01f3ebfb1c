// SPDX-License-Identifier: GPL-3.0-or-later
// From a picture to the same overgrown with moss: what `moss` and its replay call.
#pragma once

#include <string>
#include <vector>

#include "ramify/growth/moss.h"
#include "ramify/image/image_io.h"
#include "ramify/recipe/recipe.h"

namespace ramify {

struct MossPainting {
  MossOptions moss;
  std::string background = "#10120c";  // what shows between hairs; a colour, or none = transparent
  double scale = 1.0;                  // result px per px of the picture
};
std::vector<OptionField> describe(MossPainting& options);

struct MossRequest {
  std::string picture;
  MossPainting options;
  LoadLimits limits;
};

// Reads the picture, grows its moss and writes `output` (.svg or a picture) with its recipe. Throws InputError, OptionError,
// LimitError, OutputError.
void paint_moss(const MossRequest& request, std::uint64_t seed, const std::string& output, const Monitor& monitor);

MossRequest moss_from_recipe(const Recipe& recipe, const std::vector<std::string>& folders);

}  // namespace ramify
