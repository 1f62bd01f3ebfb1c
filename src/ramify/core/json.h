// SPDX-License-Identifier: GPL-3.0-or-later
// JSON as ramify reads and writes it. Reading is strict: malformed text is refused with line and column, a key given
// twice, a number out of range and nesting deeper than 64 are refused, and a value of the wrong kind is named by its
// path ("$.nodes[3][1]").
#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace ramify {

struct JsonMember;

// A value. Objects keep the order of their members.
struct Json {
  using Array = std::vector<Json>;
  using Object = std::vector<JsonMember>;
  std::variant<std::nullptr_t, bool, std::int64_t, double, std::string, Array, Object> value = nullptr;

  Json() = default;
  Json(std::nullptr_t) {}
  Json(bool flag) : value(flag) {}
  Json(int number) : value(static_cast<std::int64_t>(number)) {}
  Json(std::int64_t number) : value(number) {}
  Json(double number) : value(number) {}  // must be finite to be written
  Json(const char* text) : value(std::string(text)) {}
  Json(std::string text) : value(std::move(text)) {}
  Json(Array items);
  Json(Object members);

  const Json* find(std::string_view key) const;  // nullptr when this is no object or has no such member
};

struct JsonMember {
  std::string key;
  Json value;
};

struct JsonLimits {
  std::size_t bytes = 256u << 20;  // largest text
  int depth = 64;                  // deepest nesting
  std::size_t values = 30'000'000; // most values in one document
};

// A parsed text and its name, through which values are read: every complaint names the file and the path.
class JsonDocument {
 public:
  // Throws InputError for malformed text, LimitError for too much of it. `name` is what messages call it.
  JsonDocument(std::string_view text, std::string name, const JsonLimits& limits = {});

  const Json& root() const { return root_; }
  const std::string& name() const { return name_; }

  // The root must be an object with "format": `format` and a whole "version" from 1 to `newest`. Returns the version.
  int check_format(std::string_view format, int newest) const;

  // All take values that belong to this document and throw InputError when they are of another kind or out of range.
  double number(const Json& at, double low = std::numeric_limits<double>::lowest(),
                double high = std::numeric_limits<double>::max()) const;
  int integer(const Json& at, int low = std::numeric_limits<int>::min(),
              int high = std::numeric_limits<int>::max()) const;
  bool boolean(const Json& at) const;
  const std::string& text(const Json& at) const;  // without NUL bytes
  const Json::Array& array(const Json& at) const;
  const Json::Array& array(const Json& at, std::size_t count) const;  // of exactly `count` items
  const Json::Object& object(const Json& at) const;
  const Json& member(const Json& object, std::string_view key) const;  // must be there
  const Json* find(const Json& object, std::string_view key) const;    // nullptr when absent; `object` must be one

  // Throws InputError "name: $.path: reason".
  [[noreturn]] void fail(const Json& at, const std::string& reason) const;

 private:
  std::string name_;
  Json root_;
};

// Text that reads back as the same value; the same in every locale. Objects take one line a member, arrays of plain
// numbers or texts one line, arrays of arrays one line an item. Throws std::invalid_argument for NaN and infinity.
std::string json_text(const Json& value);

// A text in quotes, escaped. Broken UTF-8 becomes U+FFFD.
std::string json_quoted(std::string_view text);

}  // namespace ramify
