// SPDX-License-Identifier: GPL-3.0-or-later
// What a user names as an exemplar, turned into one: an annotation that names its photo, a photo with an annotation or a
// skeleton (or traced on the spot), or one of ramify's own synthetic kinds.
#pragma once

#include <string>
#include <vector>

#include "ramify/core/monitor.h"
#include "ramify/exemplar/exemplar.h"
#include "ramify/image/image_io.h"
#include "ramify/recipe/recipe.h"
#include "ramify/skeleton/skeleton_io.h"

namespace ramify {

struct ExemplarRequest {
  std::string argument;           // NAME.ramify.json, a photo, or builtin:KIND
  std::string photo;              // of an annotation; empty = looked for beside it, then in RAMIFY_PHOTOS
  std::string annotation;         // for a photo: annotation (.json), skeleton (.swc, .json) or "auto"
  std::string regions;            // grey map of roles (docs/cli.md), or empty
  bool allow_other_photo = false; // use a photo whose sha256 is not the annotation's
  LoadLimits limits;
};

struct LoadedExemplar {
  Exemplar exemplar;
  std::vector<RecipeInput> inputs;  // for the recipe
  std::vector<std::string> files;   // paths that were read: never to be overwritten
};

// Throws InputError (naming the file, and `trace` for a bare photo), LimitError.
LoadedExemplar load_exemplar(const ExemplarRequest& request, const Monitor& monitor);

// Reads a photo with its sha256, name and depth; its warnings become notes.
Photo load_photo(const std::string& path, const LoadLimits& limits, const Monitor& monitor);

// Whether the argument names one of ramify's own exemplars, "builtin:KIND".
bool is_builtin(const std::string& argument);

// Whether the file starts like a JSON object.
bool is_json_file(const std::string& path);
bool is_annotation_file(const std::string& path);

// A skeleton file of any kind, or the branches of an annotation.
LoadedSkeleton load_any_skeleton(const std::string& path);

}  // namespace ramify
