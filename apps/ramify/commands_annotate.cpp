// SPDX-License-Identifier: GPL-3.0-or-later
// The verbs that work on one photo: trace, rectify, complete, exemplar.
#include <memory>

#include "commands.h"
#include "outputs.h"
#include "ramify/core/atomic_file.h"
#include "ramify/exemplar/rectification.h"
#include "ramify/exemplar/stroke_text.h"
#include "ramify/exemplar/trace.h"
#include "ramify/image/completion.h"
#include "ramify/image/filter.h"
#include "ramify/image/image_io.h"
#include "ramify/recipe/exemplar_source.h"
#include "ramify/synthetic/synthetic.h"

namespace ramify::app {
namespace {

bool keep_existing(const Chosen& chosen, const std::string& output) {
  return chosen.shared.no_clobber && file_exists(output);
}

// How the annotation names its photo: by file name, searched beside it.
void write_annotation(const std::string& path, Annotation annotation, const Photo& photo) {
  annotation.photo_file = photo.name;
  annotation.photo_sha256 = photo.sha256;
  write_file(path, annotation_text(annotation));
}

}  // namespace

void add_trace(CLI::App& root, Chosen& chosen) {
  struct Arguments {
    std::string photo, output;
    TraceOptions options;
    FieldFlags flags;
  };
  const auto a = std::make_shared<Arguments>();
  CLI::App* app = root.add_subcommand("trace", "Find the branches of a photo and how wide they are");
  app->add_option("photo", a->photo, "Photo (.png .jpg .tif .exr .webp)")->required();
  app->add_option("-o,--output", a->output, "Annotation to write (NAME.ramify.json)")->required()->type_name("FILE");
  a->flags.add(*app, describe(a->options), "Tracing");
  add_shared(*app, chosen.shared);
  app->footer("Examples:\n  ramify trace river.jpg -o river.ramify.json\n"
              "  ramify trace bolt.png --polarity glow -o bolt.ramify.json\n"
              "  ramify trace wall.png --through \"10,40 200,75 380,60\" -o wall.ramify.json");
  app->callback([&chosen, a] {
    chosen.work = [&chosen, a](const Monitor& monitor) {
      check_extension("output", a->output, {".json"});
      check_options(describe(a->options));
      check_outputs(chosen.shared, {a->output}, {a->photo});
      if (keep_existing(chosen, a->output)) return Outcome{{}, {a->output}, ""};
      const Photo photo = load_photo(a->photo, chosen.shared.load_limits(), monitor.stage("load", 0.0, 0.1));
      write_annotation(a->output, trace_photo(photo, a->options, monitor.stage("trace", 0.1, 1.0)), photo);
      return Outcome{{a->output}, {}, ""};
    };
  });
}

void add_rectify(CLI::App& root, Chosen& chosen) {
  struct Arguments {
    std::string photo, output, corners, back;
  };
  const auto a = std::make_shared<Arguments>();
  CLI::App* app = root.add_subcommand("rectify", "Remove the perspective of something flat, or put it back");
  app->add_option("photo", a->photo, "Photo of something flat")->required();
  app->add_option("--corners", a->corners, "\"x,y x,y x,y x,y\": where its corners lie in the photo, px: top left, top right, bottom right, bottom left")
      ->required()->type_name("POINTS");
  app->add_option("--back", a->back, "A finished rectified picture: lay it over the photo in the photo's perspective")->type_name("IMAGE");
  app->add_option("-o,--output", a->output, "Picture to write")->required()->type_name("FILE");
  add_shared(*app, chosen.shared);
  app->footer("Examples:\n  ramify rectify road.jpg --corners \"310,80 700,95 990,640 20,610\" -o flat.png\n"
              "  ramify rectify road.jpg --corners \"310,80 700,95 990,640 20,610\" --back new_flat.png -o new_road.png");
  app->callback([&chosen, a] {
    chosen.work = [&chosen, a](const Monitor& monitor) {
      check_extension("output", a->output, kPictureExtensions);
      const std::vector<Vec2> points = parse_points("corners", a->corners);
      if (points.size() != 4) {
        throw OptionError("corners", "'" + printable(a->corners, 100) + "'", "expected four points, got " + std::to_string(points.size()));
      }
      check_outputs(chosen.shared, {a->output}, {a->photo, a->back});
      if (keep_existing(chosen, a->output)) return Outcome{{}, {a->output}, ""};
      const Photo photo = load_photo(a->photo, chosen.shared.load_limits(), monitor.stage("load", 0.0, 0.1));
      const Rectification flat = rectification_from_corners({points[0], points[1], points[2], points[3]}, chosen.shared.limit_pixels);
      SaveOptions save;
      save.bits = fitting_bits(a->output, photo.bits);
      const Monitor warp = monitor.stage("warp", 0.1, 0.9);
      if (a->back.empty()) {
        const Warped out = warp_picture(photo.color, photo.alpha, flat.rectified_from_photo, flat.size, warp);
        save_image(a->output, out.color, out.valid, save);
      } else {
        const Photo finished = load_photo(a->back, chosen.shared.load_limits(), monitor);
        if (finished.color.size() != flat.size) {
          throw InputError(printable(a->back, 300), "is " + std::to_string(finished.color.width()) + "x" + std::to_string(finished.color.height()) +
                           " px, these corners rectify to " + std::to_string(flat.size.width) + "x" + std::to_string(flat.size.height));
        }
        save_image(a->output, distort_back(photo.color, finished.color, flat.rectified_from_photo, warp), save);
      }
      return Outcome{{a->output}, {}, ""};
    };
  });
}

void add_complete(CLI::App& root, Chosen& chosen) {
  struct Arguments {
    std::string photo, mask, output;
    CompletionOptions options;
    FieldFlags flags;
  };
  const auto a = std::make_shared<Arguments>();
  CLI::App* app = root.add_subcommand("complete", "Fill a hole of a picture with the rest of it");
  app->add_option("photo", a->photo, "Picture (.png .jpg .tif .exr .webp)")->required();
  app->add_option("--mask", a->mask, "Picture of the same size: white is filled, black is kept")->required()->type_name("IMAGE");
  app->add_option("-o,--output", a->output, "Picture to write")->required()->type_name("FILE");
  a->flags.add(*app, describe(a->options), "Completion");
  add_shared(*app, chosen.shared);
  app->footer("Example:\n  ramify complete wall.jpg --mask crack_mask.png -o wall_without_crack.png");
  app->callback([&chosen, a] {
    chosen.work = [&chosen, a](const Monitor& monitor) {
      check_extension("output", a->output, kPictureExtensions);
      check_options(describe(a->options));
      check_outputs(chosen.shared, {a->output}, {a->photo, a->mask});
      if (keep_existing(chosen, a->output)) return Outcome{{}, {a->output}, ""};
      const Photo photo = load_photo(a->photo, chosen.shared.load_limits(), monitor.stage("load", 0.0, 0.05));
      Mask hole = load_mask(a->mask, chosen.shared.load_limits());
      if (hole.size() != photo.color.size()) {
        throw InputError(printable(a->mask, 300), "is " + std::to_string(hole.width()) + "x" + std::to_string(hole.height()) +
                         " px, the picture " + std::to_string(photo.color.width()) + "x" + std::to_string(photo.color.height()) + "; both must be the same");
      }
      for (auto& pixel : hole.pixels()) pixel = pixel > 127 ? 255 : 0;
      const Mask forbidden = photo.alpha.empty() ? Mask() : invert(photo.alpha);
      const Completion done = complete(photo.color, hole, forbidden, a->options, Rng(chosen.shared.seed).child("complete"), monitor.stage("complete", 0.05, 0.98));
      SaveOptions save;
      save.bits = fitting_bits(a->output, photo.bits);
      if (photo.alpha.empty()) save_image(a->output, done.color, save);
      else save_image(a->output, done.color, photo.alpha, save);
      return Outcome{{a->output}, {}, ""};
    };
  });
}

void add_exemplar(CLI::App& root, Chosen& chosen) {
  struct Arguments {
    std::string kind, output, size;
  };
  const auto a = std::make_shared<Arguments>();
  CLI::App* app = root.add_subcommand("exemplar", "Make a synthetic photo with its exact annotation and mask");
  app->add_option("kind", a->kind, "lightning, river, crack, vein or vessel")->required();
  app->add_option("-o,--output", a->output, "Writes NAME.png, NAME.ramify.json and NAME_mask.png")->required()->type_name("NAME");
  app->add_option("--size", a->size, "WIDTHxHEIGHT in px [the kind's own]")->type_name("WxH");
  add_shared(*app, chosen.shared);
  app->footer("Example:\n  ramify exemplar river --seed 4 -o river");
  app->callback([&chosen, a] {
    chosen.work = [&chosen, a](const Monitor& monitor) {
      const SyntheticKind kind = synthetic_kind(a->kind);
      const Size size = a->size.empty() ? natural_size(kind) : parse_size("size", a->size);
      const std::vector<std::string> outputs{a->output + ".png", a->output + ".ramify.json", a->output + "_mask.png"};
      check_outputs(chosen.shared, outputs, {});
      if (chosen.shared.no_clobber && file_exists(outputs[0]) && file_exists(outputs[1]) && file_exists(outputs[2])) {
        return Outcome{{}, outputs, ""};
      }
      SyntheticExemplar made = make_synthetic(kind, size, Rng(chosen.shared.seed), monitor.stage("draw", 0.0, 0.9));
      const std::string bytes = encode_image(".png", made.photo.color, nullptr, SaveOptions{});
      made.photo.name = outputs[0].substr(outputs[0].rfind('/') + 1);
      made.photo.sha256 = sha256_hex(bytes);
      write_file(outputs[0], bytes);
      save_mask(outputs[2], made.branch_mask);
      write_annotation(outputs[1], made.annotation, made.photo);
      return Outcome{outputs, {}, ""};
    };
  });
}

}  // namespace ramify::app
