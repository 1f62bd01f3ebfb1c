// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/exemplar/region_map.h"

#include <algorithm>
#include <cmath>

namespace ramify {

Mask polygon_mask(const std::vector<Vec2>& polygon, Size size) {
  Mask mask(size);
  for (int y = 0; y < size.height; ++y) {
    std::vector<double> crossings;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const Vec2 &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
      if ((a.y() <= y) != (b.y() <= y)) crossings.push_back(a.x() + (y - a.y()) / (b.y() - a.y()) * (b.x() - a.x()));
    }
    std::sort(crossings.begin(), crossings.end());
    for (std::size_t i = 0; i + 1 < crossings.size(); i += 2) {
      const int from = std::max(0, static_cast<int>(std::ceil(std::max(crossings[i], -1.0))));
      const int to = static_cast<int>(std::floor(std::min(crossings[i + 1], static_cast<double>(size.width - 1))));
      for (int x = from; x <= to; ++x) mask(x, y) = 255;
    }
  }
  return mask;
}

Image<std::uint8_t> region_map(const std::vector<Region>& regions, Size size, const Mask& alpha) {
  Image<std::uint8_t> map(size, static_cast<std::uint8_t>(RegionRole::Habitat));
  for (const Region& region : regions) {
    const Mask inside = polygon_mask(region.polygon, size);
    for (std::size_t i = 0; i < map.pixels().size(); ++i) {
      if (inside.pixels()[i]) map.pixels()[i] = static_cast<std::uint8_t>(region.role);
    }
  }
  for (std::size_t i = 0; !alpha.empty() && i < map.pixels().size(); ++i) {
    if (alpha.pixels()[i] == 0) map.pixels()[i] = static_cast<std::uint8_t>(RegionRole::Outside);
  }
  return map;
}

}  // namespace ramify
