// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/recipe/exemplar_source.h"

#include <cmath>
#include <cstdlib>
#include <filesystem>

#include "ramify/core/atomic_file.h"
#include "ramify/exemplar/trace.h"
#include "ramify/image/sample.h"
#include "ramify/skeleton/skeleton_io.h"
#include "ramify/synthetic/synthetic.h"

namespace ramify {
namespace fs = std::filesystem;
namespace {

constexpr char kBuiltin[] = "builtin:";
// Grey levels of --regions, one for each RegionRole in its order.
constexpr int kRoleGreys[] = {0, 64, 128, 192, 255};

std::string file_name(const std::string& path) { return fs::path(path).filename().string(); }

// Where an annotation's photo lies: beside the annotation, or in RAMIFY_PHOTOS.
std::string find_photo(const std::string& annotation_path, const Annotation& annotation) {
  const fs::path beside = fs::path(annotation_path).parent_path() / annotation.photo_file;
  if (fs::exists(beside)) return beside.string();
  const char* photos = std::getenv("RAMIFY_PHOTOS");
  if (photos && *photos) {
    const fs::path elsewhere = fs::path(photos) / fs::path(annotation.photo_file).filename();
    if (fs::exists(elsewhere)) return elsewhere.string();
  }
  throw InputError(printable(annotation_path, 300),
                   "its photo '" + printable(annotation.photo_file) + "' is neither beside it nor in RAMIFY_PHOTOS" +
                       (photos && *photos ? " (" + printable(photos) + ")" : " (which is not set)"));
}

// `where` names the annotation in messages.
void check_annotation(const Annotation& annotation, const Photo& photo, const std::string& where, bool allow_other,
                      const Monitor& monitor) {
  if (annotation.branches.empty()) {
    throw InputError(where, "holds no branches; draw at least one, or find them with ramify trace");
  }
  if (annotation.photo_sha256.empty() || annotation.photo_sha256 == photo.sha256) return;
  if (!allow_other) {
    throw InputError(where, "belongs to another picture: it was made for sha256 " + annotation.photo_sha256.substr(0, 12) +
                                "…, " + printable(photo.name) + " has " + photo.sha256.substr(0, 12) +
                                "…; --allow-other-photo uses it all the same");
  }
  monitor.note(where + " was made for another picture than " + printable(photo.name) + "; used all the same");
}

Annotation annotation_for(const Photo& photo, const ExemplarRequest& request, const Monitor& monitor) {
  if (request.annotation.empty()) {
    throw InputError(printable(request.argument, 300), "is a photo without an annotation; make one with `ramify trace " +
                                                           printable(request.argument) + " -o NAME.ramify.json`, or add --annotation auto");
  }
  if (request.annotation == "auto") return trace_photo(photo, TraceOptions{}, monitor);
  const std::string text = read_file(request.annotation, 1u << 28);
  if (text.find("ramify-annotation") != std::string::npos) return load_annotation(request.annotation);
  const LoadedSkeleton loaded = load_skeleton(request.annotation);
  for (const std::string& note : loaded.notes) monitor.note(note);
  const Size canvas = loaded.skeleton.size, size = photo.color.size();
  if (text.find("\"ramify-skeleton\"") != std::string::npos && canvas != size && !request.allow_other_photo) {
    throw InputError(printable(request.annotation, 300),
                     "its canvas is " + std::to_string(canvas.width) + "x" + std::to_string(canvas.height) + " px, " +
                         printable(photo.name) + " is " + std::to_string(size.width) + "x" +
                         std::to_string(size.height) + " px; --allow-other-photo uses it all the same");
  }
  Annotation annotation = annotation_from_skeleton(loaded.skeleton);
  annotation.photo_size = size;
  return annotation;
}

void apply_regions(Exemplar& exemplar, const std::string& path, const LoadLimits& limits) {
  Mask map = load_mask(path, limits);
  if (map.size() != exemplar.photo.color.size()) map = resize_nearest(map, exemplar.photo.color.size());
  for (std::size_t i = 0; i < map.pixels().size(); ++i) {
    int role = 0;
    for (int r = 1; r < 5; ++r) {
      if (std::abs(map.pixels()[i] - kRoleGreys[r]) < std::abs(map.pixels()[i] - kRoleGreys[role])) role = r;
    }
    exemplar.regions.pixels()[i] = static_cast<std::uint8_t>(role);
  }
}

LoadedExemplar load_builtin(const ExemplarRequest& request, const Monitor& monitor) {
  if (!request.annotation.empty()) {
    throw OptionError("annotation", "'" + printable(request.annotation) + "'", "has no effect on " + printable(request.argument));
  }
  const SyntheticKind kind = synthetic_kind(request.argument.substr(sizeof kBuiltin - 1));
  SyntheticExemplar made = make_synthetic(kind, natural_size(kind), Rng(1), monitor);
  LoadedExemplar out;
  out.exemplar = make_exemplar(std::move(made.photo), std::move(made.annotation));
  out.inputs.push_back({"exemplar", request.argument, ""});
  return out;
}

// An annotation that names its photo.
LoadedExemplar load_annotated(const ExemplarRequest& request, const Monitor& monitor) {
  const std::string named = printable(request.argument, 300);
  if (!request.annotation.empty()) {
    throw OptionError("annotation", "'" + printable(request.annotation) + "'", "has no effect: " + named + " is an annotation already");
  }
  Annotation annotation = load_annotation(request.argument);
  const std::string photo_path = request.photo.empty() ? find_photo(request.argument, annotation) : request.photo;
  Photo photo = load_photo(photo_path, request.limits, monitor);
  check_annotation(annotation, photo, named, request.allow_other_photo, monitor);
  LoadedExemplar out;
  out.inputs.push_back({"exemplar", file_name(request.argument), sha256_hex(read_file(request.argument, 1u << 28))});
  out.inputs.push_back({"photo", photo.name, photo.sha256});
  out.files = {request.argument, photo_path};
  out.exemplar = make_exemplar(std::move(photo), std::move(annotation));
  return out;
}

// A photo with an annotation or a skeleton, or traced.
LoadedExemplar load_pair(const ExemplarRequest& request, const Monitor& monitor) {
  const bool traced = request.annotation == "auto";
  Photo photo = load_photo(request.argument, request.limits, monitor);
  Annotation annotation = annotation_for(photo, request, monitor);
  check_annotation(annotation, photo, printable(traced ? request.argument : request.annotation, 300), request.allow_other_photo, monitor);
  LoadedExemplar out;
  out.inputs.push_back({"exemplar", photo.name, photo.sha256});
  out.files.push_back(request.argument);
  if (traced) {
    out.inputs.push_back({"annotation", "auto", ""});
  } else {
    out.inputs.push_back({"annotation", file_name(request.annotation), sha256_hex(read_file(request.annotation, 1u << 28))});
    out.files.push_back(request.annotation);
  }
  out.exemplar = make_exemplar(std::move(photo), std::move(annotation));
  return out;
}

}  // namespace

bool is_builtin(const std::string& argument) { return argument.rfind(kBuiltin, 0) == 0; }

bool is_json_file(const std::string& path) {
  const std::string text = read_file(path, std::size_t{1} << 31);
  const std::size_t first = text.find_first_not_of(" \t\r\n\xef\xbb\xbf");
  return first != std::string::npos && text[first] == '{';
}

bool is_annotation_file(const std::string& path) {
  return is_json_file(path) && read_file(path, kSkeletonFileLimit).find("\"ramify-annotation\"") != std::string::npos;
}

LoadedSkeleton load_any_skeleton(const std::string& path) {
  if (is_annotation_file(path)) return {skeleton_from_annotation(load_annotation(path)), {}};
  return load_skeleton(path);
}

Photo load_photo(const std::string& path, const LoadLimits& limits, const Monitor& monitor) {
  LoadedImage image = load_image(path, limits);
  for (const std::string& warning : image.warnings) monitor.note(warning);
  return {std::move(image.color), std::move(image.alpha), file_name(path), image.sha256, image.bits};
}

LoadedExemplar load_exemplar(const ExemplarRequest& request, const Monitor& monitor) {
  LoadedExemplar out = is_builtin(request.argument)     ? load_builtin(request, monitor)
                       : is_json_file(request.argument) ? load_annotated(request, monitor)
                                                        : load_pair(request, monitor);
  if (!request.regions.empty()) {
    apply_regions(out.exemplar, request.regions, request.limits);
    out.inputs.push_back({"regions", file_name(request.regions), sha256_hex(read_file(request.regions, std::size_t{1} << 30))});
    out.files.push_back(request.regions);
  }
  return out;
}

}  // namespace ramify
