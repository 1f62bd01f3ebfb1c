// SPDX-License-Identifier: GPL-3.0-or-later
#include <catch2/catch.hpp>
#include <cmath>

#include "ramify/compose/background.h"
#include "ramify/image/color.h"
#include "ramify/image/filter.h"

using namespace ramify;

namespace {

struct Scene {
  Exemplar exemplar;
  Habitat habitat;
  Plate plate;
};

// Grainy ground crossed by one dark branch. slope adds a shade from left to right.
Scene ground(int width, int height, float slope, float grain = 0.1f) {
  Scene s;
  Rng rng(1);
  ScalarImage noise(width, height);
  for (float& v : noise.pixels()) v = static_cast<float>(rng.normal());
  noise = gaussian_blur(noise, 0.8);
  s.exemplar.photo.color = ColorImage(width, height);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const float v = 0.5f + grain * noise(x, y) + slope * (static_cast<float>(x) / width - 0.5f);
      s.exemplar.photo.color(x, y) = std::abs(y - height / 2) < 3 ? Rgb{0.1f, 0.1f, 0.1f} : Rgb{v, v, 0.9f * v};
    }
  }
  s.exemplar.skeleton = Skeleton(Size{width, height});
  for (int k = 0; k <= width / 10; ++k) s.exemplar.skeleton.append({Vec3(10.0 * k, height / 2, 0.0), 3.0, k - 1, 0, 0});
  s.exemplar.regions = Image<std::uint8_t>(width, height, static_cast<std::uint8_t>(RegionRole::Habitat));
  return s;
}

void finish(Scene& s) {
  HabitatOptions options;
  options.automatic = false;
  s.habitat = find_habitat(s.exemplar, options, Rng(1), {});
  s.plate = make_plate(s.exemplar, s.habitat, PlateKind::Thin, Rng(1), {});
}

void mark(Scene& s, RegionRole role, int x0, int y0, int x1, int y1) {
  for (int y = y0; y < y1; ++y) {
    for (int x = x0; x < x1; ++x) s.exemplar.regions(x, y) = static_cast<std::uint8_t>(role);
  }
}

double fine_grain(const ColorImage& image) {
  const ScalarImage light = luma(image), calm = gaussian_blur(light, 0.7);
  double sum = 0.0;
  for (std::size_t i = 0; i < light.pixels().size(); ++i) sum += std::pow(light.pixels()[i] - calm.pixels()[i], 2);
  return std::sqrt(sum / static_cast<double>(light.pixels().size()));
}

BackgroundOptions with(BackgroundMode mode) {
  BackgroundOptions options;
  options.mode = mode;
  return options;
}

}  // namespace

TEST_CASE("keep gives the plate back pixel by pixel") {
  Scene s = ground(240, 180, 0.2f);
  finish(s);
  const BackgroundPlan plan = plan_background(s.exemplar, s.habitat, s.plate, {240, 180}, with(BackgroundMode::Keep), Rng(3));
  const Background b = make_background(s.exemplar, s.habitat, s.plate, plan, {}, Rng(3), {});
  CHECK(b.color == s.plate.color);
  CHECK(plan.canvas_from_photo({17.0, 33.0}, 240) == Vec2(17.0, 33.0));
  CHECK(b.source(5, 7) == Eigen::Vector2f(5.0f, 7.0f));
}

TEST_CASE("a shadow to one side of a branch leaves the plate with it") {
  Scene s = ground(300, 200, 0.0f, 0.02f);
  const auto shade = [](int beyond) {
    return 0.06f * std::clamp(1.0f - static_cast<float>(beyond) / 14.0f, 0.0f, 1.0f);
  };
  for (int y = 103; y < 117; ++y) {  // below the branch, that lies on rows 97 to 102
    for (int x = 0; x < 300; ++x) {
      for (int c = 0; c < 3; ++c) s.exemplar.photo.color(x, y)[c] -= shade(y - 103);
    }
  }
  finish(s);
  double on_branch = 0.0, below = 0.0, elsewhere = 0.0;
  for (int x = 20; x < 280; ++x) {
    for (int k = 0; k < 6; ++k) {
      on_branch += s.plate.color(x, 97 + k).g / (6 * 260);
      below += s.plate.color(x, 103 + k).g / (6 * 260);
      elsewhere += s.plate.color(x, 20 + k).g / (6 * 260);
    }
  }
  CHECK(on_branch > elsewhere - 0.008);
  CHECK(below > elsewhere - 0.008);
}

TEST_CASE("auto makes new ground of texture and varies what has shades or landmarks") {
  Scene texture = ground(240, 180, 0.0f);
  // A branch is part of the photo's slow share; keep it thin beside the grain.
  finish(texture);
  const auto mode = [](const Scene& s) {
    return plan_background(s.exemplar, s.habitat, s.plate, {240, 180}, {}, Rng(1)).mode;
  };
  CHECK(mode(texture) == BackgroundMode::New);
  Scene shade = ground(240, 180, 0.8f);
  finish(shade);
  CHECK(mode(shade) == BackgroundMode::Vary);
  Scene faint = ground(240, 180, 0.06f, 0.02f);  // a shade of spread 0.06 / sqrt(12), most of what little there is
  finish(faint);
  CHECK(measure_slow_tones(faint.plate.color, faint.habitat.outside).share > 0.5);
  CHECK(measure_slow_tones(faint.plate.color, faint.habitat.outside).spread == Approx(0.017).margin(0.003));
  CHECK(mode(faint) == BackgroundMode::New);
  Scene landmark = ground(240, 180, 0.0f);
  mark(landmark, RegionRole::Landmark, 20, 20, 90, 80);
  finish(landmark);
  CHECK(mode(landmark) == BackgroundMode::Vary);
}

TEST_CASE("vary moves landmarks and outside shapes rigidly and keeps the grain") {
  Scene s = ground(640, 480, 0.3f);
  mark(s, RegionRole::Outside, 0, 440, 640, 480);
  mark(s, RegionRole::Landmark, 300, 100, 380, 180);
  finish(s);
  for (const std::uint64_t seed : {1, 2, 3, 4}) {
    const BackgroundPlan plan = plan_background(s.exemplar, s.habitat, s.plate, {640, 480}, with(BackgroundMode::Vary), Rng(seed));
    CHECK(plan.scale == 1.0);  // an enlargement would cut the outside shape
    const Background b = make_background(s.exemplar, s.habitat, s.plate, plan, {}, Rng(seed), {});
    for (const Vec2& p : {Vec2(320.0, 120.0), Vec2(370.0, 170.0), Vec2(50.0, 460.0)}) {
      const Vec2 q = plan.canvas_from_photo(p, 640);
      const auto source = b.source(static_cast<int>(std::lround(q.x())), static_cast<int>(std::lround(q.y())));
      CHECK(source.x() == Approx(p.x()).margin(0.01));
      CHECK(source.y() == Approx(p.y()).margin(0.01));
    }
    CHECK(b.outside(20, 470) == 255);
    CHECK(b.outside(20, 200) == 0);
    CHECK(fine_grain(b.color) / fine_grain(s.plate.color) == Approx(1.0).margin(0.05));
  }
}

TEST_CASE("bends of vary never fold or stretch much") {
  Scene s = ground(640, 480, 0.3f);
  finish(s);
  BackgroundOptions options = with(BackgroundMode::Vary);
  options.zoom = 1.0;
  for (const std::uint64_t seed : {5, 6, 7}) {
    const BackgroundPlan plan = plan_background(s.exemplar, s.habitat, s.plate, {640, 480}, options, Rng(seed));
    const Background b = make_background(s.exemplar, s.habitat, s.plate, plan, {}, Rng(seed), {});
    const double sign = plan.flipped ? -1.0 : 1.0;
    double low = 9.0, high = -9.0, moved = 0.0;
    for (int y = 0; y + 1 < 480; ++y) {
      for (int x = 0; x + 1 < 640; ++x) {
        const auto& p = b.source(x, y);
        if (std::abs(y - 240) < 50) continue;  // the plate's hole shows other places
        const Vec2 rigid = plan.photo_from_canvas(Vec2(x, y), 640);
        const double j = sign * ((b.source(x + 1, y) - p).x() * (b.source(x, y + 1) - p).y() -
                                 (b.source(x + 1, y) - p).y() * (b.source(x, y + 1) - p).x());
        low = std::min(low, j), high = std::max(high, j);
        moved = std::max(moved, (p.cast<double>() - rigid).norm());
      }
    }
    CHECK(low > 0.75);
    CHECK(high < 1.3);
    CHECK(moved > 1.0);
    CHECK((b.source(0, 0).cast<double>() - plan.photo_from_canvas(Vec2(0, 0), 640)).norm() < 1e-3);
  }
}

TEST_CASE("new ground fills any canvas with the photo's texture") {
  Scene s = ground(260, 200, 0.0f);
  finish(s);
  for (const Size canvas : {Size{260, 200}, Size{420, 150}}) {
    Skeleton target(canvas);
    for (int k = 0; k < 14; ++k) target.append({Vec3(canvas.width / 2, 10.0 * k, 0.0), 3.0, k - 1, 0, 0});
    const BackgroundPlan plan = plan_background(s.exemplar, s.habitat, s.plate, canvas, with(BackgroundMode::New), Rng(1));
    const Background b = make_background(s.exemplar, s.habitat, s.plate, plan, target, Rng(1), {});
    REQUIRE(b.color.size() == canvas);
    CHECK(fine_grain(b.color) / fine_grain(s.plate.color) == Approx(1.0).margin(0.06));
    int branchlike = 0;
    for (const Rgb& c : b.color.pixels()) branchlike += c.g < 0.25f;
    CHECK(branchlike == 0);
  }
}

TEST_CASE("a larger canvas extends the photo beyond its frame") {
  Scene s = ground(200, 160, 0.1f);
  finish(s);
  const Size canvas{300, 160};
  const BackgroundPlan plan = plan_background(s.exemplar, s.habitat, s.plate, canvas, with(BackgroundMode::Keep), Rng(1));
  const Background b = make_background(s.exemplar, s.habitat, s.plate, plan, {}, Rng(1), {});
  for (const int x : {34, 100, 165}) CHECK(b.color(50 + x, 30) == s.plate.color(x, 30));  // all but the outer sixths
  for (int y = 0; y < 160; ++y) {
    for (const int x : {0, 10, 45, 255, 299}) CHECK(b.color(x, y).g == Approx(0.5).margin(0.25));
  }
}

TEST_CASE("the same seed gives the same background and another seed another one") {
  Scene s = ground(240, 180, 0.0f);
  finish(s);
  const auto make = [&](std::uint64_t seed) {
    const BackgroundPlan plan = plan_background(s.exemplar, s.habitat, s.plate, {240, 180}, with(BackgroundMode::New), Rng(seed));
    return make_background(s.exemplar, s.habitat, s.plate, plan, {}, Rng(seed), {}).color;
  };
  const ColorImage first = make(1);
  CHECK(make(1) == first);
  CHECK_FALSE(make(2) == first);
}

TEST_CASE("beyond the photo only its margin goes on where that lies outside the habitat") {
  Scene s = ground(200, 160, 0.1f);
  finish(s);
  constexpr int kSkyline = 130;  // y below which nothing may grow
  for (int y = kSkyline; y < 160; ++y) std::fill_n(s.habitat.outside.row(y), 200, std::uint8_t{255});
  const BackgroundPlan plan = plan_background(s.exemplar, s.habitat, s.plate, {200, 300}, with(BackgroundMode::Keep), Rng(1));
  const Background b = make_background(s.exemplar, s.habitat, s.plate, plan, {}, Rng(1), {});
  const int top = static_cast<int>(plan.shift.y());
  for (int y = 0; y < 300; ++y) CHECK((b.outside(100, y) != 0) == (y >= top + kSkyline));
}

TEST_CASE("a small canvas shows the part of the photo where what is wanted is open") {
  const Vec2 eye(150, 130);  // px, a round field on closed ground
  Mask closed(300, 260, 255);
  for (int y = 0; y < 260; ++y) {
    for (int x = 0; x < 300; ++x) closed(x, y) = (Vec2(x, y) - eye).norm() < 100.0 ? 0 : 255;
  }
  ScalarImage wanted(120, 100, 0.0f);
  for (int y = 10; y < 90; ++y) {
    for (int x = 10; x < 110; ++x) wanted(x, y) = 1.0f;
  }
  for (const bool flipped : {false, true}) {
    BackgroundPlan plan;
    plan.canvas = wanted.size();
    plan.flipped = flipped;
    CHECK(move_under(plan, closed, wanted) == 0.0);
    for (int y = 10; y < 90; ++y) {
      for (int x = 10; x < 110; ++x) {
        const Vec2 p = plan.photo_from_canvas(Vec2(x, y), 300);
        CHECK((p - eye).norm() < 101.0);
      }
    }
    const Vec2 there = plan.shift;
    CHECK(move_under(plan, closed, wanted) == 0.0);
    CHECK(plan.shift == there);  // nothing moves without need
  }
  // The whole photo is shown: what lies beyond the field stays there, and is told.
  BackgroundPlan whole;
  whole.canvas = closed.size();
  ScalarImage corner(300, 260, 0.0f);
  for (int y = 0; y < 260; ++y) std::fill_n(corner.row(y), y < 130 ? 300 : 0, 1.0f);
  const double off = 1.0 - 0.5 * kPi * 100.0 * 100.0 / (300.0 * 130.0);
  CHECK(move_under(whole, closed, corner) == Catch::Detail::Approx(off).margin(0.02));
  CHECK(whole.shift == Vec2::Zero());
}
