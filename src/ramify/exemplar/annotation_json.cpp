// SPDX-License-Identifier: GPL-3.0-or-later
// NAME.ramify.json (docs/formats.md): written one branch a line, read strictly; every complaint names the JSON path.
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "ramify/core/atomic_file.h"
#include "ramify/core/error.h"
#include "ramify/core/options.h"
#include "ramify/exemplar/annotation.h"

namespace ramify {
namespace {

using Json = nlohmann::json;
constexpr std::size_t kFileLimit = 256u << 20;
constexpr int kDepthLimit = 64;
const std::vector<std::string> kPolarityNames{"dark", "bright", "glow"};
const std::vector<std::string> kRoleNames{"ignore", "outside", "keep", "landmark", "habitat"};

// A place in the document, for messages.
class Reader {
 public:
  Reader(const Json& json, std::string file, std::string path)
      : json_(json), file_(std::move(file)), path_(std::move(path)) {}

  [[noreturn]] void fail(const std::string& why) const {
    throw InputError(file_, (path_.empty() ? std::string("the document") : printable(path_)) + ": " + why);
  }
  const Json& json() const { return json_; }
  bool has(const char* key) const { return json_.is_object() && json_.contains(key); }
  Reader at(const char* key) const {
    if (!json_.is_object()) fail("must be an object {…}");
    if (!json_.contains(key)) fail("\"" + std::string(key) + "\" is missing");
    return {json_.at(key), file_, path_.empty() ? key : path_ + "." + key};
  }
  std::size_t count(std::size_t low, std::size_t high) const {
    if (!json_.is_array()) fail("must be a list […]");
    if (json_.size() < low || json_.size() > high) fail("has the wrong number of items");
    return json_.size();
  }
  Reader at(std::size_t i) const { return {json_.at(i), file_, path_ + "[" + std::to_string(i) + "]"}; }
  double number(double low, double high) const {
    if (!json_.is_number()) fail("must be a number");
    const double value = json_.get<double>();
    if (!(value >= low && value <= high)) {
      fail(number_text(value) + " is outside " + number_text(low) + " … " + number_text(high));
    }
    return value;
  }
  int integer(int low, int high) const {
    if (!json_.is_number_integer()) fail("must be a whole number");
    return static_cast<int>(number(low, high));
  }
  std::string text() const {
    if (!json_.is_string()) fail("must be a text");
    return json_.get<std::string>();
  }
  int choice(const std::vector<std::string>& names) const {
    const std::string value = text();
    for (std::size_t i = 0; i < names.size(); ++i) {
      if (names[i] == value) return static_cast<int>(i);
    }
    fail("\"" + printable(value, 40) + "\" is none of the known words");
  }

 private:
  const Json& json_;
  std::string file_;
  std::string path_;
};

// Parses with a limit on depth; a key that comes twice is an error, because either value might be meant.
Json parse_strictly(const std::string& text, const std::string& name) {
  std::vector<std::set<std::string>> keys;
  const Json::parser_callback_t check = [&](int depth, Json::parse_event_t event, Json& value) {
    if (depth > kDepthLimit) throw LimitError(name + ": nested deeper than " + std::to_string(kDepthLimit) + " levels");
    if (event == Json::parse_event_t::object_start) keys.emplace_back();
    if (event == Json::parse_event_t::object_end) keys.pop_back();
    if (event == Json::parse_event_t::key && !keys.back().insert(value.get<std::string>()).second) {
      throw InputError(name, "the key \"" + printable(value.get<std::string>(), 40) + "\" comes twice in one object");
    }
    return true;
  };
  try {
    return Json::parse(text, check);
  } catch (const Json::exception& e) {
    throw InputError(name, "not valid JSON: " + printable(e.what(), 300));
  }
}

BranchPoint read_branch_point(const Reader& in) {
  return {in.at("branch").integer(0, 1 << 30), in.at("point").integer(0, 1 << 30)};
}

Size read_size(const Reader& width, const Reader& height) {
  return {width.integer(1, 1 << 20), height.integer(1, 1 << 20)};
}

Vec2 read_point(const Reader& in, Size canvas) {
  // Points may lie outside the picture, but not absurdly far.
  const double reach = 2.0 * (canvas.width + canvas.height);
  return {in.at(std::size_t{0}).number(-reach, reach), in.at(std::size_t{1}).number(-reach, reach)};
}

AnnotatedBranch read_branch(const Reader& in, Size canvas) {
  AnnotatedBranch branch;
  if (in.has("parent") && !in.at("parent").json().is_null()) branch.parent = read_branch_point(in.at("parent"));
  const Reader points = in.at("points");
  const std::size_t count = points.count(branch.parent ? 1 : 2, 10'000'000);
  for (std::size_t i = 0; i < count; ++i) {
    const Reader point = points.at(i);
    point.count(3, 3);
    branch.points.push_back(read_point(point, canvas));
    branch.radii.push_back(point.at(2).number(1e-6, canvas.width + canvas.height));
  }
  if (in.has("confidence")) branch.confidence = in.at("confidence").number(0.0, 1.0);
  if (in.has("leaves_frame")) {
    if (!in.at("leaves_frame").json().is_boolean()) in.at("leaves_frame").fail("must be true or false");
    branch.leaves_frame = in.at("leaves_frame").json().get<bool>();
  }
  if (in.has("polarity")) branch.polarity = static_cast<Polarity>(in.at("polarity").choice(kPolarityNames));
  return branch;
}

void read_rectification(const Reader& in, Annotation& annotation) {
  if (!in.has("rectified_from_photo")) return;
  const Reader matrix = in.at("rectified_from_photo");
  matrix.count(9, 9);
  annotation.rectified_from_photo.emplace();
  for (std::size_t i = 0; i < 9; ++i) (*annotation.rectified_from_photo)[i] = matrix.at(i).number(-1e9, 1e9);
  const Reader size = in.at("rectified_size");
  size.count(2, 2);
  annotation.rectified_size = read_size(size.at(std::size_t{0}), size.at(1));
}

Json rounded_point(const Vec2& p) {
  return {std::round(p.x() * 100.0) / 100.0, std::round(p.y() * 100.0) / 100.0};
}

Json branch_json(const AnnotatedBranch& branch) {
  Json out;
  out["parent"] = branch.parent ? Json{{"branch", branch.parent->branch}, {"point", branch.parent->point}} : Json();
  Json points = Json::array();
  for (std::size_t i = 0; i < branch.points.size(); ++i) {
    Json point = rounded_point(branch.points[i]);
    point.push_back(std::max(0.01, std::round(branch.radii[i] * 100.0) / 100.0));
    points.push_back(std::move(point));
  }
  out["points"] = std::move(points);
  if (branch.confidence) out["confidence"] = std::round(*branch.confidence * 1000.0) / 1000.0;
  if (branch.leaves_frame) out["leaves_frame"] = *branch.leaves_frame;
  if (branch.polarity) out["polarity"] = kPolarityNames[static_cast<std::size_t>(*branch.polarity)];
  return out;
}

Json branch_point_json(const BranchPoint& p) { return {{"branch", p.branch}, {"point", p.point}}; }

template <class Items, class ToJson>
std::string list_text(const Items& items, ToJson&& to_json) {
  std::string text = "[";
  for (std::size_t i = 0; i < items.size(); ++i) text += (i ? ",\n    " : "\n    ") + to_json(items[i]).dump();
  return text + (items.empty() ? "]" : "\n  ]");
}

}  // namespace

Annotation parse_annotation(const std::string& json, const std::string& name) {
  const Json document = parse_strictly(json, name);
  const Reader in(document, name, "");
  if (in.at("format").text() != "ramify-annotation") {
    in.at("format").fail("this is not a ramify annotation; a skeleton goes with its photo: PHOTO --annotation FILE");
  }
  if (in.at("version").integer(1, 1 << 20) > 1) in.at("version").fail("made by a newer ramify; please update");
  Annotation annotation;
  const Reader photo = in.at("photo");
  annotation.photo_file = photo.at("file").text();
  annotation.photo_sha256 = photo.has("sha256") ? photo.at("sha256").text() : "";
  annotation.photo_size = read_size(photo.at("width"), photo.at("height"));
  read_rectification(in, annotation);
  const Size canvas = annotation.rectified_size.value_or(annotation.photo_size);
  const Reader branches = in.at("branches");
  for (std::size_t i = 0; i < branches.count(0, 10'000'000); ++i) {
    annotation.branches.push_back(read_branch(branches.at(i), canvas));
  }
  if (in.has("links")) {
    const Reader links = in.at("links");
    for (std::size_t i = 0; i < links.count(0, 10'000'000); ++i) {
      links.at(i).count(2, 2);
      annotation.links.emplace_back(read_branch_point(links.at(i).at(std::size_t{0})), read_branch_point(links.at(i).at(1)));
    }
  }
  if (in.has("regions")) {
    const Reader regions = in.at("regions");
    for (std::size_t i = 0; i < regions.count(0, 1'000'000); ++i) {
      Region region;
      region.role = static_cast<RegionRole>(regions.at(i).at("role").choice(kRoleNames));
      const Reader polygon = regions.at(i).at("polygon");
      for (std::size_t k = 0; k < polygon.count(3, 1'000'000); ++k) {
        polygon.at(k).count(2, 2);
        region.polygon.push_back(read_point(polygon.at(k), canvas));
      }
      annotation.regions.push_back(std::move(region));
    }
  }
  Json unknown = Json::object();
  static const std::set<std::string> known{"format", "version", "photo", "rectified_from_photo", "rectified_size",
                                           "branches", "links", "regions"};
  for (const auto& [key, value] : document.items()) {
    if (!known.count(key)) unknown[key] = value;
  }
  if (!unknown.empty()) annotation.unknown_fields = unknown.dump();
  try {
    skeleton_from_annotation(annotation);
  } catch (const InputError& error) {  // parents or links point nowhere
    throw InputError(name, error.what());
  }
  return annotation;
}

std::string annotation_text(const Annotation& annotation) {
  const Json photo{{"file", annotation.photo_file},
                   {"sha256", annotation.photo_sha256},
                   {"width", annotation.photo_size.width},
                   {"height", annotation.photo_size.height}};
  std::string text = "{\n  \"format\": \"ramify-annotation\",\n  \"version\": 1,\n  \"photo\": " + photo.dump();
  if (annotation.rectified_from_photo && annotation.rectified_size) {
    text += ",\n  \"rectified_from_photo\": " + Json(*annotation.rectified_from_photo).dump();
    text += ",\n  \"rectified_size\": " +
            Json{annotation.rectified_size->width, annotation.rectified_size->height}.dump();
  }
  text += ",\n  \"branches\": " + list_text(annotation.branches, branch_json);
  text += ",\n  \"links\": " + list_text(annotation.links, [](const auto& link) {
    return Json{branch_point_json(link.first), branch_point_json(link.second)};
  });
  text += ",\n  \"regions\": " + list_text(annotation.regions, [](const Region& region) {
    Json polygon = Json::array();
    for (const Vec2& p : region.polygon) polygon.push_back(rounded_point(p));
    return Json{{"role", kRoleNames[static_cast<std::size_t>(region.role)]}, {"polygon", std::move(polygon)}};
  });
  if (!annotation.unknown_fields.empty()) {
    const Json unknown = Json::parse(annotation.unknown_fields);
    for (const auto& [key, value] : unknown.items()) text += ",\n  " + Json(key).dump() + ": " + value.dump();
  }
  return text + "\n}\n";
}

Annotation load_annotation(const std::string& path) { return parse_annotation(read_file(path, kFileLimit), printable(path, 300)); }

void save_annotation(const Annotation& annotation, const std::string& path) {
  write_file(path, annotation_text(annotation));
}

}  // namespace ramify
