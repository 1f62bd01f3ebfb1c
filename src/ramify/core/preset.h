// SPDX-License-Identifier: GPL-3.0-or-later
// Settings that go well together, by name.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "ramify/core/options.h"

namespace ramify {

struct Preset {
  std::string name;
  std::string about;  // one line
  std::vector<std::pair<std::string, std::string>> options;
};

// nullptr when none has the name.
const Preset* find_preset(const std::vector<Preset>& presets, const std::string& name);

// Sets those of the fields that the preset names. Throws as set_text.
void apply_preset(const Preset& preset, std::vector<OptionField> fields);

}  // namespace ramify
