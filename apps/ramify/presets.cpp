// SPDX-License-Identifier: GPL-3.0-or-later
#include "presets.h"

#include "arguments.h"
#include "ramify/core/error.h"
#include "ramify/core/json.h"

namespace ramify::app {

std::string preset_list(const std::vector<Preset>& presets, bool json) {
  Json::Array items;
  std::string lines;
  for (const Preset& preset : presets) {
    Json::Object options;
    std::string words;
    for (const auto& [name, value] : preset.options) {
      options.push_back({name, value});
      words += " --" + name + (value == "true" ? "" : " " + value);
    }
    items.push_back(Json::Object{{"name", preset.name}, {"about", preset.about}, {"options", std::move(options)}});
    lines += preset.name + std::string(preset.name.size() < 12 ? 12 - preset.name.size() : 1, ' ') + preset.about + "\n            " + words + "\n";
  }
  return json ? json_text(Json(std::move(items))) + "\n" : lines;
}

void apply_preset(const std::vector<Preset>& presets, const std::string& name, const CLI::App& app, std::vector<OptionField> fields) {
  const Preset* preset = find_preset(presets, name);
  if (!preset) {
    std::vector<std::string> names;
    for (const Preset& p : presets) names.push_back(p.name);
    const std::string near = nearest_word(name, names);
    throw OptionError("preset", "'" + printable(name, 60) + "'",
                      (near.empty() ? std::string("is not known") : "is not known; did you mean " + near + "?") + " (--preset list shows all)");
  }
  std::erase_if(fields, [&](const OptionField& field) {
    const CLI::Option* option = app.get_option_no_throw("--" + field.name);
    return option && option->count() > 0;
  });
  ramify::apply_preset(*preset, std::move(fields));
}

}  // namespace ramify::app
