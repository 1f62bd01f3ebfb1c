// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/core/options.h"

#include <charconv>
#include <cmath>

namespace ramify {
namespace {

template <class T>
OptionField make_number(std::string name, T& value, double low, double high, std::string unit, std::string help) {
  OptionField field;
  field.name = std::move(name);
  field.value = &value;
  field.low = low;
  field.high = high;
  field.unit = std::move(unit);
  field.help = std::move(help);
  return field;
}

// Without an exponent where people count: 100000, not 1e+05.
std::string plain_text(double value) {
  constexpr double kLongest = 1e12;
  return std::trunc(value) == value && std::abs(value) <= kLongest ? std::to_string(static_cast<long long>(value))
                                                                   : number_text(value);
}

std::string range_text(const OptionField& field) {
  const std::string unit = field.unit.empty() || field.unit == "N" ? "" : " " + field.unit;  // N is a count
  if (std::isinf(field.low) && std::isinf(field.high)) return "a number" + (unit.empty() ? "" : " in" + unit);
  if (std::isinf(field.high)) return "at least " + plain_text(field.low) + unit;
  return "from " + plain_text(field.low) + " to " + plain_text(field.high) + unit;
}

std::string list_text(const std::vector<std::string>& names) {
  std::string out;
  for (const std::string& name : names) out += (out.empty() ? "" : ", ") + name;
  return out;
}

}  // namespace

OptionField flag(std::string name, bool& value, std::string help) {
  return make_number(std::move(name), value, 0.0, 1.0, "", std::move(help));
}

OptionField number(std::string name, int& value, int low, int high, std::string unit, std::string help) {
  return make_number(std::move(name), value, low, high, std::move(unit), std::move(help));
}

OptionField number(std::string name, double& value, double low, double high, std::string unit, std::string help) {
  return make_number(std::move(name), value, low, high, std::move(unit), std::move(help));
}

OptionField text(std::string name, std::string& value, std::string help) {
  return make_number(std::move(name), value, 0.0, 0.0, "", std::move(help));
}

std::string number_text(double value) {
  char buffer[64];
  const auto result = std::to_chars(buffer, buffer + sizeof buffer, value);
  return std::string(buffer, result.ptr);
}

bool parse_number(const std::string& text, double& value) {
  const char* begin = text.data();
  const char* end = begin + text.size();
  if (begin != end && *begin == '+') ++begin;
  double read = 0.0;
  const auto result = std::from_chars(begin, end, read);
  if (begin == end || result.ec != std::errc() || result.ptr != end || !std::isfinite(read)) return false;
  value = read;
  return true;
}

std::string get_text(const OptionField& field) {
  struct Visitor {
    std::string operator()(const bool* v) const { return *v ? "true" : "false"; }
    std::string operator()(const int* v) const { return std::to_string(*v); }
    std::string operator()(const double* v) const { return number_text(*v); }
    std::string operator()(const std::string* v) const { return *v; }
    std::string operator()(const ChoiceRef& v) const { return v.names.at(v.get()); }
  };
  return std::visit(Visitor{}, field.value);
}

void set_text(OptionField& field, const std::string& text) {
  const auto fail = [&](const std::string& allowed) {
    throw OptionError(field.name, "'" + printable(text, 60) + "'", "expected " + allowed);
  };
  const auto read = [&] {
    double value = 0.0;
    if (!parse_number(text, value) || value < field.low || value > field.high) fail(range_text(field));
    return value;
  };
  if (auto* flag_value = std::get_if<bool*>(&field.value)) {
    if (text != "true" && text != "false") fail("true or false");
    **flag_value = text == "true";
  } else if (auto* whole = std::get_if<int*>(&field.value)) {
    const double value = read();
    // "1e3" is likelier a slip than a thousand pictures.
    const bool plain = text.find_first_not_of("+-0123456789") == std::string::npos;
    if (!plain || std::abs(value) > 2147483647.0) fail("a whole number " + range_text(field) + " in plain digits");
    **whole = static_cast<int>(value);
  } else if (auto* real = std::get_if<double*>(&field.value)) {
    **real = read();
  } else if (auto* words = std::get_if<std::string*>(&field.value)) {
    **words = text;
  } else {
    ChoiceRef& ref = std::get<ChoiceRef>(field.value);
    for (std::size_t i = 0; i < ref.names.size(); ++i) {
      if (ref.names[i] == text) return ref.set(static_cast<int>(i));
    }
    fail("one of " + list_text(ref.names));
  }
}

void check_options(const std::vector<OptionField>& fields) {
  for (const OptionField& field : fields) {
    double value = 0.0;
    if (const auto* whole = std::get_if<int*>(&field.value)) {
      value = **whole;
    } else if (const auto* real = std::get_if<double*>(&field.value)) {
      value = **real;
    } else {
      continue;
    }
    if (!(value >= field.low && value <= field.high)) {
      throw OptionError(field.name, get_text(field), "expected " + range_text(field));
    }
  }
}

}  // namespace ramify
