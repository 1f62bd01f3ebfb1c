// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/paint/paint.h"

namespace ramify {

const std::vector<Preset>& paint_presets() {
  static const std::vector<Preset> presets{
      {"ink", "black ink with fine points", {{"style", "ink"}, {"palette", "black"}}},
      {"sepia", "brown ink on cream paper", {{"style", "ink"}, {"palette", "sepia"}, {"background", "#f6efe0"}, {"taper", "0.8"}}},
      {"indigo", "blue washes paling outwards", {{"style", "ink"}, {"palette", "indigo"}, {"background", "#f3f5f9"}}},
      {"coral", "red fading to salmon", {{"style", "ink"}, {"palette", "coral"}, {"background", "#fff7f2"}, {"taper", "0.3"}, {"width", "1.3"}}},
      {"papercut", "white on deep blue, round tips", {{"style", "ink"}, {"palette", "white"}, {"background", "#1b2f4b"}, {"taper", "0.2"}, {"flow", "0.9"}, {"width", "1.25"}}},
      {"woodcut", "cut into a block and printed", {{"style", "woodcut"}, {"palette", "black"}, {"background", "#f4ecd8"}, {"taper", "0.5"}, {"smooth", "1.5"}}},
      {"engraving", "blue-black cuts without a ground", {{"style", "woodcut"}, {"palette", "#1a2233"}, {"hatching", "0"}, {"background", "#f7f5ef"}, {"smooth", "1.5"}}},
      {"watercolor", "brown washes on paper", {{"style", "watercolor"}, {"palette", "umber"}, {"background", "#fcfaf4"}, {"smooth", "3"}}},
      {"dusk", "violet washes", {{"style", "watercolor"}, {"palette", "dusk"}, {"background", "#fbf7f4"}, {"width", "1.2"}, {"smooth", "3"}}},
      {"gilded", "gold on black", {{"style", "ink"}, {"palette", "gold"}, {"background", "#0f0d0a"}, {"taper", "0.8"}}},
      {"vine", "spring vine with tendrils", {{"style", "vine"}, {"palette", "spring"}, {"leaf", "ovate"}, {"tendrils", "0.15"}}},
      {"ivy", "ivy in deep green", {{"style", "vine"}, {"palette", "ivy"}, {"leaf", "ivy"}, {"tendrils", "0"}}},
      {"autumn", "oak leaves turning", {{"style", "vine"}, {"palette", "autumn"}, {"leaf", "oak"}, {"tendrils", "0"}, {"background", "#fbf4e6"}}},
      {"olive", "lance leaves in pairs", {{"style", "vine"}, {"palette", "olive"}, {"leaf", "lance"}, {"phyllotaxis", "opposite"}, {"tendrils", "0"}}},
      {"blossom", "flowering twigs", {{"style", "vine"}, {"palette", "blossom"}, {"leaf", "ovate"}, {"leaf-density", "0.5"}, {"flowers", "0.7"}, {"tendrils", "0"}, {"background", "#f4f8fb"}}},
      {"climber", "heart leaves and many tendrils", {{"style", "vine"}, {"palette", "spring"}, {"leaf", "heart"}, {"tendrils", "0.35"}}},
      {"lightning", "white bolt, blue air", {{"style", "lightning"}, {"palette", "electric"}, {"background", "#070a18"}, {"smooth", "0.8"}, {"flow", "0.2"}}},
      {"plasma", "pink discharge", {{"style", "lightning"}, {"palette", "plasma"}, {"background", "#12060f"}, {"smooth", "0.8"}, {"flow", "0.2"}}},
      {"ember", "glowing cracks", {{"style", "lightning"}, {"palette", "ember"}, {"background", "#140a06"}, {"smooth", "1"}, {"flow", "0.2"}}},
      {"aurora", "green light", {{"style", "lightning"}, {"palette", "aurora"}, {"background", "#04110f"}, {"smooth", "2"}}}};
  return presets;
}

}  // namespace ramify
