// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/core/preset.h"

#include <algorithm>

namespace ramify {

const Preset* find_preset(const std::vector<Preset>& presets, const std::string& name) {
  const auto found =
      std::find_if(presets.begin(), presets.end(), [&](const Preset& preset) { return preset.name == name; });
  return found == presets.end() ? nullptr : &*found;
}

void apply_preset(const Preset& preset, std::vector<OptionField> fields) {
  for (OptionField& field : fields) {
    for (const auto& [name, value] : preset.options) {
      if (name == field.name) set_text(field, value);
    }
  }
}

}  // namespace ramify
