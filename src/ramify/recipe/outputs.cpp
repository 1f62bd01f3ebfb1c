// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/recipe/outputs.h"

#include "ramify/core/atomic_file.h"
#include "ramify/core/parallel.h"
#include "ramify/image/image_io.h"
#include "ramify/report/report.h"
#include "ramify/skeleton/draw.h"
#include "ramify/skeleton/skeleton_io.h"

namespace ramify {
namespace {

void save_intermediates(const LoadedRequest& loaded, const Picture& picture, const std::string& folder) {
  const ComposeScene& scene = loaded.scene;
  const auto name = [&](const char* file) { return folder + "/" + file; };
  save_mask(name("exemplar_branches.png"), loaded.source.exemplar.branch_mask);
  save_skeleton(loaded.source.exemplar.skeleton, name("exemplar_skeleton.swc"));
  save_mask(name("habitat_outside.png"), scene.habitat.outside);
  save_mask(name("habitat_outliers.png"), scene.habitat.outliers);
  save_mask(name("habitat_shadow.png"), scene.habitat.shadow);
  save_image(name("plate.png"), scene.plate.color);
  save_mask(name("plate_hole.png"), scene.plate.hole);
  save_image(name("background.png"), picture.composite.plate);
  save_skeleton(picture.skeleton, name("skeleton.json"));
  save_skeleton(picture.skeleton, name("skeleton.svg"));
  const SkeletonMasks masks = draw_masks(picture.skeleton, picture.skeleton.size);
  save_mask16(name("branch_id.png"), label_picture(masks.branch_id));
  save_mask16(name("order.png"), label_picture(masks.order));
  write_file(name("furcations.json"), furcations_json(picture.skeleton));
  save_mask16(name("owner.png"), label_picture(picture.composite.owner));
  ScalarImage x(picture.composite.source.size()), y(picture.composite.source.size());
  for (std::size_t i = 0; i < x.pixels().size(); ++i) {
    x.pixels()[i] = picture.composite.source.pixels()[i].x();
    y.pixels()[i] = picture.composite.source.pixels()[i].y();
  }
  save_scalar(name("source_x.tif"), x);
  save_scalar(name("source_y.tif"), y);
  if (!loaded.skeleton) write_file(name("style.json"), style_text(loaded.style));
}

}  // namespace

void save_picture(const LoadedRequest& loaded, const Picture& picture, const PictureFiles& files, const Monitor& monitor) {
  const CancelScope scope(monitor);
  if (loaded.request.verb == "grow") {
    save_skeleton(picture.skeleton, files.picture);
    return;
  }
  SaveOptions save;
  const int depth = loaded.request.options.depth;
  save.bits = depth != 0 ? depth : fitting_bits(files.picture, loaded.source.exemplar.photo.bits);
  save.recipe = recipe_text(picture.recipe);
  if (!files.skeleton.empty()) save_skeleton(picture.skeleton, files.skeleton);
  if (!files.mask.empty()) save_mask(files.mask, draw_branch_mask(picture.skeleton, picture.skeleton.size));
  if (!files.radius.empty()) save_mask16(files.radius, draw_masks(picture.skeleton, picture.skeleton.size).radius);
  if (!files.report.empty()) {
    const Exemplar& exemplar = loaded.source.exemplar;
    const ReportSubject source{exemplar.photo.name, exemplar.skeleton, exemplar.photo.color, nullptr};
    const ReportSubject result{"result", picture.skeleton, picture.composite.color, &picture.composite};
    write_file(files.report, report_text(make_report(source, result, Rng(1).child("report"), monitor.stage("report", 0.95, 1.0)), files.report));
  }
  if (!files.debug_folder.empty()) save_intermediates(loaded, picture, files.debug_folder);
  save_image(files.picture, picture.composite.color, save);
}

}  // namespace ramify
