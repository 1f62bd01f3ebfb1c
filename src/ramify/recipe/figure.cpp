// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/recipe/figure.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "ramify/core/atomic_file.h"
#include "ramify/core/version.h"
#include "ramify/image/image_io.h"
#include "ramify/paint/lettering.h"
#include "ramify/recipe/canvas.h"
#include "ramify/skeleton/draw.h"
#include "ramify/skeleton/skeleton_io.h"

namespace ramify {
namespace fs = std::filesystem;
namespace {

constexpr int kBytesPerPixel = 96;  // labels, plan, distances

// Dark and opaque is the shape; with `invert` light and opaque.
Mask bitmap_shape(const std::string& path, bool invert, const LoadLimits& limits, const Monitor& monitor) {
  const LoadedImage image = load_image(path, limits);
  for (const std::string& warning : image.warnings) monitor.note(warning);
  Mask shape(image.color.size());
  for (std::size_t i = 0; i < shape.pixels().size(); ++i) {
    const Rgb& c = image.color.pixels()[i];
    const bool dark = 0.2126f * c.r + 0.7152f * c.g + 0.0722f * c.b < 0.5f;
    const bool opaque = image.alpha.empty() || image.alpha.pixels()[i] >= 128;
    shape.pixels()[i] = opaque && dark != invert ? 255 : 0;
  }
  return shape;
}

// "\n" as two characters, as shells pass it, counts as a line's end.
std::string with_line_ends(std::string text) {
  for (std::size_t at = text.find("\\n"); at != std::string::npos; at = text.find("\\n", at + 1)) text.replace(at, 2, "\n");
  return text;
}

}  // namespace

Mask text_shape(const FigureSourceOptions& source, const std::string& font_file, const LoadLimits& limits) {
  const Lettering lettering = set_text(with_line_ends(source.text), font_file, source.text_size);
  check_canvas(lettering.size, limits, kBytesPerPixel);
  if (const int side = std::max(lettering.size.width, lettering.size.height); side > kMostRasterSide) {
    throw LimitError("the text is " + std::to_string(side) + " px long, a picture has at most " + std::to_string(kMostRasterSide) +
                     " px a side; break it into lines by \\n, or choose a smaller --text-size");
  }
  Mask shape = text_mask(lettering);
  if (!source.baseline) return shape;
  const int thick = std::max(2, static_cast<int>(std::lround(0.03 * source.text_size)));
  for (std::size_t line = 0; line < lettering.baselines.size(); ++line) {
    const int y0 = static_cast<int>(std::lround(lettering.baselines[line])) - thick;
    for (int y = std::max(0, y0); y < std::min(shape.height(), y0 + thick); ++y) {
      for (int x = static_cast<int>(lettering.extents[line].first); x < std::min<int>(shape.width(), static_cast<int>(lettering.extents[line].second)); ++x) {
        if (x >= 0) shape(x, y) = 255;
      }
    }
  }
  return shape;
}

std::vector<OptionField> describe(FigureOptionsAll& o) {
  std::vector<OptionField> fields{
      text("text", o.source.text, "The text to fill (UTF-8), \\n between lines, instead of a bitmap."),
      text("font", o.source.font, "The text's font: a name such as \"DejaVu Sans:bold\" or a font file."),
      number("text-size", o.source.text_size, 4, 10000, "px", "Size of the text's em."),
      flag("baseline", o.source.baseline, "A thin line under the text joins its letters to one tree."),
      flag("invert", o.source.invert, "The bitmap's white is filled instead of its black.")};
  for (OptionField& field : describe(o.figure)) fields.push_back(std::move(field));
  return fields;
}

PaintingOptions figure_painting() {
  PaintingOptions options;
  options.paint.stroke.smoothing = 0.0;
  options.paint.stroke.flow = 0.0;
  options.paint.stroke.taper = 0.35;
  options.paint.stroke.thinnest = 0.2;
  return options;
}

LoadedFigure load_figure(const FigureRequest& request, std::uint64_t seed, const Monitor& monitor) {
  LoadedFigure out;
  FigureOptionsAll options = request.options;
  out.recipe = {RAMIFY_VERSION, "figure", seed, {}, option_values(describe(options))};
  Mask shape;
  const LoadLimits& limits = request.painting.limits;
  if (request.bitmap.empty()) {
    const std::string font = find_font(options.source.font);
    shape = text_shape(options.source, font, limits);
    out.recipe.inputs.push_back(file_input("font", font));
    out.files.push_back(font);
  } else {
    shape = bitmap_shape(request.bitmap, options.source.invert, limits, monitor);
    check_canvas(shape.size(), limits, kBytesPerPixel);
    out.recipe.inputs.push_back(file_input("bitmap", request.bitmap));
    out.files.push_back(request.bitmap);
  }
  try {
    out.figure = grow_figure(shape, options.figure, Rng(seed).child("figure"), monitor);
  } catch (const InputError& error) {
    throw InputError(printable(request.bitmap, 300), error.what());
  }
  return out;
}

LoadedPainting paint_figure(const FigureRequest& request, const LoadedFigure& figure, const Monitor& monitor) {
  const bool free = request.options.figure.cells == FigureCellKind::Euclidean;
  return lay_out_painting(request.painting, figure.figure.skeleton, "figure", figure.recipe, figure.files, free ? Mask() : figure.figure.region, monitor);
}

void save_figure_intermediates(const FilledFigure& figure, const std::string& folder) {
  save_mask(folder + "/region.png", figure.region);
  save_mask16(folder + "/cells.png", label_picture(figure.cell));
  save_skeleton(figure.skeleton, folder + "/skeleton.json");
  std::string rows = "x,y,parent\n";
  for (std::size_t i = 0; i < figure.sites.size(); ++i) {
    rows += number_text(figure.sites[i].x()) + "," + number_text(figure.sites[i].y()) + "," + std::to_string(figure.parents[i]) + "\n";
  }
  write_file(folder + "/sites.csv", rows);
}

FigureRequest figure_from_recipe(const Recipe& recipe, const std::vector<std::string>& folders) {
  FigureRequest request;
  request.painting.options = figure_painting();  // it has settings that are no options
  std::vector<OptionField> fields = describe(request.options);
  for (OptionField& field : describe(request.painting.options)) fields.push_back(field);
  for (OptionField& field : fields) {
    const auto value = recipe.options.find(field.name);
    if (value != recipe.options.end()) set_text(field, value->second);
  }
  for (const RecipeInput& input : recipe.inputs) {
    if (input.role == "bitmap") request.bitmap = find_input(input, folders);
    if (input.role == "photo") request.painting.over = find_input(input, folders);
    if (input.role == "fill") request.painting.fill = find_input(input, folders);
    if (input.role != "font") continue;
    // Fonts lie where the system keeps them; one with other bytes must be looked for like a picture.
    const std::string& name = request.options.source.font;
    const bool is_file = name.find('/') != std::string::npos || name.ends_with(".ttf") || name.ends_with(".otf");
    const std::string system = is_file ? "" : find_font(name);
    if (system.empty() || file_input("font", system).sha256 != input.sha256) request.options.source.font = find_input(input, folders);
  }
  return request;
}

}  // namespace ramify
