// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/recipe/recipe.h"

#include <algorithm>

#include "ramify/core/error.h"
#include "ramify/core/json.h"

namespace ramify {
namespace {

constexpr const char* kFormat = "ramify-recipe";
constexpr int kVersion = 1;
constexpr std::size_t kMaxBytes = 16u << 20;
constexpr std::string_view kBuiltin = "builtin:";

// Names of verbs, roles and options: what a command line can hold without quotes.
bool is_word(const std::string& text) {
  return !text.empty() && text.size() <= 64 && std::all_of(text.begin(), text.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '-' || c == '_';
  });
}

bool is_digest(const std::string& text) {
  return text.size() == 64 && text.find_first_not_of("0123456789abcdef") == std::string::npos;
}

// A recipe comes from a stranger's file: its names must not lead out of the folder it is read from.
bool is_file_name(const std::string& text) {
  return !text.empty() && text.size() <= 255 && text != "." && text != ".." && text.find('/') == std::string::npos;
}

std::string read_word(const JsonDocument& document, const Json& at) {
  const std::string& text = document.text(at);
  if (!is_word(text)) document.fail(at, "expected a word of a-z, 0-9 and -, got '" + printable(text, 60) + "'");
  return text;
}

// Seeds above 2^63 - 1 do not fit JSON readers; they are written as text.
Json seed_json(std::uint64_t seed) {
  const bool fits = seed <= static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max());
  return fits ? Json(static_cast<std::int64_t>(seed)) : Json(std::to_string(seed));
}

std::uint64_t read_seed(const JsonDocument& document, const Json& at) {
  if (const auto* number = std::get_if<std::int64_t>(&at.value)) {
    if (*number >= 0) return static_cast<std::uint64_t>(*number);
  } else if (const auto* digits = std::get_if<std::string>(&at.value)) {
    const bool plain =
        !digits->empty() && digits->size() <= 20 && digits->find_first_not_of("0123456789") == std::string::npos;
    std::uint64_t value = 0;
    bool fits = plain;
    for (std::size_t i = 0; fits && i < digits->size(); ++i) {
      const std::uint64_t digit = static_cast<std::uint64_t>((*digits)[i] - '0');
      fits = value <= (std::numeric_limits<std::uint64_t>::max() - digit) / 10;
      value = 10 * value + digit;
    }
    if (fits) return value;
  }
  document.fail(at, "expected a whole number from 0 to 18446744073709551615");
}

void check_members(const JsonDocument& document, const Json& object, const std::vector<std::string_view>& known) {
  for (const JsonMember& member : document.object(object)) {
    if (std::find(known.begin(), known.end(), member.key) == known.end()) {
      document.fail(member.value, "is not a part of a recipe of version " + std::to_string(kVersion));
    }
  }
}

RecipeInput read_input(const JsonDocument& document, const Json& at) {
  check_members(document, at, {"role", "file", "sha256"});
  RecipeInput input;
  input.role = read_word(document, document.member(at, "role"));
  const Json& file = document.member(at, "file");
  input.file = document.text(file);
  const bool traced = input.role == "annotation" && input.file == "auto";
  const bool builtin = input.file.starts_with(kBuiltin);
  if (builtin ? !is_word(input.file.substr(kBuiltin.size())) : !is_file_name(input.file)) {
    document.fail(file, "expected a file name without folders, got '" + printable(input.file, 60) + "'");
  }
  const Json& sha256 = document.member(at, "sha256");
  input.sha256 = document.text(sha256);
  const bool no_file = builtin || traced;
  if (no_file ? !input.sha256.empty() : !is_digest(input.sha256)) {
    document.fail(sha256, no_file ? "there is no file to have one" : "expected 64 hexadecimal digits");
  }
  return input;
}

}  // namespace

std::string recipe_text(const Recipe& recipe) {
  Json::Array inputs;
  for (const RecipeInput& input : recipe.inputs) {
    inputs.push_back(Json::Object{{"role", input.role}, {"file", input.file}, {"sha256", input.sha256}});
  }
  Json::Object options;
  for (const auto& [name, value] : recipe.options) options.push_back({name, value});
  return json_text(Json::Object{{"format", kFormat},
                                {"version", kVersion},
                                {"ramify", recipe.version},
                                {"verb", recipe.verb},
                                {"seed", seed_json(recipe.seed)},
                                {"inputs", std::move(inputs)},
                                {"options", std::move(options)}});
}

Recipe parse_recipe(const std::string& json, const std::string& name) {
  const JsonDocument document(json, name, {.bytes = kMaxBytes});
  document.check_format(kFormat, kVersion);
  const Json& root = document.root();
  check_members(document, root, {"format", "version", "ramify", "verb", "seed", "inputs", "options"});
  Recipe recipe;
  recipe.version = document.text(document.member(root, "ramify"));
  recipe.verb = read_word(document, document.member(root, "verb"));
  recipe.seed = read_seed(document, document.member(root, "seed"));
  for (const Json& input : document.array(document.member(root, "inputs"))) {
    recipe.inputs.push_back(read_input(document, input));
  }
  for (const JsonMember& option : document.object(document.member(root, "options"))) {
    if (!is_word(option.key)) document.fail(option.value, "is not the name of an option");
    recipe.options[option.key] = document.text(option.value);
  }
  return recipe;
}

std::map<std::string, std::string> option_values(const std::vector<OptionField>& fields) {
  std::map<std::string, std::string> values;
  for (const OptionField& field : fields) values[field.name] = get_text(field);
  return values;
}

}  // namespace ramify
