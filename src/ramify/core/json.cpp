// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/core/json.h"

#include <cmath>
#include <nlohmann/json.hpp>
#include <unordered_set>

#include "ramify/core/error.h"
#include "ramify/core/options.h"

namespace ramify {
namespace {

// Builds the tree from nlohmann's events. Its parser keeps its own stack, so depth costs no call stack; ours is bounded.
class Builder : public nlohmann::json_sax<nlohmann::json> {
 public:
  Builder(std::string_view source, const std::string& name, const JsonLimits& limits)
      : source_(source), name_(name), limits_(limits) {}

  bool null() override { return put(Json()); }
  bool boolean(bool flag) override { return put(Json(flag)); }
  bool number_integer(std::int64_t number) override { return put(Json(number)); }
  bool number_unsigned(std::uint64_t number) override {
    if (number <= static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max())) {
      return put(Json(static_cast<std::int64_t>(number)));
    }
    return put(Json(static_cast<double>(number)));
  }
  bool number_float(double number, const std::string&) override { return put(Json(number)); }
  bool string(std::string& text) override { return put(Json(std::move(text))); }
  bool binary(nlohmann::json::binary_t&) override { return false; }
  bool start_array(std::size_t) override { return open(Json(Json::Array{})); }
  bool start_object(std::size_t) override { return open(Json(Json::Object{})); }
  bool end_array() override { return close(); }
  bool end_object() override { return close(); }
  bool key(std::string& name) override {
    Level& level = stack_.back();
    if (!level.keys.insert(name).second) {
      throw InputError(name_, path() + ": the key \"" + printable(name, 60) + "\" appears twice");
    }
    std::get<Json::Object>(level.node.value).push_back({std::move(name), Json()});
    return true;
  }
  bool parse_error(std::size_t position, const std::string&, const nlohmann::detail::exception& error) override {
    std::size_t line = 1, column = 1;
    for (std::size_t i = 0; i + 1 < position && i < source_.size(); ++i) {
      if (source_[i] == '\n') ++line, column = 1; else ++column;
    }
    throw InputError(name_ + ":" + std::to_string(line) + ":" + std::to_string(column),
                     "malformed JSON in " + path() + ": " + reason(error.what()));
  }

  Json take() { return std::move(root_); }

 private:
  struct Level {
    Json node;
    std::unordered_set<std::string> keys;
  };

  // nlohmann's sentence without its own prefix: "[json.exception…] parse error at line 1, column 5: …".
  static std::string reason(const std::string& what) {
    const std::size_t start = what.find(": ");
    const std::size_t bracket = what.find("] ");
    return printable(start != std::string::npos ? what.substr(start + 2)
                     : bracket != std::string::npos ? what.substr(bracket + 2) : what);
  }

  std::string path() const {
    std::string text = "$";
    for (const Level& level : stack_) {
      if (const auto* items = std::get_if<Json::Array>(&level.node.value)) {
        text += "[" + std::to_string(items->size()) + "]";
      } else if (const auto& members = std::get<Json::Object>(level.node.value); !members.empty()) {
        text += "." + printable(members.back().key, 60);
      }
    }
    return text;
  }
  bool open(Json node) {
    if (static_cast<int>(stack_.size()) >= limits_.depth) {
      throw LimitError(name_ + ": JSON nested deeper than " + std::to_string(limits_.depth) + " levels");
    }
    count();
    stack_.push_back({std::move(node), {}});
    return true;
  }
  bool close() {
    Json node = std::move(stack_.back().node);
    stack_.pop_back();
    place(std::move(node));
    return true;
  }
  bool put(Json value) {
    count();
    place(std::move(value));
    return true;
  }
  void place(Json value) {
    if (stack_.empty()) {
      root_ = std::move(value);
    } else if (auto* items = std::get_if<Json::Array>(&stack_.back().node.value)) {
      items->push_back(std::move(value));
    } else {
      std::get<Json::Object>(stack_.back().node.value).back().value = std::move(value);
    }
  }
  void count() {
    if (++values_ > limits_.values) {
      throw LimitError(name_ + ": more than " + std::to_string(limits_.values) + " JSON values");
    }
  }

  std::string_view source_;
  const std::string& name_;
  JsonLimits limits_;
  std::vector<Level> stack_;
  Json root_;
  std::size_t values_ = 0;
};

const char* kind_name(const Json& value) {
  static const char* const names[] = {"null", "true or false", "a whole number", "a number", "a text", "a list", "an object"};
  return names[value.value.index()];
}

// The path from `node` to `wanted` (found by its address), appended to `path`. The depth is bounded by the limit.
bool find_path(const Json& node, const Json* wanted, std::string& path) {
  if (&node == wanted) return true;
  const std::size_t length = path.size();
  if (const auto* items = std::get_if<Json::Array>(&node.value)) {
    for (std::size_t i = 0; i < items->size(); ++i) {
      path += "[" + std::to_string(i) + "]";
      if (find_path((*items)[i], wanted, path)) return true;
      path.resize(length);
    }
  } else if (const auto* members = std::get_if<Json::Object>(&node.value)) {
    for (const JsonMember& member : *members) {
      path += "." + printable(member.key, 60);
      if (find_path(member.value, wanted, path)) return true;
      path.resize(length);
    }
  }
  return false;
}

}  // namespace

Json::Json(Array items) : value(std::move(items)) {}
Json::Json(Object members) : value(std::move(members)) {}

const Json* Json::find(std::string_view key) const {
  if (const auto* members = std::get_if<Object>(&value)) {
    for (const JsonMember& member : *members) {
      if (member.key == key) return &member.value;
    }
  }
  return nullptr;
}

JsonDocument::JsonDocument(std::string_view text, std::string name, const JsonLimits& limits) : name_(std::move(name)) {
  if (text.size() > limits.bytes) {
    throw LimitError(name_ + ": JSON larger than " + std::to_string(limits.bytes >> 20) + " MB");
  }
  if (text.empty()) throw InputError(name_, "empty file");
  Builder builder(text, name_, limits);
  nlohmann::json::sax_parse(text.begin(), text.end(), &builder);
  root_ = builder.take();
}

void JsonDocument::fail(const Json& at, const std::string& reason) const {
  std::string path = "$";
  find_path(root_, &at, path);
  throw InputError(name_, path + ": " + reason);
}

int JsonDocument::check_format(std::string_view format, int newest) const {
  const std::string& found = text(member(root_, "format"));
  if (found != format) {
    fail(root_, "this is a \"" + printable(found, 60) + "\", not a \"" + std::string(format) + "\"");
  }
  const Json& version_value = member(root_, "version");
  const int version = integer(version_value, 1);
  if (version > newest) {
    fail(version_value, "made by a newer ramify (" + std::string(format) + " version " + std::to_string(version) +
                            "; this program reads up to version " + std::to_string(newest) + "); update ramify");
  }
  return version;
}

double JsonDocument::number(const Json& at, double low, double high) const {
  double value = 0.0;
  if (const auto* whole = std::get_if<std::int64_t>(&at.value)) {
    value = static_cast<double>(*whole);
  } else if (const auto* real = std::get_if<double>(&at.value)) {
    value = *real + 0.0;  // -0 becomes 0
  } else {
    fail(at, std::string("expected a number, found ") + kind_name(at));
  }
  if (value < low || value > high) {
    const bool below = value < low;
    fail(at, number_text(value) + (below ? " is below " : " is above ") + number_text(below ? low : high));
  }
  return value;
}

int JsonDocument::integer(const Json& at, int low, int high) const {
  const double value = number(at, low, high);
  if (value != std::floor(value)) fail(at, "expected a whole number, found " + number_text(value));
  return static_cast<int>(value);
}

bool JsonDocument::boolean(const Json& at) const {
  if (const auto* flag = std::get_if<bool>(&at.value)) return *flag;
  fail(at, std::string("expected true or false, found ") + kind_name(at));
}

const std::string& JsonDocument::text(const Json& at) const {
  const auto* text = std::get_if<std::string>(&at.value);
  if (!text) fail(at, std::string("expected a text, found ") + kind_name(at));
  if (text->find('\0') != std::string::npos) fail(at, "the text holds a NUL character");
  return *text;
}

const Json::Array& JsonDocument::array(const Json& at) const {
  if (const auto* items = std::get_if<Json::Array>(&at.value)) return *items;
  fail(at, std::string("expected a list, found ") + kind_name(at));
}

const Json::Array& JsonDocument::array(const Json& at, std::size_t count) const {
  const Json::Array& items = array(at);
  if (items.size() != count) {
    fail(at, "expected " + std::to_string(count) + " items, found " + std::to_string(items.size()));
  }
  return items;
}

const Json::Object& JsonDocument::object(const Json& at) const {
  if (const auto* members = std::get_if<Json::Object>(&at.value)) return *members;
  fail(at, std::string("expected an object, found ") + kind_name(at));
}

const Json& JsonDocument::member(const Json& at, std::string_view key) const {
  if (const Json* value = find(at, key)) return *value;
  fail(at, "the field \"" + std::string(key) + "\" is missing");
}

const Json* JsonDocument::find(const Json& at, std::string_view key) const {
  object(at);
  return at.find(key);
}

}  // namespace ramify
