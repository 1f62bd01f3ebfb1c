// SPDX-License-Identifier: GPL-3.0-or-later
// From a skeleton's file to a painting's: what `paint` and its replay call.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "ramify/core/monitor.h"
#include "ramify/image/image_io.h"
#include "ramify/paint/paint.h"
#include "ramify/recipe/recipe.h"

namespace ramify {

struct PaintingOptions {
  PaintOptions paint;
  std::string size;       // "WIDTHxHEIGHT" px; the canvas is fitted into it; empty = canvas times scale
  double scale = 1.0;     // picture px per canvas px
  std::string at;         // "x,y" px of the photo where the first root stands; empty = the canvas is fitted into the photo
  double soften = 0.0;    // px of the picture, sigma: as soft as the painting it stands in
  int depth = 8;          // bits a channel
  double growth = 1.0;    // 0..1, the moment that is drawn
  bool animate = false;   // every moment
  int frames = 60;
  double fps = 25.0;      // frames a second
  double hold = 1.5;      // s, how long an animation shows the finished painting
};
std::vector<OptionField> describe(PaintingOptions& options);

struct PaintingRequest {
  std::string skeleton;  // skeleton or annotation
  std::string over;      // photo to paint on, or empty
  std::string fill;      // picture of the canvas that shows through the branches, or empty
  std::vector<std::string> behind;  // skeletons on the same canvas, painted first, the farthest at the front
  PaintingOptions options;
  LoadLimits limits;
};

struct LoadedPainting {
  PaintingRequest request;
  PaintScene scene;
  Size size;                    // px of the picture
  double scale = 1.0;           // picture px per canvas px
  Vec2 shift = Vec2::Zero();    // px of the picture
  ColorImage over;              // of the picture's size, or empty
  ColorImage fill;              // as large as the canvas is shown, or empty
  Recipe recipe;
  std::vector<std::string> files;  // paths that were read
};

// Checks what can be checked before anything is read. `output` is the name that will be written.
void check_painting(PaintingRequest& request, const std::string& output);

LoadedPainting load_painting(const PaintingRequest& request, std::uint64_t seed, const Monitor& monitor);

// The same for a skeleton that is no file; `recipe` and `files` say what it was made from. `name` stands in messages.
LoadedPainting lay_out_painting(const PaintingRequest& request, const Skeleton& skeleton, const std::string& name, Recipe recipe,
                                std::vector<std::string> files, const Mask& shape, const Monitor& monitor);

// A file as a recipe names it.
RecipeInput file_input(const std::string& role, const std::string& path);

// Writes one moment, .svg or a picture.
void save_painting(const LoadedPainting& painting, double growth, const std::string& path, const Monitor& monitor);

// Writes an animated .webp of all frames.
void save_animation(const LoadedPainting& painting, const std::string& path, const Monitor& monitor);

// The moment frame i shows.
double growth_of_frame(const PaintingOptions& options, int frame);

// Finds the inputs by their sha256 in `folders` and in RAMIFY_PHOTOS and sets every option. Throws InputError.
PaintingRequest painting_from_recipe(const Recipe& recipe, const std::vector<std::string>& folders);

}  // namespace ramify
