// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/compose/light_rules.h"

namespace ramify {

LightRules light_rules(CompositeMode mode) {
  LightRules rules;
  if (mode == CompositeMode::Emit) {
    rules.surround_factor = 3.5;
    rules.surround_cap = 60.0;
    rules.tip_fade = 5.0;
    rules.floor = 0.0;
    rules.hue = 0.35;
    rules.weak = 0.05;
    rules.candidates = 8;
  }
  return rules;
}

}  // namespace ramify
