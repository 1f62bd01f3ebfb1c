// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/growth/ground.h"

#include <cmath>

#include "ramify/core/error.h"

namespace ramify {
namespace {

void check_size(const char* what, Size map, Size canvas) {
  if (map == canvas) return;
  throw InputError("", std::string("the ") + what + " is " + std::to_string(map.width) + "x" + std::to_string(map.height) +
                           " px, the canvas " + std::to_string(canvas.width) + "x" + std::to_string(canvas.height) +
                           "; resize it first");
}

}  // namespace

Ground::Ground(const GrowthTarget& target) : target_(target) {
  if (target.size.width < 1 || target.size.height < 1) throw InputError("", "the canvas to grow on is empty");
  if (!target.density.empty()) check_size("density map", target.density.size(), target.size);
  if (!target.outside.empty()) check_size("outside mask", target.outside.size(), target.size);
  if (!target.obstacles.empty()) check_size("obstacle mask", target.obstacles.size(), target.size);
  if (!target.guide_map.empty()) check_size("guide map", target.guide_map.size(), target.size);
  for (int y = 0; y < target.size.height; ++y) {
    for (int x = 0; x < target.size.width; ++x) {
      const Vec2 point(x, y);
      open_area_ += inside(point) && !blocked(point) ? 1.0 : 0.0;
    }
  }
  if (open_area_ < 1.0) throw InputError("", "there is no place to grow: everything is outside, an obstacle or black");
}

bool Ground::on_canvas(const Vec2& p) const {
  return p.x() >= -0.5 && p.y() >= -0.5 && p.x() < target_.size.width - 0.5 && p.y() < target_.size.height - 0.5;
}

bool Ground::inside(const Vec2& p) const {
  if (!on_canvas(p)) return false;
  return target_.outside.empty() || target_.outside(static_cast<int>(std::lround(p.x())), static_cast<int>(std::lround(p.y()))) < 128;
}

bool Ground::blocked(const Vec2& p) const {
  if (!on_canvas(p)) return false;
  const int x = static_cast<int>(std::lround(p.x())), y = static_cast<int>(std::lround(p.y()));
  if (!target_.obstacles.empty() && target_.obstacles(x, y) >= 128) return true;
  return painted() && !(target_.density(x, y) > kBlack);
}

double Ground::wanted(const Vec2& p) const {
  if (!inside(p) || blocked(p)) return 0.0;
  if (!painted()) return 1.0;
  const double value = target_.density(static_cast<int>(std::lround(p.x())), static_cast<int>(std::lround(p.y())));
  return value > 1.0 ? 1.0 : value;
}

}  // namespace ramify
