// SPDX-License-Identifier: GPL-3.0-or-later
// What a person (or `ramify trace`) says about a photo: where its branches run and how wide they are. Saved as
// NAME.ramify.json (docs/formats.md).
#pragma once

#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "ramify/core/types.h"
#include "ramify/skeleton/skeleton.h"

namespace ramify {

enum class Polarity { Dark, Bright, Glow };
enum class RegionRole { Ignore, Outside, Keep, Landmark, Habitat };

struct BranchPoint {
  int branch = kNone;
  int point = kNone;
};

struct AnnotatedBranch {
  std::optional<BranchPoint> parent;         // empty for a root branch
  std::vector<Vec2> points;                  // px of the oriented (or rectified) photo, base to tip, at least 2
  std::vector<double> radii;                 // px, one per point
  std::optional<double> confidence;          // 0..1
  std::optional<bool> leaves_frame;          // the tip is cut by the frame
  std::optional<Polarity> polarity;
};

struct Region {
  RegionRole role = RegionRole::Ignore;
  std::vector<Vec2> polygon;  // px
};

struct Annotation {
  std::string photo_file;    // relative to the annotation
  std::string photo_sha256;  // of the file's bytes, hexadecimal
  Size photo_size;           // after orientation
  std::optional<std::array<double, 9>> rectified_from_photo;  // row-major homography, h33 = 1
  std::optional<Size> rectified_size;
  std::vector<AnnotatedBranch> branches;
  std::vector<std::pair<BranchPoint, BranchPoint>> links;  // edges that close loops
  std::vector<Region> regions;
  std::string unknown_fields;  // JSON text of fields this version does not know, kept on a round trip
};

// Branches as a skeleton on the (rectified) photo's canvas. Continuations get the lowest index, orders are counted.
Skeleton skeleton_from_annotation(const Annotation& annotation);
Annotation annotation_from_skeleton(const Skeleton& skeleton);

// Throws InputError with the JSON path of what is wrong.
Annotation load_annotation(const std::string& path);
Annotation parse_annotation(const std::string& json, const std::string& name);
void save_annotation(const Annotation& annotation, const std::string& path);
std::string annotation_text(const Annotation& annotation);

}  // namespace ramify
