// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <stdexcept>

#include "ramify/core/json.h"
#include "ramify/core/options.h"

namespace ramify {
namespace {

// Length in bytes of the well-formed UTF-8 character at `at`, or 0 (RFC 3629: no overlong forms, no surrogates).
std::size_t utf8_length(std::string_view text, std::size_t at) {
  const auto byte = [&](std::size_t k) { return at + k < text.size() ? static_cast<unsigned char>(text[at + k]) : 0u; };
  const auto tail = [&](std::size_t k) { return (byte(k) & 0xC0u) == 0x80u; };
  const unsigned lead = byte(0);
  if (lead < 0x80) return 1;
  if (lead >= 0xC2 && lead <= 0xDF && tail(1)) return 2;
  if (lead >= 0xE0 && lead <= 0xEF && tail(1) && tail(2)) {
    return (lead == 0xE0 && byte(1) < 0xA0) || (lead == 0xED && byte(1) >= 0xA0) ? 0 : 3;
  }
  if (lead >= 0xF0 && lead <= 0xF4 && tail(1) && tail(2) && tail(3)) {
    return (lead == 0xF0 && byte(1) < 0x90) || (lead == 0xF4 && byte(1) >= 0x90) ? 0 : 4;
  }
  return 0;
}

bool is_plain(const Json& value) { return value.value.index() < 5; }

// Lists of plain values stay on one line.
bool is_flat(const Json::Array& items) {
  for (const Json& item : items) {
    if (!is_plain(item)) return false;
  }
  return true;
}

void write(const Json& value, int indent, std::string& out);

void write_array(const Json::Array& items, int indent, std::string& out) {
  const bool flat = is_flat(items);
  const std::string margin = flat ? "" : "\n" + std::string(static_cast<std::size_t>(indent) + 1, ' ');
  out += '[';
  for (std::size_t i = 0; i < items.size(); ++i) {
    if (i > 0) out += flat ? ", " : ",";
    out += margin;
    write(items[i], indent + 1, out);
  }
  if (!flat) out += "\n" + std::string(static_cast<std::size_t>(indent), ' ');
  out += ']';
}

void write_object(const Json::Object& members, int indent, std::string& out) {
  const std::string margin = "\n" + std::string(static_cast<std::size_t>(indent) + 1, ' ');
  out += '{';
  for (std::size_t i = 0; i < members.size(); ++i) {
    if (i > 0) out += ',';
    out += margin + json_quoted(members[i].key) + ": ";
    write(members[i].value, indent + 1, out);
  }
  if (!members.empty()) out += "\n" + std::string(static_cast<std::size_t>(indent), ' ');
  out += '}';
}

void write(const Json& value, int indent, std::string& out) {
  if (const auto* flag = std::get_if<bool>(&value.value)) {
    out += *flag ? "true" : "false";
  } else if (const auto* whole = std::get_if<std::int64_t>(&value.value)) {
    out += std::to_string(*whole);
  } else if (const auto* real = std::get_if<double>(&value.value)) {
    if (!std::isfinite(*real)) throw std::invalid_argument("json_text: a number is not finite");
    out += number_text(*real);
  } else if (const auto* text = std::get_if<std::string>(&value.value)) {
    out += json_quoted(*text);
  } else if (const auto* items = std::get_if<Json::Array>(&value.value)) {
    write_array(*items, indent, out);
  } else if (const auto* members = std::get_if<Json::Object>(&value.value)) {
    write_object(*members, indent, out);
  } else {
    out += "null";
  }
}

}  // namespace

std::string json_text(const Json& value) {
  std::string out;
  write(value, 0, out);
  out += '\n';
  return out;
}

std::string json_quoted(std::string_view text) {
  static const char* const digits = "0123456789abcdef";
  std::string out = "\"";
  for (std::size_t i = 0; i < text.size();) {
    const unsigned char c = static_cast<unsigned char>(text[i]);
    const std::size_t length = utf8_length(text, i);
    if (length == 0) {
      out += "\xEF\xBF\xBD";
      ++i;
      continue;
    }
    if (c == '"' || c == '\\') {
      out += '\\', out += static_cast<char>(c);
    } else if (c == '\n') {
      out += "\\n";
    } else if (c < 0x20 || c == 0x7F) {
      out += std::string("\\u00") + digits[c >> 4] + digits[c & 15];
    } else {
      out += text.substr(i, length);
    }
    i += length;
  }
  return out + '"';
}

}  // namespace ramify
