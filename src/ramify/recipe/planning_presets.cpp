// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/recipe/planning.h"

namespace ramify {

const std::vector<Preset>& dendrite_presets() {
  static const std::vector<Preset> presets{
      {"simple", "sixty paths to the middle", {{"count-endpoints", "60"}}},
      {"fractal", "frost: ever more, ever shorter paths", {{"count-endpoints", "9"}, {"distance", "120"}, {"attenuation", "1.6"}, {"branching", "2.3"}, {"rounds", "7"}, {"taper", "0.24"}}},
      {"dla", "imitates diffusion-limited aggregation", {{"placement", "aggregate"}, {"count-endpoints", "20000"}, {"distance", "5"}, {"attenuation", "2"}, {"branching", "3"}, {"rounds", "2"}, {"roughness", "40"}, {"taper", "0"}}},
      {"lightning", "strokes to the ground, side strokes below them", {{"placement", "lightning"}, {"count-endpoints", "3"}, {"branching", "12"}, {"rounds", "3"}, {"roughness", "14"}, {"upward", "3"}, {"sideways", "1.5"}, {"taper", "0.33"}}},
      {"moss", "hairs on the ground or on --generator", {{"placement", "moss"}, {"count-endpoints", "1500"}, {"distance", "60"}, {"spacing", "2"}, {"roughness", "4"}, {"taper", "0.15"}}},
      {"winding", "long detours around whatever is dear", {{"metric", "partial"}, {"count-endpoints", "120"}}},
      {"vein", "smooth, thick at the base", {{"count-endpoints", "250"}, {"roughness", "6"}, {"taper", "0.5"}, {"smooth", "3"}}},
      {"fine", "refined four times", {{"count-endpoints", "80"}, {"refine", "4"}, {"smooth", "0.6"}}}};
  return presets;
}

const std::vector<Preset>& stylize_presets() {
  static const std::vector<Preset> presets{
      {"plain", "lines of one width", {{"thin", "0.5"}, {"thick", "0.5"}}},
      {"emphasis", "thick where the picture matters", {{"thin", "0.3"}, {"thick", "2"}}},
      {"sketch", "few lines", {{"count-endpoints", "800"}, {"thick", "3"}}},
      {"dense", "many lines", {{"count-endpoints", "8000"}, {"thick", "1.6"}}},
      {"lightning", "lines that run down along edges", {{"edges", "20"}, {"least-importance", "0.2"}, {"count-endpoints", "1500"}, {"noise", "0.5"}, {"upward", "2"}, {"sideways", "1.3"}, {"thin", "0.2"}, {"thick", "1.2"}}},
      {"sum", "the paper's other metric, for comparison", {{"metric", "sum"}}},
      {"tree", "a painted tree", {{"tree", "true"}, {"thickness", "endpoints"}, {"thin", "0.6"}, {"thick", "14"}}},
      {"hidden", "a tree with the picture in its right half", {{"tree", "true"}, {"edges", "6"}, {"limbs", "7"}, {"twigs", "4500"}, {"branching", "1.6"}, {"hops", "400"}, {"thickness", "endpoints"}, {"thin", "0.9"}, {"thick", "9"}}},
      {"face", "a tree whose every twig follows the picture", {{"tree", "true"}, {"hidden", "1"}, {"limbs", "9"}, {"twigs", "3500"}, {"branching", "1.6"}, {"hops", "260"}, {"thickness", "importance"}, {"thin", "0.3"}, {"thick", "3"}}}};
  return presets;
}

}  // namespace ramify
