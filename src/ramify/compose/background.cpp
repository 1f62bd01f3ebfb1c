// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/compose/background.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "ramify/core/parallel.h"
#include "ramify/image/color.h"
#include "ramify/image/completion.h"
#include "ramify/image/filter.h"
#include "ramify/image/sample.h"
#include "ramify/skeleton/draw.h"

namespace ramify {
namespace {

Mask add(Mask a, const Mask& b) {
  for (std::size_t i = 0; i < a.pixels().size(); ++i) a.pixels()[i] |= b.pixels()[i];
  return a;
}

double smooth_step(double t) {
  t = std::clamp(t, 0.0, 1.0);
  return t * t * (3.0 - 2.0 * t);
}

Mask fixed_things(const Habitat& habitat) {
  Mask mask = habitat.outside;
  for (std::size_t i = 0; i < mask.pixels().size(); ++i) {
    if (habitat.role.pixels()[i] == static_cast<std::uint8_t>(RegionRole::Landmark)) mask.pixels()[i] = 255;
  }
  return mask;
}

// Photo position of every canvas pixel.
VectorImage canvas_map(const Habitat& habitat, const BackgroundPlan& plan) {
  constexpr double kFade = 170.0;  // px over which bends die away (PICTURES 12.3-3)
  const int photo_width = habitat.outside.width();
  const ScalarImage to_fixed = distance_to(fixed_things(habitat));
  VectorImage map(plan.canvas);
  const double fade = std::min(kFade, 0.25 * std::min(plan.canvas.width, plan.canvas.height));
  parallel_for(plan.canvas.height, [&](int y) {
    for (int x = 0; x < plan.canvas.width; ++x) {
      const Vec2 c(x, y);
      Vec2 bend = Vec2::Zero();
      for (const BackgroundPlan::Wave& wave : plan.waves) {
        bend += wave.amplitude * std::sin(2.0 * kPi * wave.frequency.dot(c) + wave.phase);
      }
      const Vec2 rigid = plan.photo_from_canvas(c, photo_width);
      const int frame = std::min({x, y, plan.canvas.width - 1 - x, plan.canvas.height - 1 - y});
      const double near = to_fixed.clamped(static_cast<int>(std::lround(rigid.x())), static_cast<int>(std::lround(rigid.y())));
      const double free = smooth_step(frame / fade) * smooth_step(near / fade);
      map(x, y) = (free == 0.0 ? rigid : plan.photo_from_canvas(c + free * bend, photo_width)).cast<float>();
    }
  }, 16);
  return map;
}

bool is_whole(const BackgroundPlan& plan) {
  const bool bent = std::any_of(plan.waves.begin(), plan.waves.end(), [](const auto& w) { return w.amplitude != Vec2::Zero(); });
  return plan.scale == 1.0 && !bent && plan.shift.x() == std::floor(plan.shift.x()) && plan.shift.y() == std::floor(plan.shift.y());
}

// Resampling takes a part of the finest grain (Lanczos-3 keeps 0.84 to 0.90 of it). It is given back tile by tile: the
// picture's own finest band is raised until it is as strong as in the photo.
void restore_grain(ColorImage& canvas, const ColorImage& plate, const VectorImage& map) {
  constexpr int kTile = 64;
  constexpr double kFine = 0.7;
  const ColorImage canvas_calm = gaussian_blur(canvas, kFine), plate_calm = gaussian_blur(plate, kFine);
  const Size tiles{canvas.width() / kTile + 1, canvas.height() / kTile + 1};
  ScalarImage gain(tiles, 0.0f);
  parallel_for(tiles.height, [&](int ty) {
    for (int tx = 0; tx < tiles.width; ++tx) {
      double have = 0.0, want = 0.0;
      for (int y = ty * kTile; y < std::min(canvas.height(), (ty + 1) * kTile); y += 2) {
        for (int x = tx * kTile; x < std::min(canvas.width(), (tx + 1) * kTile); x += 2) {
          const int u = static_cast<int>(std::lround(map(x, y).x())), v = static_cast<int>(std::lround(map(x, y).y()));
          if (!plate.contains(u, v)) continue;
          have += std::pow(luma(canvas(x, y) - canvas_calm(x, y)), 2);
          want += std::pow(luma(plate(u, v) - plate_calm(u, v)), 2);
        }
      }
      if (have > 0.0) gain(tx, ty) = static_cast<float>(std::clamp(std::sqrt(want / have) - 1.0, 0.0, 0.6));
    }
  });
  const ScalarImage smooth_gain = gaussian_blur(gain, 1.0);
  parallel_for(canvas.height(), [&](int y) {
    for (int x = 0; x < canvas.width(); ++x) {
      const float k = sample_bilinear(smooth_gain, Vec2((x - 0.5 * kTile) / kTile, (y - 0.5 * kTile) / kTile));
      canvas(x, y) = canvas(x, y) + k * (canvas(x, y) - canvas_calm(x, y));
    }
  }, 16);
}

// Sources of a picture that was made from the plate are the plate's own sources.
VectorImage through_plate(VectorImage sources, const Plate& plate) {
  for (auto& s : sources.pixels()) {
    if (std::isnan(s.x())) continue;
    const int u = static_cast<int>(std::lround(s.x())), v = static_cast<int>(std::lround(s.y()));
    if (plate.source.contains(u, v) && plate.hole(u, v)) s = plate.source(u, v);
  }
  return sources;
}

Mask mapped(const Mask& photo_mask, const VectorImage& map) {
  Mask out(map.size(), 0);
  for (std::size_t i = 0; i < out.pixels().size(); ++i) {
    const int u = static_cast<int>(std::lround(map.pixels()[i].x())), v = static_cast<int>(std::lround(map.pixels()[i].y()));
    if (photo_mask.contains(u, v)) out.pixels()[i] = photo_mask(u, v);
  }
  return out;
}

// Keep and Vary: the plate through the map.
Background taken_over(const Habitat& habitat, const Plate& plate, const BackgroundPlan& plan, VectorImage map, const Monitor& monitor) {
  Background out;
  out.color = ColorImage(plan.canvas);
  const bool whole = is_whole(plan);
  const ColorImage& wide = plan.wider.color;
  const Eigen::Vector2f corner(static_cast<float>(plan.wider.left), static_cast<float>(plan.wider.top));
  for (auto& p : map.pixels()) p += corner;
  parallel_for(plan.canvas.height, [&](int y) {
    for (int x = 0; x < plan.canvas.width; ++x) {
      const Vec2 p = map(x, y).cast<double>();
      out.color(x, y) = whole ? wide.clamped(static_cast<int>(std::lround(p.x())), static_cast<int>(std::lround(p.y())))
                              : sample_lanczos3(wide, p);
    }
  }, 16);
  monitor.report(0.5);
  if (!whole) restore_grain(out.color, wide, map);
  for (auto& p : map.pixels()) p = plan.shown_at((p - corner).cast<double>()).cast<float>();
  out.outside = mapped(habitat.outside, map);
  out.source = through_plate(std::move(map), plate);
  monitor.report(1.0);
  return out;
}

// Where the photo does not reach, slow tones go on mirrored.
double mirrored_at(double t, int n) {
  const double period = 2.0 * n;
  t = std::fmod(std::fmod(t, period) + period, period);
  return t < n ? t : period - t;
}

// Logarithm of how busy the ground is around every pixel. Quiet patches fit anything beside them, so that a quilt that
// is not told how busy to be goes quiet.
ScalarImage busyness(const ColorImage& color, const Mask& invented, double reach) {
  constexpr double kFine = 1.0;         // px
  constexpr float kFloor = 0.5f / 255;  // of rounding
  const ScalarImage light = luma(color), calm = gaussian_blur(light, kFine);
  ScalarImage swing(light.size()), weight(light.size());
  for (std::size_t i = 0; i < swing.pixels().size(); ++i) {
    swing.pixels()[i] = std::abs(light.pixels()[i] - calm.pixels()[i]);
    weight.pixels()[i] = invented.pixels()[i] ? 0.0f : 1.0f;
  }
  swing = masked_blur(swing, weight, reach);
  for (float& v : swing.pixels()) v = std::log(v + kFloor);
  return swing;
}

Background new_ground(const Exemplar& exemplar, const Habitat& habitat, const Plate& plate, const BackgroundPlan& plan,
                      const VectorImage& map, const Skeleton& target, Rng rng, const Monitor& monitor) {
  constexpr double kBank = 30.0;   // px; ground nearer to a branch than this is bank (PICTURES 12.1-1)
  constexpr double kTone = 25.0;   // px
  constexpr float kWideHole = 10;  // px; deeper inside a hole the plate is too much an invention to copy from
  const Size photo = plate.color.size();
  QuiltJob job;
  job.source = plate.color;
  job.forbidden = add(habitat.outside, habitat.outliers);
  const ScalarImage depth = distance_to(invert(plate.hole));
  for (std::size_t i = 0; i < depth.pixels().size(); ++i) {
    if (depth.pixels()[i] > kWideHole) job.forbidden.pixels()[i] = 255;
  }
  if (habitat.shadow_is_texture) job.precious = habitat.shadow;
  job.canvas = ColorImage(plan.canvas);
  job.hole = Mask(plan.canvas, 255);
  const auto bank = [&](const Skeleton& skeleton, Size size) {
    ScalarImage d = draw_signed_distance(skeleton, size, kBank);
    for (float& v : d.pixels()) v = std::clamp(v / static_cast<float>(kBank), 0.0f, 1.0f);
    return d;
  };
  if (!target.empty()) job.guides.push_back({bank(exemplar.skeleton, photo), bank(target, plan.canvas), 1.0});
  const double slow = measure_slow_tones(plate.color, habitat.outside).share;
  const double reach = slow > 0.05 ? kTone : 4.0 * kTone;
  const ColorImage tone = gaussian_blur(plate.color, reach);
  const ScalarImage busy = busyness(plate.color, add(job.forbidden, plate.hole), kTone);
  ColorImage wanted(plan.canvas);
  ScalarImage wanted_busy(plan.canvas);
  parallel_for(
      plan.canvas.height,
      [&](int y) {
        for (int x = 0; x < plan.canvas.width; ++x) {
          const Vec2 p(mirrored_at(map(x, y).x(), photo.width - 1), mirrored_at(map(x, y).y(), photo.height - 1));
          wanted(x, y) = sample_bilinear(tone, p);
          wanted_busy(x, y) = sample_bilinear(busy, p);
        }
      },
      16);
  constexpr double kBusyWeight = 4.0;
  job.guides.push_back({busy, wanted_busy, kBusyWeight});
  if (slow > 0.05) {
    constexpr double kToneWeight = 20.0;
    for (int c = 0; c < 3; ++c) job.guides.push_back({channel(tone, c), channel(wanted, c), kToneWeight});
  }
  QuiltOptions options;
  options.mirror_x = options.mirror_y = false;
  options.tries = 500;
  const Quilt quilt = make_quilt(job, options, rng.child("quilt"), monitor.stage("quilt", 0.1, 0.8));
  Background out;
  out.color = blend_quilt(job, quilt, wanted, reach, false, monitor.stage("blend", 0.8, 1.0));
  out.source = through_plate(quilt_sources(quilt), plate);
  out.outside = Mask(plan.canvas, 0);
  return out;
}

}  // namespace

Background make_background(const Exemplar& exemplar, const Habitat& habitat, const Plate& plate, const BackgroundPlan& plan,
                           const Skeleton& target, Rng rng, const Monitor& monitor) {
  const VectorImage map = canvas_map(habitat, plan);
  monitor.report(0.05);
  if (plan.mode == BackgroundMode::New) return new_ground(exemplar, habitat, plate, plan, map, target, rng, monitor);
  return taken_over(habitat, plate, plan, map, monitor);
}

}  // namespace ramify
