// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/recipe/moss.h"

#include <algorithm>
#include <cmath>

#include "ramify/core/atomic_file.h"
#include "ramify/core/version.h"
#include "ramify/paint/palette.h"
#include "ramify/paint/stroke.h"
#include "ramify/paint/drawing.h"
#include "ramify/recipe/canvas.h"
#include "ramify/recipe/painting.h"

namespace ramify {
namespace {

constexpr int kPiece = 4;  // points of a hair in one light

// Hairs in pieces of one colour: curves hold no gradients. Pieces overlap by a point, so that no gaps show.
Layer hair_layer(const std::vector<MossHair>& hairs) {
  Layer layer;
  layer.name = "moss";
  for (const MossHair& hair : hairs) {
    const std::size_t count = hair.points.size();
    for (std::size_t first = 0; first == 0 || first + 1 < count; first += kPiece) {
      const std::size_t last = std::min(count, first + kPiece + 1);
      Stroke piece;
      float light = 0.0f;
      for (std::size_t i = first; i < last; ++i) {
        piece.points.push_back(hair.points[i]);
        piece.radii.push_back(hair.radii[i]);
        light += hair.light[i] / static_cast<float>(last - first);
      }
      const std::vector<Vec2> outline = stroke_outline(piece);
      if (outline.size() < 3) continue;
      Shape shape;
      shape.color = light * hair.color;
      shape.loops.emplace_back();
      for (std::size_t i = 0; i < outline.size(); ++i) shape.loops.back().push_back(straight_bezier(outline[i], outline[(i + 1) % outline.size()]));
      layer.shapes.push_back(std::move(shape));
    }
  }
  return layer;
}

}  // namespace

std::vector<OptionField> describe(MossPainting& o) {
  std::vector<OptionField> fields = describe(o.moss);
  fields.push_back(text("background", o.background, "What shows between hairs: a colour, or none for transparency."));
  fields.push_back(number("scale", o.scale, 0.01, 100.0, "", "Pixels of the result for every pixel of the picture."));
  return fields;
}

void paint_moss(const MossRequest& request, std::uint64_t seed, const std::string& output, const Monitor& monitor) {
  MossPainting options = request.options;
  check_options(describe(options));
  Drawing drawing;
  if (options.background != "none") drawing.background = parse_color("background", options.background);
  const bool svg = output.ends_with(".svg");
  if (!svg && !drawing.background && (output.ends_with(".jpg") || output.ends_with(".jpeg"))) {
    throw OptionError("output", "'" + printable(output, 200) + "'", "JPEG cannot hold transparency; give --background COLOUR or write .png");
  }
  const LoadedImage picture = load_image(request.picture, request.limits);
  for (const std::string& warning : picture.warnings) monitor.note(warning);
  const Recipe recipe{RAMIFY_VERSION, "moss", seed, {file_input("photo", request.picture)}, option_values(describe(options))};
  drawing.size = {picture.color.width(), picture.color.height() + moss_headroom(options.moss)};
  const auto scaled = [&](int side) { return static_cast<int>(std::lround(std::clamp(options.scale * side, 1.0, 1e9))); };
  RasterOptions raster;
  raster.size = {scaled(drawing.size.width), scaled(drawing.size.height)};
  raster.scale = options.scale;
  check_canvas(raster.size, request.limits);
  drawing.layers.push_back(hair_layer(grow_moss(picture.color, options.moss, Rng(seed).child("moss"), monitor.stage("grow", 0.0, 0.6))));
  if (svg) {
    write_file(output, drawing_svg(drawing, options.scale, recipe_text(recipe)));
    return;
  }
  const Raster pixels = rasterize(drawing, raster, monitor.stage("paint", 0.6, 1.0));
  SaveOptions save;
  save.recipe = recipe_text(recipe);
  if (drawing.background) save_image(output, pixels.color, save);
  else save_image(output, pixels.color, pixels.alpha, save);
}

MossRequest moss_from_recipe(const Recipe& recipe, const std::vector<std::string>& folders) {
  MossRequest request;
  for (OptionField& field : describe(request.options)) {
    const auto value = recipe.options.find(field.name);
    if (value != recipe.options.end()) set_text(field, value->second);
  }
  for (const RecipeInput& input : recipe.inputs) {
    if (input.role == "photo") request.picture = find_input(input, folders);
  }
  return request;
}

}  // namespace ramify
