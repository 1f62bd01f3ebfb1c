// SPDX-License-Identifier: GPL-3.0-or-later
#include <optional>

#include "ramify/core/error.h"
#include "ramify/core/json.h"
#include "ramify/core/options.h"
#include "ramify/skeleton/assemble.h"
#include "ramify/skeleton/draw.h"
#include "ramify/skeleton/skeleton_io.h"

namespace ramify {
namespace {

constexpr double kFarthest = 1e7;  // px; far beyond any picture, far below where doubles lose pixels
constexpr int kLargestSide = 1 << 30;
constexpr double kSmallestRadius = 1e-6;

int parent_of(const JsonDocument& doc, const Json& at, int index) {
  if (std::holds_alternative<std::nullptr_t>(at.value)) return kNone;
  const int parent = doc.integer(at, kNone);
  if (parent >= index) doc.fail(at, "the parent " + std::to_string(parent) + " must come before its child " + std::to_string(index));
  return parent;
}

void read_nodes(const JsonDocument& doc, Skeleton& skeleton) {
  const Json::Array& rows = doc.array(doc.member(doc.root(), "nodes"));
  for (const Json& row : rows) {
    const Json::Array& v = doc.array(row, 5);
    Node node;
    for (int k = 0; k < 3; ++k) node.position[k] = doc.number(v[k], -kFarthest, kFarthest);
    node.radius = doc.number(v[3], kSmallestRadius, kFarthest);
    node.parent = parent_of(doc, v[4], skeleton.count());
    skeleton.append(node);
  }
}

// An optional list with one whole number for every node.
std::optional<std::vector<int>> per_node(const JsonDocument& doc, const char* key, int count, int low) {
  const Json* list = doc.find(doc.root(), key);
  if (!list) return std::nullopt;
  std::vector<int> values;
  for (const Json& item : doc.array(*list, static_cast<std::size_t>(count))) values.push_back(doc.integer(item, low));
  return values;
}

void read_links(const JsonDocument& doc, Skeleton& skeleton) {
  const Json* links = doc.find(doc.root(), "loop_links");
  if (!links) return;
  for (const Json& link : doc.array(*links)) {
    const Json::Array& ends = doc.array(link, 2);
    const int a = doc.integer(ends[0], 0, skeleton.count() - 1), b = doc.integer(ends[1], 0, skeleton.count() - 1);
    if (a == b) doc.fail(link, "a loop link joins two different nodes");
    skeleton.loop_links.emplace_back(a, b);
  }
}

void append_list(std::string& out, const char* key, const Skeleton& skeleton, int Node::*field) {
  out += std::string(",\n\"") + key + "\": [";
  for (int i = 0; i < skeleton.count(); ++i) out += (i > 0 ? "," : "") + std::to_string(skeleton[i].*field);
  out += ']';
}

}  // namespace

LoadedSkeleton parse_skeleton_json(std::string_view text, const std::string& name) {
  const JsonDocument doc(text, name);
  doc.check_format("ramify-skeleton", 1);
  LoadedSkeleton loaded;
  Skeleton& skeleton = loaded.skeleton;
  const Json::Array& size = doc.array(doc.member(doc.root(), "size"), 2);
  skeleton.size = {doc.integer(size[0], 0, kLargestSide), doc.integer(size[1], 0, kLargestSide)};
  if (const Json* dim = doc.find(doc.root(), "dim")) skeleton.dim = doc.integer(*dim, 2, 3);
  read_nodes(doc, skeleton);
  if (const auto orders = per_node(doc, "order", skeleton.count(), 0)) {
    for (int i = 0; i < skeleton.count(); ++i) skeleton.set_order(i, (*orders)[i]);
  } else {
    count_orders(skeleton);
  }
  if (const auto tags = per_node(doc, "tags", skeleton.count(), std::numeric_limits<int>::min())) {
    for (int i = 0; i < skeleton.count(); ++i) skeleton.set_tag(i, (*tags)[i]);
  }
  read_links(doc, skeleton);
  return loaded;
}

std::string skeleton_json(const Skeleton& skeleton) {
  std::string out = "{\"format\": \"ramify-skeleton\", \"version\": 1,\n\"size\": [" + std::to_string(skeleton.size.width) +
                    "," + std::to_string(skeleton.size.height) + "], \"dim\": " + std::to_string(skeleton.dim) +
                    ",\n\"nodes\": [";
  for (int i = 0; i < skeleton.count(); ++i) {
    const Node& node = skeleton[i];
    out += i > 0 ? ",\n[" : "\n[";
    for (int k = 0; k < 3; ++k) out += number_text(node.position[k]) + ",";
    out += number_text(node.radius) + "," + std::to_string(node.parent) + "]";
  }
  out += "]";
  append_list(out, "order", skeleton, &Node::order);
  append_list(out, "tags", skeleton, &Node::tag);
  out += ",\n\"loop_links\": [";
  for (std::size_t k = 0; k < skeleton.loop_links.size(); ++k) {
    const auto& [a, b] = skeleton.loop_links[k];
    out += std::string(k > 0 ? "," : "") + "[" + std::to_string(a) + "," + std::to_string(b) + "]";
  }
  return out + "]}\n";
}

std::string furcations_json(const Skeleton& skeleton) {
  Json::Array list;
  for (const Furcation& f : list_furcations(skeleton)) {
    list.push_back(Json::Object{{"x", f.position.x()}, {"y", f.position.y()}, {"parent", f.parent_branch}, {"child", f.child_branch}});
  }
  return json_text(Json::Object{{"format", "ramify-furcations"}, {"version", 1}, {"furcations", std::move(list)}});
}

}  // namespace ramify
