// SPDX-License-Identifier: GPL-3.0-or-later
// From a bitmap or a text to a figurative tree: what `figure` and its replay call.
#pragma once

#include <string>

#include "ramify/growth/figure.h"
#include "ramify/recipe/painting.h"

namespace ramify {

struct FigureSourceOptions {
  std::string text;                        // UTF-8; empty = a bitmap
  std::string font = "DejaVu Sans:bold";  // a name or a file
  double text_size = 260.0;                // px, an em
  bool baseline = false;                   // a thin line under the text joins its letters
  bool invert = false;                     // white is the shape
};

// Where the text's ink is: 255. Throws InputError, OptionError, LimitError.
Mask text_shape(const FigureSourceOptions& source, const std::string& font_file, const LoadLimits& limits);

struct FigureOptionsAll {
  FigureSourceOptions source;
  FigureOptions figure;
};
std::vector<OptionField> describe(FigureOptionsAll& options);

struct FigureRequest {
  std::string bitmap;  // or empty
  FigureOptionsAll options;
  PaintingRequest painting;  // how it is drawn; its skeleton is not used
};

// Settings of paint that suit lines which are smooth already.
PaintingOptions figure_painting();

struct LoadedFigure {
  FilledFigure figure;
  Recipe recipe;
  std::vector<std::string> files;
};

// Throws InputError, OptionError, LimitError.
LoadedFigure load_figure(const FigureRequest& request, std::uint64_t seed, const Monitor& monitor);

LoadedPainting paint_figure(const FigureRequest& request, const LoadedFigure& figure, const Monitor& monitor);

// Region, cells, sites and skeleton as files in a folder.
void save_figure_intermediates(const FilledFigure& figure, const std::string& folder);

FigureRequest figure_from_recipe(const Recipe& recipe, const std::vector<std::string>& folders);

}  // namespace ramify
