// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/skeleton/skeleton_io.h"

#include <algorithm>
#include <cctype>

#include "ramify/core/atomic_file.h"
#include "ramify/core/error.h"

namespace ramify {
namespace {

std::string extension_of(const std::string& path) {
  const std::size_t dot = path.find_last_of("./");
  if (dot == std::string::npos || path[dot] != '.') return "";
  std::string extension = path.substr(dot + 1);
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

}  // namespace

LoadedSkeleton parse_skeleton(std::string_view bytes, const std::string& name) {
  if (bytes.substr(0, 3) == "\xEF\xBB\xBF") bytes.remove_prefix(3);
  const std::size_t start = bytes.find_first_not_of(" \t\r\n");
  if (start == std::string_view::npos) throw InputError(name, "empty file");
  if (bytes.substr(0, 4096).find('\0') != std::string_view::npos) {
    throw InputError(name, "this is no skeleton: neither JSON nor SWC nor SVG (it holds NUL bytes)");
  }
  switch (bytes[start]) {
    case '{':
    case '[':
      return parse_skeleton_json(bytes, name);
    case '<':
      return parse_svg_skeleton(bytes, name);
    default:
      return parse_swc(bytes, name);
  }
}

LoadedSkeleton load_skeleton(const std::string& path, std::size_t limit) {
  return parse_skeleton(read_file(path, limit), printable(path));
}

void check_skeleton_name(const std::string& path) {
  const std::string extension = extension_of(path);
  for (const char* known : {"json", "swc", "svg", "geojson"}) {
    if (extension == known) return;
  }
  throw OptionError("output", "'" + printable(path) + "'", "skeletons are written as .json, .swc, .svg or .geojson");
}

void save_skeleton(const Skeleton& skeleton, const std::string& path) {
  check_skeleton_name(path);
  const std::string extension = extension_of(path);
  write_file(path, extension == "json"  ? skeleton_json(skeleton)
                   : extension == "swc" ? swc_text(skeleton)
                   : extension == "svg" ? svg_text(skeleton)
                                        : geojson_text(skeleton));
}

}  // namespace ramify
