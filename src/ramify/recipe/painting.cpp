// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/recipe/painting.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "ramify/core/atomic_file.h"
#include "ramify/core/version.h"
#include "ramify/image/animation.h"
#include "ramify/image/sample.h"
#include "ramify/recipe/canvas.h"
#include "ramify/exemplar/stroke_text.h"
#include "ramify/recipe/exemplar_source.h"
#include "ramify/recipe/painting_ground.h"

namespace ramify {
namespace fs = std::filesystem;
namespace {

constexpr int kBytesPerPixel = 112;  // picture, light or washes and their blur

bool is_svg_name(const std::string& path) { return fs::path(path).extension() == ".svg"; }

// Where a canvas lies on a picture: as large as fits, in the middle.
void fit_canvas(Size canvas, LoadedPainting& out) {
  out.scale = std::min(static_cast<double>(out.size.width) / canvas.width, static_cast<double>(out.size.height) / canvas.height);
  out.shift = 0.5 * (Vec2(out.size.width, out.size.height) - out.scale * Vec2(canvas.width, canvas.height));
}

// The photo's middle, filling the picture.
ColorImage covering(const ColorImage& photo, Size size) {
  if (photo.size() == size) return photo;
  const double scale = std::max(static_cast<double>(size.width) / photo.width(), static_cast<double>(size.height) / photo.height());
  const Size scaled{std::max(size.width, static_cast<int>(std::lround(scale * photo.width()))),
                    std::max(size.height, static_cast<int>(std::lround(scale * photo.height())))};
  return crop(resize(photo, scaled), (scaled.width - size.width) / 2, (scaled.height - size.height) / 2, size.width, size.height);
}

Vec2 foot_of(const Skeleton& skeleton) {
  for (const Node& node : skeleton.nodes()) {
    if (node.parent == kNone) return node.xy();
  }
  return Vec2::Zero();
}

// The skeleton's first root stands at a point of the photo; pixels of the canvas are as large as --scale says.
void place(const Skeleton& skeleton, LoadedPainting& out) {
  const PaintingOptions& o = out.request.options;
  const std::vector<Vec2> points = parse_points("at", o.at);
  if (points.size() != 1) throw OptionError("at", "'" + printable(o.at, 60) + "'", "expected one point \"x,y\" in px of the photo");
  const Vec2 at = points[0];
  if (at.x() < 0.0 || at.y() < 0.0 || at.x() > out.size.width - 1 || at.y() > out.size.height - 1) {
    throw OptionError("at", o.at, "lies outside the photo of " + std::to_string(out.size.width) + "x" + std::to_string(out.size.height) + " px");
  }
  out.scale = o.scale;
  out.shift = at + Vec2(0.5, 0.5) - o.scale * (foot_of(skeleton) + Vec2(0.5, 0.5));
}

void load_over(LoadedPainting& out, const Skeleton& skeleton, const Monitor& monitor) {
  const Size canvas = skeleton.size;
  const PaintingRequest& request = out.request;
  const Photo photo = load_photo(request.over, request.limits, monitor);
  out.recipe.inputs.push_back(file_input("photo", request.over));
  out.files.push_back(request.over);
  if (!request.options.at.empty()) {
    out.size = photo.color.size();
    place(skeleton, out);
    out.over = photo.color;
    return;
  }
  const bool sized = !request.options.size.empty() || request.options.scale != 1.0;
  if (!sized) {
    out.size = photo.color.size();
    if (out.size != canvas) {
      monitor.note("the canvas of " + std::to_string(canvas.width) + "x" + std::to_string(canvas.height) + " px is fitted into the photo of " +
                   std::to_string(out.size.width) + "x" + std::to_string(out.size.height) + " px");
    }
    fit_canvas(canvas, out);
  }
  out.over = covering(photo.color, out.size);
}

// A frame can be made again by itself: its recipe names its moment.
std::string recipe_at(const LoadedPainting& painting, double growth, bool animate) {
  Recipe recipe = painting.recipe;
  PaintingOptions options = painting.request.options;
  options.growth = growth;
  options.animate = animate;
  for (const auto& [name, value] : option_values(describe(options))) recipe.options[name] = value;
  return recipe_text(recipe);
}

Raster raster_at(const LoadedPainting& painting, double growth, const Monitor& monitor) {
  RasterOptions options;
  options.size = painting.size;
  options.scale = painting.scale;
  options.shift = painting.shift;
  const double softness = painting.request.options.soften;
  const bool apart = !painting.fill.empty() || softness > 0.0;  // from its ground until it is finished
  if (!painting.over.empty() && !apart) options.over = &painting.over;
  Drawing drawing = draw_painting(painting.scene, growth, monitor);
  if (!apart) return rasterize(drawing, options, monitor);
  drawing.background.reset();
  Raster out = rasterize(drawing, options, monitor);
  if (!painting.fill.empty()) fill_drawn(out, painting.fill, painting.shift);
  soften(out, softness);
  if (!painting.over.empty()) lay_over(out, painting.over);
  else if (painting.scene.background) lay_over(out, ColorImage(out.color.size(), *painting.scene.background));
  return out;
}

// The scenes of what stands behind: the same style and canvas.
void load_behind(LoadedPainting& out, Size canvas, const PaintOptions& paint, const Monitor& monitor) {
  for (std::size_t i = 0; i < out.request.behind.size(); ++i) {
    const std::string& path = out.request.behind[i];
    const Skeleton skeleton = load_any_skeleton(path).skeleton;
    if (skeleton.empty() || skeleton.dim != 2) throw InputError(printable(path, 300), "holds no flat skeleton to paint behind the other");
    if (skeleton.size != canvas) {
      throw InputError(printable(path, 300), "has a canvas of " + std::to_string(skeleton.size.width) + "x" + std::to_string(skeleton.size.height) +
                       " px, the skeleton before it one of " + std::to_string(canvas.width) + "x" + std::to_string(canvas.height) + " px");
    }
    out.recipe.inputs.push_back(file_input("behind", path));
    out.files.push_back(path);
    out.scene.behind.push_back(prepare_painting(skeleton, paint, Rng(out.recipe.seed).child("behind", i), monitor));
  }
}

void load_fill(LoadedPainting& out, Size canvas) {
  const PaintingRequest& request = out.request;
  const ColorImage fill = load_image(request.fill, request.limits).color;
  if (std::abs(static_cast<double>(fill.width()) * canvas.height - static_cast<double>(fill.height()) * canvas.width) > 0.02 * fill.width() * canvas.height) {
    throw InputError(printable(request.fill, 300), "has other proportions than the canvas of " + std::to_string(canvas.width) + "x" +
                     std::to_string(canvas.height) + " px; render the skeleton at its own size");
  }
  const Size shown{std::max(1, static_cast<int>(std::lround(out.scale * canvas.width))), std::max(1, static_cast<int>(std::lround(out.scale * canvas.height)))};
  out.fill = fill.size() == shown ? fill : resize(fill, shown);
  out.recipe.inputs.push_back(file_input("fill", request.fill));
  out.files.push_back(request.fill);
}

bool is_opaque(const LoadedPainting& painting) { return painting.scene.background || !painting.over.empty(); }

}  // namespace

std::vector<OptionField> describe(PaintingOptions& o) {
  std::vector<OptionField> fields = describe(o.paint);
  for (OptionField& field : std::vector<OptionField>{
           text("size", o.size, "Picture, WIDTHxHEIGHT in px; the canvas is fitted into it [canvas times --scale]"),
           number("scale", o.scale, 0.01, 100, "", "Picture pixels for every pixel of the canvas."),
           text("at", o.at, "With --over: where on the photo the first root stands, \"x,y\" in px; --scale is the drawing's size then [fitted into the photo]"),
           number("soften", o.soften, 0, 100, "px", "Blurs the drawing, to stand in a soft painting."),
           number("depth", o.depth, 8, 32, "bits", "8, 16 or 32 bits a channel."),
           number("growth", o.growth, 0, 1, "", "Draws an unfinished painting: 0 = nothing yet, 1 = all."),
           flag("animate", o.animate, "Lets it grow from its roots: an animated .webp, or numbered .png or .svg frames."),
           number("frames", o.frames, 2, 10000, "N", "Frames of an animation."),
           number("fps", o.fps, 0.1, 120, "1/s", "Frames a second of an animated .webp."),
           number("hold", o.hold, 0, 600, "s", "How long an animated .webp shows the finished painting.")}) {
    fields.push_back(std::move(field));
  }
  return fields;
}

void check_painting(PaintingRequest& request, const std::string& output) {
  PaintingOptions& o = request.options;
  check_options(describe(o));
  const bool svg = is_svg_name(output);
  if (!o.size.empty()) {
    if (o.scale != 1.0) throw OptionError("scale", number_text(o.scale), "has no effect beside --size; give one of them");
    check_canvas(parse_canvas(o.size), request.limits, kBytesPerPixel);
  }
  if (o.depth != 8 && o.depth != 16 && o.depth != 32) throw OptionError("depth", std::to_string(o.depth), "expected 8, 16 or 32");
  if (svg && o.depth != 8) throw OptionError("depth", std::to_string(o.depth), "has no effect on .svg");
  if (!svg && fitting_bits(output, o.depth) != o.depth) {
    throw OptionError("depth", std::to_string(o.depth), fs::path(output).extension().string() + " pictures have " +
                      std::to_string(fitting_bits(output, o.depth)) + " bits; choose that depth or another format");
  }
  if (!request.over.empty() && svg) throw OptionError("over", "", "an .svg holds no photo; write a picture, or paint without it and place it over the photo");
  if (!request.over.empty() && o.paint.background != "none") throw OptionError("background", o.paint.background, "has no effect beside --over; give one of them");
  if (!o.at.empty()) {
    if (request.over.empty()) throw OptionError("at", o.at, "has no effect without --over");
    if (!o.size.empty()) throw OptionError("size", o.size, "has no effect beside --at; the picture is as large as the photo");
  }
  if (o.paint.palette == "photo" && request.over.empty()) throw OptionError("palette", "photo", "takes its colours from a photo; name one by --over");
  if (svg && o.soften > 0.0) throw OptionError("soften", number_text(o.soften), "has no effect on .svg");
  if (!request.fill.empty() && svg) throw OptionError("fill", "", "an .svg holds no picture; write .png");
  if (o.paint.style == PaintStyle::Lightning) {
    if (o.soften > 0.0) throw OptionError("soften", number_text(o.soften), "has no effect on --style lightning");
    if (!request.fill.empty()) throw OptionError("fill", "", "has no effect on --style lightning");
    if (!request.behind.empty()) throw OptionError("behind", "", "has no effect on --style lightning: light hides nothing");
  }
  if (!request.behind.empty() && !request.over.empty()) throw OptionError("behind", "", "needs a plain ground; paint what stands behind first and give that picture to --over");
  const std::string kind = fs::path(output).extension().string();
  if ((kind == ".jpg" || kind == ".jpeg") && request.over.empty() && o.paint.background == "none") {
    throw OptionError("output", "'" + printable(output, 200) + "'", "JPEG cannot hold transparency; give --background COLOUR or write .png");
  }
  if (o.animate && o.growth != 1.0) throw OptionError("growth", number_text(o.growth), "has no effect with --animate, which shows every moment");
}

LoadedPainting load_painting(const PaintingRequest& request, std::uint64_t seed, const Monitor& monitor) {
  const LoadedSkeleton file = load_any_skeleton(request.skeleton);
  for (const std::string& note : file.notes) monitor.note(note);
  Recipe recipe{RAMIFY_VERSION, "paint", seed, {file_input("skeleton", request.skeleton)}, {}};
  return lay_out_painting(request, file.skeleton, printable(request.skeleton, 300), std::move(recipe), {request.skeleton}, {}, monitor);
}

LoadedPainting lay_out_painting(const PaintingRequest& request, const Skeleton& skeleton, const std::string& name, Recipe recipe,
                                std::vector<std::string> files, const Mask& shape, const Monitor& monitor) {
  if (skeleton.empty()) throw InputError(name, "the skeleton has no nodes: there is nothing to paint");
  if (skeleton.dim != 2) throw InputError(name, "is a skeleton in space; paint draws flat ones");
  if (skeleton.size.width < 1 || skeleton.size.height < 1) throw InputError(name, "has no canvas: its size must be at least 1x1 px");
  LoadedPainting out;
  out.request = request;
  out.recipe = std::move(recipe);
  out.files = std::move(files);
  const Size canvas = skeleton.size;
  const PaintingOptions& o = request.options;
  if (o.size.empty()) {
    const auto scaled = [&](int side) { return static_cast<int>(std::lround(std::clamp(o.scale * side, 1.0, 1e9))); };
    out.size = {scaled(canvas.width), scaled(canvas.height)};
    out.scale = o.scale;
  } else {
    out.size = parse_canvas(o.size);
    fit_canvas(canvas, out);
  }
  check_canvas(out.size, request.limits, kBytesPerPixel);
  if (!request.over.empty()) load_over(out, skeleton, monitor);
  if (!request.fill.empty()) load_fill(out, canvas);
  PaintOptions paint = o.paint;
  if (paint.palette == "photo") paint.palette = palette_of_photo(out.over);
  out.scene = prepare_painting(skeleton, paint, Rng(out.recipe.seed).child("paint"), monitor, shape);
  load_behind(out, canvas, paint, monitor);
  return out;
}

RecipeInput file_input(const std::string& role, const std::string& path) {
  return {role, fs::path(path).filename().string(), sha256_hex(read_file(path, std::size_t{1} << 30))};
}

void save_painting(const LoadedPainting& painting, double growth, const std::string& path, const Monitor& monitor) {
  const std::string recipe = recipe_at(painting, growth, false);
  if (is_svg_name(path)) {
    write_file(path, drawing_svg(draw_painting(painting.scene, growth, monitor), painting.scale, recipe));
    return;
  }
  const Raster raster = raster_at(painting, growth, monitor);
  SaveOptions save;
  save.bits = painting.request.options.depth;
  save.dither = painting.scene.options.style == PaintStyle::Lightning;
  save.recipe = recipe;
  if (is_opaque(painting)) save_image(path, raster.color, save);
  else save_image(path, raster.color, raster.alpha, save);
}

double growth_of_frame(const PaintingOptions& options, int frame) {
  return (frame + 1.0) / options.frames;
}

void save_animation(const LoadedPainting& painting, const std::string& path, const Monitor& monitor) {
  const PaintingOptions& o = painting.request.options;
  const int milliseconds = std::max(1, static_cast<int>(std::lround(1000.0 / o.fps)));
  const auto frame = [&](int i) {
    Raster raster = raster_at(painting, growth_of_frame(o, i), monitor);
    const int last = i + 1 == o.frames ? static_cast<int>(std::lround(1000.0 * o.hold)) : 0;
    return AnimationFrame{std::move(raster.color), is_opaque(painting) ? Mask() : std::move(raster.alpha), milliseconds + last};
  };
  AnimationOptions options;
  options.recipe = recipe_at(painting, 1.0, true);
  write_file(path, encode_animation(painting.size, o.frames, frame, options, monitor));
}

PaintingRequest painting_from_recipe(const Recipe& recipe, const std::vector<std::string>& folders) {
  PaintingRequest request;
  for (OptionField& field : describe(request.options)) {
    const auto value = recipe.options.find(field.name);
    if (value != recipe.options.end()) set_text(field, value->second);
  }
  for (const RecipeInput& input : recipe.inputs) {
    if (input.role == "skeleton") request.skeleton = find_input(input, folders);
    if (input.role == "photo") request.over = find_input(input, folders);
    if (input.role == "fill") request.fill = find_input(input, folders);
    if (input.role == "behind") request.behind.push_back(find_input(input, folders));
  }
  return request;
}

}  // namespace ramify
