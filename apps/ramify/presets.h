// SPDX-License-Identifier: GPL-3.0-or-later
// Presets on the command line: --preset NAME sets what the command line does not, --preset list shows all.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "ramify/core/preset.h"

namespace ramify::app {

// As lines of text, or as JSON.
std::string preset_list(const std::vector<Preset>& presets, bool json);

// Sets the fields that the preset names and the command line does not. Throws OptionError for unknown names.
void apply_preset(const std::vector<Preset>& presets, const std::string& name, const CLI::App& app, std::vector<OptionField> fields);

}  // namespace ramify::app
