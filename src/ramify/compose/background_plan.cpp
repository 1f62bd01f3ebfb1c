// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <utility>

#include "ramify/compose/background.h"
#include "ramify/image/color.h"
#include "ramify/image/filter.h"

namespace ramify {
namespace {

constexpr double kMostCover = 1.15;  // a photo is enlarged by this much to cover a canvas; beyond, it is extended

double share(const Habitat& habitat, RegionRole role) {
  const auto& roles = habitat.role.pixels();
  const auto count = std::count(roles.begin(), roles.end(), static_cast<std::uint8_t>(role));
  return roles.empty() ? 0.0 : static_cast<double>(count) / static_cast<double>(roles.size());
}

// The photo at its own scale, centred; enlarged a little where that is enough to cover the canvas.
void cover(BackgroundPlan& plan, Size photo, bool may_scale) {
  const double need = std::max(static_cast<double>(plan.canvas.width) / photo.width,
                               static_cast<double>(plan.canvas.height) / photo.height);
  if (may_scale && need > 1.0 && need <= kMostCover) plan.scale = need;
  plan.shift = {std::floor(0.5 * (plan.canvas.width - plan.scale * photo.width)),
                std::floor(0.5 * (plan.canvas.height - plan.scale * photo.height))};
}

// How deep what lies outside the habitat reaches in from each edge, where an edge is mostly outside; else all of the photo.
std::array<int, 4> outside_margins(const Mask& outside) {
  const int w = outside.width(), h = outside.height();
  std::array<int, 4> margins{w, h, w, h};
  for (int edge = 0; edge < 4; ++edge) {
    const bool across = edge % 2 == 0;
    const int along = across ? h : w, most = across ? w : h;
    std::vector<int> depths;
    for (int i = 0; i < along; ++i) {
      int depth = 0;
      const auto at = [&](int d) {
        const int in = edge < 2 ? d : most - 1 - d;
        return across ? outside(in, i) : outside(i, in);
      };
      while (depth < most && at(depth)) ++depth;
      if (depth > 0) depths.push_back(depth);
    }
    if (depths.empty() || depths.size() < 0.6 * along) continue;
    const auto tenth = depths.begin() + static_cast<std::ptrdiff_t>(depths.size() / 10);
    std::nth_element(depths.begin(), tenth, depths.end());
    margins[edge] = std::max(1, *tenth / 3);  // its outer third: the town lights below a skyline lie close to it
  }
  return margins;
}

// The plate, continued to wherever the canvas reaches beyond the photo.
WiderPlate widened(const Plate& plate, const Habitat& habitat, const BackgroundPlan& plan, Rng rng) {
  const Size photo = plate.color.size();
  const Vec2 a = plan.photo_from_canvas(Vec2::Zero(), photo.width);
  const Vec2 b = plan.photo_from_canvas(Vec2(plan.canvas.width - 1.0, plan.canvas.height - 1.0), photo.width);
  const Vec2 low = a.cwiseMin(b), high = a.cwiseMax(b);
  WiderPlateJob job;
  job.outside = habitat.outside;
  job.landmark = Mask(photo, 0);
  for (std::size_t i = 0; i < habitat.role.pixels().size(); ++i) {
    const auto role = static_cast<RegionRole>(habitat.role.pixels()[i]);
    if (role == RegionRole::Landmark) job.landmark.pixels()[i] = 255;
    if (role == RegionRole::Keep) job.outside.pixels()[i] = 255;
  }
  job.margins = outside_margins(habitat.outside);
  const auto whole = [](double px) { return static_cast<int>(std::ceil(std::max(0.0, px))); };
  job.add = {whole(-low.x()), whole(-low.y()), whole(high.x() - photo.width + 1.0),
             whole(high.y() - photo.height + 1.0)};
  return widen_plate(plate.color, job, rng);
}

void draw_waves(BackgroundPlan& plan, double bend, Rng rng) {
  const double side = std::min(plan.canvas.width, plan.canvas.height);
  const auto count = static_cast<double>(plan.waves.size());
  for (BackgroundPlan::Wave& wave : plan.waves) {
    const double length = rng.uniform(0.5, 1.0) * side;  // at least half the side
    wave.frequency = direction_of(rng.uniform(-kPi, kPi)) / length;
    // The steepest slope of one wave is 2 pi amplitude / length; all together may stretch by 15 %.
    const double most = std::min(bend * side, 0.15 * length / (2.0 * kPi)) / count;
    wave.amplitude = direction_of(rng.uniform(-kPi, kPi)) * (rng.uniform(0.6, 1.0) * most);
    wave.phase = rng.uniform(0.0, 2.0 * kPi);
  }
}

}  // namespace

Vec2 BackgroundPlan::canvas_from_photo(const Vec2& photo, int photo_width) const {
  const Vec2 p(flipped ? photo_width - 1.0 - photo.x() : photo.x(), photo.y());
  return scale * p + shift;
}

Vec2 BackgroundPlan::photo_from_canvas(const Vec2& canvas_point, int photo_width) const {
  Vec2 p = (canvas_point - shift) / scale;
  if (flipped) p.x() = photo_width - 1.0 - p.x();
  return p;
}

Vec2 BackgroundPlan::shown_at(const Vec2& photo) const {
  if (wider.source.empty()) return photo;
  const Vec2 p = photo + Vec2(wider.left, wider.top);
  const Vec2 whole(std::round(p.x()), std::round(p.y()));
  return wider.source.clamped(static_cast<int>(whole.x()), static_cast<int>(whole.y())).cast<double>() + (p - whole);
}

std::vector<OptionField> describe(BackgroundOptions& o) {
  return {
      choice("background", o.mode, {"auto", "keep", "vary", "new"}, "what the new branches are laid on"),
      flag("background-mirror", o.mirror, "the background may be mirrored left to right"),
      number("background-bend", o.bend, 0.0, 0.1, "", "share of the shorter side by which a varied background may move"),
      number("background-zoom", o.zoom, 1.0, 2.0, "", "largest enlargement of a varied background"),
  };
}

SlowTones measure_slow_tones(const ColorImage& photo, const Mask& without) {
  const ScalarImage light = luma(photo);
  ScalarImage weight(light.size());
  for (std::size_t i = 0; i < weight.pixels().size(); ++i) weight.pixels()[i] = without.pixels()[i] ? 0.0f : 1.0f;
  const ScalarImage slow = masked_blur(light, weight, light.width() / 16.0);
  double count = 0.0, sum = 0.0, square = 0.0, slow_sum = 0.0, slow_square = 0.0;
  for (std::size_t i = 0; i < weight.pixels().size(); ++i) {
    if (weight.pixels()[i] == 0.0f) continue;
    const double v = light.pixels()[i], s = slow.pixels()[i];
    count += 1.0, sum += v, square += v * v, slow_sum += s, slow_square += s * s;
  }
  if (count == 0.0) return {};
  const double variance = square / count - std::pow(sum / count, 2);
  const double slow_variance = std::max(0.0, slow_square / count - std::pow(slow_sum / count, 2));
  return {variance > 0.0 ? slow_variance / variance : 0.0, std::sqrt(slow_variance)};
}

BackgroundPlan plan_background(const Exemplar& exemplar, const Habitat& habitat, const Plate& plate, Size canvas,
                               const BackgroundOptions& options, Rng rng) {
  BackgroundPlan plan;
  plan.canvas = canvas;
  plan.mode = options.mode;
  const double landmark = share(habitat, RegionRole::Landmark), outside = mean_of(habitat.outside);
  const bool bound = landmark > 0.0 || outside > 0.02;
  if (plan.mode == BackgroundMode::Auto) {
    // PICTURES 7 says a share of 0.1, its table in 8 wants new ground for the wall (0.15) and the Amazon as well:
    // without its water the Amazon's forest has hardly any tones, slow (0.021) or quick.
    constexpr double kTexture = 0.2, kFaint = 0.03;
    const SlowTones slow = measure_slow_tones(plate.color, habitat.outside);
    plan.mode = !bound && (slow.share < kTexture || slow.spread < kFaint) ? BackgroundMode::New : BackgroundMode::Vary;
  }
  // What lies outside is never cut, and a skyline moves sideways only: no enlargement.
  const bool may_scale = outside == 0.0;
  cover(plan, exemplar.photo.color.size(), may_scale);
  Rng draw = rng.child("background-plan");
  if (plan.mode != BackgroundMode::Keep) plan.flipped = options.mirror && draw.below(2) == 1;
  if (plan.mode == BackgroundMode::Vary) {
    if (may_scale && plan.scale >= 1.0 && canvas == exemplar.photo.color.size()) {
      plan.scale = draw.uniform(1.0, options.zoom);
      const Vec2 spare(canvas.width * (plan.scale - 1.0), canvas.height * (plan.scale - 1.0));
      plan.shift = {-spare.x() * draw.uniform(), -spare.y() * draw.uniform()};
    }
    draw_waves(plan, options.bend, draw.child("waves"));
  }
  plan.wider = widened(plate, habitat, plan, draw.child("wider"));
  return plan;
}

double move_under(BackgroundPlan& plan, const Mask& closed, const ScalarImage& wanted) {
  constexpr int kPlaces = 24, kSamples = 64;
  const int stride = std::max(1, std::min(wanted.width(), wanted.height()) / kSamples);
  const auto lost = [&](const Vec2& shift) {
    const Vec2 before = std::exchange(plan.shift, shift);
    double all = 0.0, off = 0.0;
    for (int y = stride / 2; y < wanted.height(); y += stride) {
      for (int x = stride / 2; x < wanted.width(); x += stride) {
        const Vec2 p = plan.shown_at(plan.photo_from_canvas(Vec2(x, y), closed.width()));
        const bool here =
            closed.clamped(static_cast<int>(std::lround(p.x())), static_cast<int>(std::lround(p.y()))) > 0;
        all += wanted(x, y);
        off += here ? wanted(x, y) : 0.0;
      }
    }
    plan.shift = before;
    return all > 0.0 ? off / all : 0.0;
  };
  const Vec2 own = plan.shift;
  const Vec2 spare = plan.scale * Vec2(closed.width(), closed.height()) - Vec2(plan.canvas.width, plan.canvas.height);
  double least = lost(own);
  if (least == 0.0) return 0.0;
  for (int i = 0; i <= kPlaces; ++i) {
    for (int j = 0; j <= kPlaces; ++j) {
      // Whole pixels; along a side that shows all of the photo nothing moves.
      const Vec2 shift(spare.x() > 0.0 ? std::floor(-spare.x() * i / kPlaces) : own.x(),
                       spare.y() > 0.0 ? std::floor(-spare.y() * j / kPlaces) : own.y());
      const double off = lost(shift);
      const bool nearer = (shift - own).norm() < (plan.shift - own).norm();
      if (off < least || (off == least && nearer)) least = off, plan.shift = shift;
    }
  }
  return least;
}

}  // namespace ramify
