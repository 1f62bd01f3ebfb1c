// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/growth/importance.h"

#include <algorithm>
#include <cmath>

#include "ramify/image/color.h"
#include "ramify/image/filter.h"

namespace ramify {
namespace {

float percentile(std::vector<float> values, double share) {
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

}  // namespace

std::vector<OptionField> describe(ImportanceOptions& o) {
  return {
      number("edges", o.edges, 0.0, 100.0, "", "Weight of edges against 1 for darkness in what is important."),
      number("edge-blur", o.blur, 0.0, 50.0, "px", "Blur before edges are looked for."),
      flag("light", o.light, "Light is important instead of dark."),
  };
}

ScalarImage importance_map(const ColorImage& picture, const ImportanceOptions& options) {
  ScalarImage out(picture.size());
  if (picture.empty()) return out;
  const ScalarImage light = luma(picture);
  const Gradient slope = gradient(gaussian_blur(light, options.blur));
  std::vector<float> magnitude(light.pixels().size());
  for (std::size_t i = 0; i < magnitude.size(); ++i) magnitude[i] = std::sqrt(slope.dx.pixels()[i] * slope.dx.pixels()[i] + slope.dy.pixels()[i] * slope.dy.pixels()[i]);
  const float full = std::max(1e-6f, percentile(magnitude, 0.99));
  const auto edges = static_cast<float>(options.edges);
  for (std::size_t i = 0; i < magnitude.size(); ++i) {
    const float value = std::clamp(light.pixels()[i], 0.0f, 1.0f);
    const float dark = options.light ? value : 1.0f - value;
    out.pixels()[i] = (edges * std::min(1.0f, magnitude[i] / full) + dark) / (edges + 1.0f);
  }
  return out;
}

}  // namespace ramify
