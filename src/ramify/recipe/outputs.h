// SPDX-License-Identifier: GPL-3.0-or-later
// Writes what a picture consists of: the picture with its recipe inside, skeleton, exact masks, report, intermediates.
#pragma once

#include <string>

#include "ramify/core/monitor.h"
#include "ramify/recipe/pipeline.h"

namespace ramify {

struct PictureFiles {
  std::string picture;       // for grow: the skeleton
  std::string skeleton;      // each may be empty
  std::string mask;
  std::string radius;
  std::string report;
  std::string debug_folder;
};

void save_picture(const LoadedRequest& loaded, const Picture& picture, const PictureFiles& files, const Monitor& monitor);

}  // namespace ramify
