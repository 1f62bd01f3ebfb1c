// SPDX-License-Identifier: GPL-3.0-or-later
// The main road: exemplar -> style -> skeleton -> picture. What `synth`, `grow`, `render` and `replay` call.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "ramify/compose/scene.h"
#include "ramify/core/monitor.h"
#include "ramify/growth/grow.h"
#include "ramify/recipe/exemplar_source.h"
#include "ramify/recipe/foreign_skeleton.h"
#include "ramify/recipe/recipe.h"
#include "ramify/skeleton/skeleton.h"
#include "ramify/style/style.h"

namespace ramify {

struct StageOptions {
  LearnStyleOptions learn;
  GrowOptions grow;
  SkeletonFitOptions fit;     // render only
  ComposeOptions compose;
  std::string size;   // "WIDTHxHEIGHT" px; empty = the exemplar's, for render the skeleton's
  std::string roots;  // "x,y[,direction_deg[,radius]] …" px; empty = the style's own
  int depth = 0;      // bits a channel of the picture; 0 = the photo's
};
std::vector<OptionField> describe(StageOptions& options);

struct PictureRequest {
  std::string verb = "synth";  // synth, grow or render
  ExemplarRequest exemplar;
  std::string density;         // painted map, or empty
  std::string guide;           // .svg path or picture, or empty
  std::string skeleton;        // render only
  StageOptions options;
  LoadLimits limits;
};

// Everything a request names, read and checked, and all that does not depend on the seed.
struct LoadedRequest {
  PictureRequest request;
  LoadedExemplar source;
  GrowthTarget target;                // size, roots, density, guide
  std::optional<Skeleton> skeleton;   // render only: fitted to the exemplar but for its bends
  Style style;                        // synth, grow, and render that restyles
  ComposeScene scene;                 // synth and render; for grow its habitat alone
  std::vector<RecipeInput> inputs;
  std::vector<std::string> files;     // paths that were read
};

struct Picture {
  Skeleton skeleton;
  Composite composite;  // synth and render
  Recipe recipe;
};

// Checks what can be checked before anything is read: option ranges, the form of sizes and roots.
void check_request(PictureRequest& request);

LoadedRequest load_request(const PictureRequest& request, const Monitor& monitor);

// Deterministic in (request, seed).
Picture make_picture(const LoadedRequest& loaded, std::uint64_t seed, const Monitor& monitor);

// The recipe stored in a picture, in its .recipe.json, or in a file of its own.
Recipe load_recipe(const std::string& path, const LoadLimits& limits);

// Finds the inputs by their sha256 in `folders` and in RAMIFY_PHOTOS and sets every option. Throws InputError.
PictureRequest request_from_recipe(const Recipe& recipe, const std::vector<std::string>& folders);

// load_request of a recipe's request. What is made of it carries the recipe's own inputs, so that the bytes are the same
// although the files may have other names by now.
LoadedRequest load_recipe_request(const Recipe& recipe, const std::vector<std::string>& folders, const LoadLimits& limits,
                                  const Monitor& monitor);

}  // namespace ramify
