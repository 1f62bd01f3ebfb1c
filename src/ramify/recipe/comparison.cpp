// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/recipe/comparison.h"

#include <filesystem>

#include "ramify/core/atomic_file.h"
#include "ramify/recipe/exemplar_source.h"
#include "ramify/recipe/pipeline.h"
#include "ramify/report/report.h"
#include "ramify/skeleton/skeleton_io.h"

namespace ramify {
namespace fs = std::filesystem;
namespace {

// What one side is, with the provenance of a picture made again alive beside it.
struct Side {
  ReportSubject subject;
  Composite composite;
};

Side exemplar_side(const std::string& path, const LoadLimits& limits, const Monitor& monitor) {
  ExemplarRequest request;
  request.argument = path;
  request.limits = limits;
  LoadedExemplar loaded = load_exemplar(request, monitor);
  Side side;
  side.subject.skeleton = std::move(loaded.exemplar.skeleton);
  side.subject.color = std::move(loaded.exemplar.photo.color);
  return side;
}

Side picture_side(const std::string& path, const ComparisonRequest& request, const Monitor& monitor) {
  const LoadLimits& limits = request.limits;
  const Recipe recipe = load_recipe(path, limits);
  std::vector<std::string> folders{fs::path(path).parent_path().string(), fs::path(request.first).parent_path().string()};
  folders.insert(folders.end(), request.inputs.begin(), request.inputs.end());
  const LoadedRequest loaded = load_recipe_request(recipe, folders, limits, monitor.stage("load", 0.0, 0.3));
  Picture picture = make_picture(loaded, recipe.seed, monitor.stage("make again", 0.3, 1.0));
  Side side;
  side.subject.skeleton = std::move(picture.skeleton);
  side.subject.color = load_image(path, limits).color;
  side.composite = std::move(picture.composite);
  return side;
}

Side load_side(const std::string& path, const ComparisonRequest& request, const Monitor& monitor) {
  Side side;
  const std::string head = is_builtin(path) ? "" : read_file(path, std::size_t{1} << 31);
  if (is_builtin(path) || head.find("\"ramify-annotation\"") != std::string::npos) {
    side = exemplar_side(path, request.limits, monitor);
  } else if (head.find('\0') != std::string::npos) {
    side = picture_side(path, request, monitor);
  } else {
    LoadedSkeleton loaded = load_skeleton(path);
    for (const std::string& note : loaded.notes) monitor.note(note);
    side.subject.skeleton = std::move(loaded.skeleton);
  }
  side.subject.name = fs::path(path).filename().string();
  return side;
}

}  // namespace

std::string comparison_text(const ComparisonRequest& request, const std::string& path, const Monitor& monitor) {
  const Side first = load_side(request.first, request, monitor.stage("first", 0.0, 0.2));
  Side second = load_side(request.second, request, monitor.stage("second", 0.2, 0.7));
  if (!second.composite.color.empty()) second.subject.provenance = &second.composite;
  return report_text(make_report(first.subject, second.subject, Rng(1).child("report"), monitor.stage("report", 0.7, 1.0)), path);
}

}  // namespace ramify
