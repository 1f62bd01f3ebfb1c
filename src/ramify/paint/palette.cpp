// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/paint/palette.h"

#include <algorithm>
#include <cmath>

#include "ramify/core/error.h"
#include "ramify/image/color.h"

namespace ramify {
namespace {

// "#rgb" or "#rrggbb"; false for anything else.
bool read_hex(const std::string& text, Rgb& color) {
  if ((text.size() != 4 && text.size() != 7) || text[0] != '#') return false;
  int digits[6];
  for (std::size_t i = 1; i < text.size(); ++i) {
    const char c = text[i];
    const int digit = c >= '0' && c <= '9' ? c - '0' : c >= 'a' && c <= 'f' ? c - 'a' + 10 : c >= 'A' && c <= 'F' ? c - 'A' + 10 : -1;
    if (digit < 0) return false;
    digits[i - 1] = digit;
  }
  for (int k = 0; k < 3; ++k) {
    const int level = text.size() == 4 ? 17 * digits[k] : 16 * digits[2 * k] + digits[2 * k + 1];
    color[k] = static_cast<float>(level) / 255.0f;
  }
  return true;
}

Rgb hex(const char* text) {
  Rgb color;
  read_hex(text, color);
  return color;
}

std::vector<Rgb> hexes(std::initializer_list<const char*> texts) {
  std::vector<Rgb> out;
  for (const char* text : texts) out.push_back(hex(text));
  return out;
}

}  // namespace

const std::vector<Palette>& named_palettes() {
  static const std::vector<Palette> palettes{
      {"black", hexes({"#141414"})},
      {"sepia", hexes({"#2b1a10", "#6b4423"})},
      {"indigo", hexes({"#14213d", "#2a4d8f", "#6c8fc7"})},
      {"coral", hexes({"#7a1f2b", "#d1495b", "#f4a582"})},
      {"gold", hexes({"#5c3d0a", "#b8862b", "#f0d68a"})},
      {"umber", hexes({"#4a2f20", "#8a5a38", "#b98d5e"})},
      {"moss", hexes({"#2f3b22", "#5f7340", "#a3ad6b"})},
      {"dusk", hexes({"#2c2b4a", "#5d5c8d", "#b08ea2"})},
      {"white", hexes({"#ffffff"})},
      {"spring", hexes({"#4f4028", "#5b8c3a", "#7fb04a", "#a8c95c"})},
      {"ivy", hexes({"#4a3b2a", "#234f32", "#2f6b3f", "#4b8452"})},
      {"autumn", hexes({"#3d2b1f", "#9c2f1f", "#cf5c22", "#e39b2d", "#8a3324"})},
      {"olive", hexes({"#5a5142", "#6f7d4f", "#8f9a6b", "#b0b58a"})},
      {"blossom", hexes({"#4b3832", "#7a9a5b", "#96b06c", "#c6d29a"})},
      {"electric", hexes({"#ffffff", "#b9d4ff", "#5a6cff"})},
      {"violet", hexes({"#fff6ff", "#d9b3ff", "#8a3cff"})},
      {"plasma", hexes({"#fff4e0", "#ff9ac2", "#e0369a"})},
      {"ember", hexes({"#fffbe8", "#ffb75a", "#ff4d12"})},
      {"aurora", hexes({"#f2fff9", "#86f5c4", "#13b88a"})}};
  return palettes;
}

Rgb parse_color(const std::string& option, const std::string& text) {
  Rgb color;
  if (!read_hex(text, color)) throw OptionError(option, "'" + printable(text, 60) + "'", "expected a colour such as #1d3557");
  return color;
}

std::vector<Rgb> parse_palette(const std::string& option, const std::string& text) {
  std::string names;
  for (const Palette& palette : named_palettes()) {
    if (palette.name == text) return palette.colors;
    names += (names.empty() ? "" : ", ") + palette.name;
  }
  std::vector<Rgb> colors;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t comma = std::min(text.find(',', begin), text.size());
    Rgb color;
    if (!read_hex(text.substr(begin, comma - begin), color)) {
      throw OptionError(option, "'" + printable(text, 60) + "'", "expected colours such as #1d3557,#a8dadc or one of " + names);
    }
    colors.push_back(color);
    begin = comma + 1;
  }
  return colors;
}

Rgb mix(const Rgb& a, const Rgb& b, double t) {
  const float s = static_cast<float>(std::clamp(t, 0.0, 1.0));
  const Rgb la = lab_from_srgb(a), lb = lab_from_srgb(b);
  Rgb out = srgb_from_lab((1.0f - s) * la + s * lb);
  for (int k = 0; k < 3; ++k) out[k] = std::clamp(out[k], 0.0f, 1.0f);
  return out;
}

Rgb color_along(const std::vector<Rgb>& colors, double t) {
  if (colors.size() == 1) return colors.front();
  const double at = std::clamp(t, 0.0, 1.0) * static_cast<double>(colors.size() - 1);
  const std::size_t i = std::min(static_cast<std::size_t>(at), colors.size() - 2);
  return mix(colors[i], colors[i + 1], at - static_cast<double>(i));
}

}  // namespace ramify
