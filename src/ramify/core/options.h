// SPDX-License-Identifier: GPL-3.0-or-later
// Options described once. Beside each options struct stands `std::vector<OptionField> describe(XOptions&)`, which lists
// every field with its name, unit, range and help. Command-line flags, --help and recipe JSON are all
// made by walking that list; check_options walks it and throws OptionError.
#pragma once

#include <functional>
#include <limits>
#include <string>
#include <variant>
#include <vector>

#include "ramify/core/error.h"

namespace ramify {

// A reference to an enum field, by the position of its value in `names` (enums count from 0 without gaps).
struct ChoiceRef {
  std::function<int()> get;
  std::function<void(int)> set;
  std::vector<std::string> names;
};

struct OptionField {
  std::string name;  // as on the command line, without dashes: "background-patch"
  std::variant<bool*, int*, double*, std::string*, ChoiceRef> value;
  double low = -std::numeric_limits<double>::infinity();  // inclusive; numbers only
  double high = std::numeric_limits<double>::infinity();
  std::string unit;  // "px", "rad", "" for a pure number
  std::string help;  // one sentence
};

OptionField flag(std::string name, bool& value, std::string help);
OptionField number(std::string name, int& value, int low, int high, std::string unit, std::string help);
OptionField number(std::string name, double& value, double low, double high, std::string unit, std::string help);
OptionField text(std::string name, std::string& value, std::string help);
template <class Enum>
OptionField choice(std::string name, Enum& value, std::vector<std::string> names, std::string help) {
  ChoiceRef ref{[&value] { return static_cast<int>(value); }, [&value](int i) { value = static_cast<Enum>(i); },
                std::move(names)};
  OptionField field;
  field.name = std::move(name);
  field.value = std::move(ref);
  field.help = std::move(help);
  return field;
}

// The field's value as text, so that set_text(field, get_text(field)) changes nothing. Numbers are written with a point
// in every locale.
std::string get_text(const OptionField& field);

// Reads a value from text. Throws OptionError naming the option, the value and what is allowed.
void set_text(OptionField& field, const std::string& text);

// Throws OptionError for the first number out of range or not finite.
void check_options(const std::vector<OptionField>& fields);

// The whole text as a number; false when it is anything else (also inf, nan, hex, blanks). Ignores the locale.
bool parse_number(const std::string& text, double& value);
std::string number_text(double value);  // shortest text that reads back as the same number

}  // namespace ramify
