// SPDX-License-Identifier: GPL-3.0-or-later
// Everything needed to make a result again: stored in every picture, read back by `replay`. Holds no time, host, thread
// count or output name.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "ramify/core/options.h"

namespace ramify {

struct RecipeInput {
  std::string role;    // "exemplar", "photo", "annotation", "regions", "density", "guide", "skeleton"
  std::string file;    // name without folder; "builtin:KIND" for ramify's own exemplars
  std::string sha256;  // of the file's bytes; empty for builtin
};

struct Recipe {
  std::string version;                         // of ramify
  std::string verb;                            // "synth", "grow", "render"
  std::uint64_t seed = 1;
  std::vector<RecipeInput> inputs;
  std::map<std::string, std::string> options;  // every option of the verb by its name, as text (core/options.h)
};

std::string recipe_text(const Recipe& recipe);  // JSON

// Throws InputError naming line and column or the JSON path: malformed text, duplicate keys, wrong types, a newer format
// version ("made by …").
Recipe parse_recipe(const std::string& json, const std::string& name);

// Every field's value by name.
std::map<std::string, std::string> option_values(const std::vector<OptionField>& fields);

// The path of the regular file with this sha256: in each folder in turn, and then in RAMIFY_PHOTOS, the one of this name,
// then any with the same extension. An empty folder is the current one. Digests are remembered for the life of the
// program. For builtin: just the name. Throws InputError naming the file, its sha256 and where it was looked for.
std::string find_input(const RecipeInput& input, const std::vector<std::string>& folders);

}  // namespace ramify
