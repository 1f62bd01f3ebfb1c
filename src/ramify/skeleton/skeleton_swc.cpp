// SPDX-License-Identifier: GPL-3.0-or-later
// SWC as it is found: INCF columns, SWC+ headers, CRLF or CR, tabs, commas, blank lines, byte order marks, any order.
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <unordered_map>

#include "ramify/core/error.h"
#include "ramify/core/options.h"
#include "ramify/skeleton/assemble.h"
#include "ramify/skeleton/skeleton_io.h"

namespace ramify {
namespace {

constexpr double kFarthest = 1e7;      // px, as in JSON
constexpr double kLargestId = 9e15;    // whole numbers are exact in doubles up to here
constexpr int kColumns = 7;            // id type x y z radius parent; further columns are other programs' business

struct Row {
  std::int64_t id = 0;
  std::int64_t parent = 0;
};

// What a file says, before it is put in order.
struct SwcFile {
  std::vector<Row> rows;
  std::vector<LooseNode> nodes;
  std::optional<Size> canvas;  // only in files of ours
  std::vector<std::pair<std::int64_t, std::int64_t>> loops;
  bool deep = false;  // some z is not 0
};

using Words = std::vector<std::string>;

Words split(std::string_view line, std::string_view separators) {
  Words words;
  for (std::size_t at = 0; (at = line.find_first_not_of(separators, at)) != std::string_view::npos;) {
    const std::size_t end = std::min(line.find_first_of(separators, at), line.size());
    words.emplace_back(line.substr(at, end - at));
    at = end;
  }
  return words;
}

std::optional<std::int64_t> whole_number(const std::string& word) {
  double value = 0.0;
  if (!parse_number(word, value) || std::abs(value) > kLargestId || value != std::floor(value)) return std::nullopt;
  return static_cast<std::int64_t>(value);
}

void read_comment(std::string_view comment, SwcFile& file) {
  const Words words = split(comment, " \t#");
  if (words.size() != 4 || words[0] != "ramify") return;
  const auto a = whole_number(words[2]), b = whole_number(words[3]);
  if (!a || !b) return;
  if (words[1] == "canvas" && *a >= 0 && *b >= 0 && *a <= (1 << 30) && *b <= (1 << 30)) {
    file.canvas = Size{static_cast<int>(*a), static_cast<int>(*b)};
  } else if (words[1] == "loop") {
    file.loops.emplace_back(*a, *b);
  }
}

void read_row(std::string_view line, const std::string& place, SwcFile& file) {
  Words words = split(line, " \t\v\f");
  if (words.size() >= kColumns) {
    for (std::string& word : words) {
      if (!word.empty() && word.back() == ',') word.pop_back();  // "1, 2, 3"
      if (word.find(',') != std::string::npos) {
        throw InputError(place, "'" + printable(word, 40) + "' is no number; write decimals with a point");
      }
    }
  } else {
    words = split(line, " \t\v\f,;");
  }
  if (words.size() < kColumns) {
    throw InputError(place, "expected 7 numbers (id type x y z radius parent), found " + std::to_string(words.size()) +
                                " in '" + printable(std::string(line), 60) + "'");
  }
  std::array<double, kColumns> v{};
  for (int k = 0; k < kColumns; ++k) {
    if (!parse_number(words[k], v[k])) throw InputError(place, "'" + printable(words[k], 40) + "' is no number");
  }
  const auto id = whole_number(words[0]), parent = whole_number(words[6]);
  if (!id || !parent) throw InputError(place, "the id and the parent must be whole numbers");
  LooseNode node;
  for (int k = 0; k < 3; ++k) {
    if (std::abs(v[k + 2]) > kFarthest) throw InputError(place, "a position beyond " + number_text(kFarthest) + " px");
    node.position[k] = v[k + 2] + 0.0;
  }
  if (v[5] > kFarthest) throw InputError(place, "a radius beyond " + number_text(kFarthest) + " px");
  node.radius = v[5];
  file.deep = file.deep || node.position.z() != 0.0;
  file.rows.push_back({*id, *parent});
  file.nodes.push_back(node);
}

SwcFile read_lines(std::string_view text, const std::string& name) {
  SwcFile file;
  int number = 0;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find_first_of("\r\n", at), text.size());
    std::string_view line = text.substr(at, end - at);
    at = end + (text.substr(end, 2) == "\r\n" ? 2 : 1);
    ++number;
    if (const std::size_t hash = line.find('#'); hash != std::string_view::npos) {
      read_comment(line.substr(hash), file);
      line = line.substr(0, hash);
    }
    if (line.find_first_not_of(" \t\v\f,;") == std::string_view::npos) continue;
    read_row(line, name + ":" + std::to_string(number), file);
  }
  if (file.nodes.empty()) throw InputError(name, "no SWC rows (id type x y z radius parent)");
  return file;
}

// Turns ids into indices. Returns the index of every id.
std::unordered_map<std::int64_t, int> link_rows(SwcFile& file, const std::string& name, std::vector<std::string>& notes) {
  std::unordered_map<std::int64_t, int> index_of;
  for (std::size_t i = 0; i < file.rows.size(); ++i) {
    if (!index_of.emplace(file.rows[i].id, static_cast<int>(i)).second) {
      throw InputError(name, "the id " + std::to_string(file.rows[i].id) + " appears twice");
    }
  }
  int missing = 0, own = 0;
  std::int64_t example = 0;
  for (std::size_t i = 0; i < file.rows.size(); ++i) {
    if (file.rows[i].parent < 0) continue;
    const auto found = index_of.find(file.rows[i].parent);
    if (found == index_of.end()) {
      // Some programs write 0 for "no parent".
      if (file.rows[i].parent != 0) ++missing, example = file.rows[i].parent;
    } else if (found->second == static_cast<int>(i)) {
      ++own;
    } else {
      file.nodes[i].parent = found->second;
    }
  }
  if (missing > 0) {
    notes.push_back(std::to_string(missing) + " nodes name a parent that is not there (such as " + std::to_string(example) +
                    "); they became roots");
  }
  if (own > 0) notes.push_back(std::to_string(own) + " nodes are their own parent; they became roots");
  return index_of;
}

// Radii that are not positive take the nearest positive one on the way to the root, or 1 px.
void repair_radii(std::vector<LooseNode>& nodes, std::vector<std::string>& notes) {
  int repaired = 0;
  std::vector<int> way;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (nodes[i].radius > 0.0) continue;
    way.clear();
    int k = static_cast<int>(i);
    for (; k != kNone && !(nodes[k].radius > 0.0); k = nodes[k].parent) way.push_back(k);
    const double radius = k == kNone ? 1.0 : nodes[k].radius;
    for (const int w : way) nodes[w].radius = radius;
    repaired += static_cast<int>(way.size());
  }
  if (repaired > 0) notes.push_back(std::to_string(repaired) + " radii were not positive; each took its parent's");
}

Size extent(const std::vector<LooseNode>& nodes) {
  double x = 0.0, y = 0.0;
  for (const LooseNode& node : nodes) {
    x = std::max(x, node.position.x() + node.radius);
    y = std::max(y, node.position.y() + node.radius);
  }
  return {static_cast<int>(x) + 1, static_cast<int>(y) + 1};
}

}  // namespace

LoadedSkeleton parse_swc(std::string_view text, const std::string& name) {
  if (text.substr(0, 3) == "\xEF\xBB\xBF") text.remove_prefix(3);
  LoadedSkeleton loaded;
  SwcFile file = read_lines(text, name);
  const auto index_of = link_rows(file, name, loaded.notes);
  const auto cut = cut_cycles(file.nodes);
  if (!cut.empty()) {
    loaded.notes.push_back(std::to_string(cut.size()) + " parent cycles were cut open; the cut edges are kept as loop links");
  }
  repair_radii(file.nodes, loaded.notes);
  if (!file.canvas) {
    const Size size = extent(file.nodes);
    loaded.notes.push_back("no canvas size in the file; taken from its nodes: " + std::to_string(size.width) + " x " +
                           std::to_string(size.height) + " px");
  }
  const Assembled assembled = assemble_skeleton(file.nodes, file.canvas ? *file.canvas : extent(file.nodes),
                                                file.canvas ? ContinuationRule::AsListed : ContinuationRule::Straightest);
  loaded.skeleton = assembled.skeleton;
  loaded.skeleton.dim = file.deep ? 3 : 2;
  for (const auto& [a, b] : cut) {
    loaded.skeleton.loop_links.emplace_back(assembled.index_of[a], assembled.index_of[b]);
  }
  for (const auto& [a, b] : file.loops) {
    const auto from = index_of.find(a), to = index_of.find(b);
    if (from == index_of.end() || to == index_of.end() || from == to) continue;
    loaded.skeleton.loop_links.emplace_back(assembled.index_of[from->second], assembled.index_of[to->second]);
  }
  return loaded;
}

std::string swc_text(const Skeleton& skeleton) {
  std::string out = "# ramify canvas " + std::to_string(skeleton.size.width) + " " + std::to_string(skeleton.size.height) +
                    "\n# id type x y z radius parent, px\n";
  for (const auto& [a, b] : skeleton.loop_links) {
    out += "# ramify loop " + std::to_string(a + 1) + " " + std::to_string(b + 1) + "\n";
  }
  for (int i = 0; i < skeleton.count(); ++i) {
    const Node& node = skeleton[i];
    out += std::to_string(i + 1) + " 0";
    for (int k = 0; k < 3; ++k) out += " " + number_text(node.position[k]);
    out += " " + number_text(node.radius) + " " + std::to_string(node.parent == kNone ? -1 : node.parent + 1) + "\n";
  }
  return out;
}

}  // namespace ramify
