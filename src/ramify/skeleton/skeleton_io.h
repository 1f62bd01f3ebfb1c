// SPDX-License-Identifier: GPL-3.0-or-later
// Skeletons in files (docs/formats.md). JSON keeps everything; SWC is what neuron tools read; SVG shows and can be edited
// in a drawing program; GeoJSON is written only.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "ramify/skeleton/skeleton.h"

namespace ramify {

struct LoadedSkeleton {
  Skeleton skeleton;
  std::vector<std::string> notes;  // sentences: what was repaired, cut or guessed
};

// The kind is found from the content, never from the name. Throws InputError (with line, or JSON path) for what cannot be
// used, LimitError for more than `limit` bytes.
inline constexpr std::size_t kSkeletonFileLimit = 256u << 20;
LoadedSkeleton load_skeleton(const std::string& path, std::size_t limit = kSkeletonFileLimit);
LoadedSkeleton parse_skeleton(std::string_view bytes, const std::string& name);

// The kind is chosen by the extension: .json .swc .svg .geojson; throws OptionError for others. Whole or not at all.
void check_skeleton_name(const std::string& path);
void save_skeleton(const Skeleton& skeleton, const std::string& path);

// `ramify-skeleton` version 1: {"format", "version", "size": [w, h], "dim": 2|3, "nodes": [[x, y, z, r, parent], …],
// "order": […], "tags": […], "loop_links": [[i, j], …]}. A root's parent is -1 or null. Parents must come first. Unknown
// fields are ignored; "order" (counted), "tags" (0) and "loop_links" may be missing.
LoadedSkeleton parse_skeleton_json(std::string_view text, const std::string& name);
std::string skeleton_json(const Skeleton& skeleton);

// SWC: rows `id type x y z radius parent`, px, in any order, separated by blanks, tabs or commas. With our header
// `# ramify canvas W H` the continuation is the child listed first; without it (foreign files) children are ordered by
// ALGORITHMS 3.3-9 and the canvas is the nodes' extent. Missing parents make roots, parent cycles are cut into loop
// links, radii that are not positive are taken from the parent: each with a note. Loops travel as comments
// `# ramify loop ID ID`, which other programs skip.
LoadedSkeleton parse_swc(std::string_view text, const std::string& name);
std::string swc_text(const Skeleton& skeleton);

// SVG: every path becomes one branch. Files of ours carry radii and parents as data attributes and come back whole; in
// foreign ones the radius is half the stroke width, and a path that starts within a pixel (or the other's radius) of an
// earlier path is its child. Nothing but paths is read: no entities, no scripts, no references.
LoadedSkeleton parse_svg_skeleton(std::string_view text, const std::string& name);
// Two layers: "centre-lines", and "outlines" whose fill is exactly the union of the branches' round cones. Pixel centres
// are at half integers in SVG, so 0.5 is added.
std::string svg_text(const Skeleton& skeleton);

// A FeatureCollection with a LineString per branch (px + 0.5, y down) and its radii, order and parent as properties.
std::string geojson_text(const Skeleton& skeleton);

// What a training set needs beside the masks: {"format": "ramify-furcations", "version": 1, "furcations": [{"x", "y",
// "parent", "child"}, …]} with branch ids as in the masks (draw.h).
std::string furcations_json(const Skeleton& skeleton);

}  // namespace ramify
