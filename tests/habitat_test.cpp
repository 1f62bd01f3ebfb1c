// SPDX-License-Identifier: GPL-3.0-or-later
#include <catch2/catch.hpp>
#include <cmath>

#include "ramify/exemplar/apron.h"
#include "ramify/exemplar/branch_zone.h"
#include "ramify/exemplar/habitat.h"
#include "ramify/exemplar/plate.h"
#include "ramify/image/color.h"
#include "ramify/image/filter.h"

using namespace ramify;

namespace {

constexpr int kSide = 320;

bool in_disc(int x, int y) { return std::hypot(x - kSide / 2.0, y - kSide / 2.0) < 0.45 * kSide; }

// A reddish disc before black, like a photo of an eye, with dark branches and fine grain.
Exemplar disc_exemplar(bool blobs, bool lines) {
  Exemplar e;
  e.polarity = Polarity::Dark;
  e.skeleton = Skeleton(Size{kSide, kSide});
  for (int arm = 0; arm < 5; ++arm) {
    const double angle = 2.0 * kPi * arm / 5.0 + 0.3;
    int parent = kNone;
    for (int k = 0; k < 25; ++k) {
      Node node;
      const Vec2 p = Vec2(kSide / 2.0, kSide / 2.0) + (8.0 + 5.0 * k) * direction_of(angle + 0.01 * k);
      node.position = Vec3(p.x(), p.y(), 0.0);
      node.radius = 2.5;
      node.parent = parent;
      parent = e.skeleton.append(node);
    }
  }
  const Mask branches = branch_zone(e.skeleton, {kSide, kSide}, [](double r) { return r; });
  Rng rng(1);
  e.photo.color = ColorImage(kSide, kSide);
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) {
      const float grain = 0.01f * static_cast<float>(rng.normal());
      Rgb c = in_disc(x, y) ? Rgb{0.75f + grain, 0.40f + grain, 0.30f + grain} : Rgb{0.02f, 0.02f, 0.02f};
      if (branches(x, y)) c = {0.5f + grain, 0.2f + grain, 0.15f + grain};
      if (blobs && std::hypot(x - 84.0, y - 137.0) < 4.0) c = {1.0f, 1.0f, 0.9f};
      if (lines && std::abs(y - 230) <= 1 && x > 85 && x < 145) c = {0.6f, 0.28f, 0.2f};
      e.photo.color(x, y) = c;
    }
  }
  e.branch_mask = branches;
  e.regions = Image<std::uint8_t>(kSide, kSide, static_cast<std::uint8_t>(RegionRole::Habitat));
  return e;
}

}  // namespace

TEST_CASE("the surround of a disc is found to be outside") {
  const Exemplar e = disc_exemplar(false, false);
  const Habitat habitat = find_habitat(e, {}, Rng(1), {});
  int wrong = 0;
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) wrong += (habitat.outside(x, y) != 0) == in_disc(x, y);
  }
  CHECK(wrong < 0.01 * kSide * kSide);
  HabitatOptions off;
  off.automatic = false;
  CHECK(mean_of(find_habitat(e, off, Rng(1), {}).outside) == 0.0);
}

TEST_CASE("a sky that darkens slowly is one habitat") {
  Exemplar e = disc_exemplar(false, false);
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) {
      const float v = 0.9f - 0.8f * static_cast<float>(y) / kSide;
      e.photo.color(x, y) = {0.5f * v, 0.7f * v, v};
    }
  }
  Skeleton top(Size{kSide, kSide});
  for (int k = 0; k < 20; ++k) top.append({Vec3(20.0 + 14.0 * k, 60.0 + 3.0 * (k % 3), 0.0), 2.0, k - 1, 0, 0});
  CHECK(mean_of(find_outside(e.photo.color, top, {}, Rng(1), {})) == 0.0);
}

TEST_CASE("blobs are outliers and branches are not") {
  const Exemplar e = disc_exemplar(true, false);
  const Habitat habitat = find_habitat(e, {}, Rng(1), {});
  CHECK(habitat.outliers(84, 137) == 255);
  CHECK(mean_of(habitat.outliers) < 0.01);
  for (const Node& node : e.skeleton.nodes()) {
    CHECK(habitat.outliers(static_cast<int>(node.position.x()), static_cast<int>(node.position.y())) == 0);
  }
}

TEST_CASE("a cloud over wide water is an outlier, the water around it and a thin creek are not") {
  Exemplar e;
  e.polarity = Polarity::Bright;
  e.skeleton = Skeleton(Size{kSide, kSide});
  for (int k = 0; k < 32; ++k) e.skeleton.append({Vec3(10.0 * k, 160.0, 0.0), 30.0, k - 1, 0, 0});
  const int creek = e.skeleton.append({Vec3(160.0, 60.0, 0.0), 3.0, kNone, 0, 0});
  e.skeleton.append({Vec3(160.0, 100.0, 0.0), 3.0, creek, 0, 0});
  const Mask water = branch_zone(e.skeleton, {kSide, kSide}, [](double r) { return r; });
  Rng rng(3);
  e.photo.color = ColorImage(kSide, kSide);
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) {
      const float grain = 0.01f * static_cast<float>(rng.normal());
      Rgb c = water(x, y) ? Rgb{0.55f + grain, 0.42f + grain, 0.3f + grain}
                          : Rgb{0.05f + grain, 0.15f + grain, 0.05f + grain};
      if (std::hypot(x - 100.0, y - 155.0) < 4.0 || std::hypot(x - 160.0, y - 80.0) < 2.0) c = {1.0f, 1.0f, 1.0f};
      e.photo.color(x, y) = c;
    }
  }
  e.regions = Image<std::uint8_t>(kSide, kSide, static_cast<std::uint8_t>(RegionRole::Habitat));
  HabitatOptions options;
  options.automatic = false;
  const Habitat habitat = find_habitat(e, options, Rng(1), {});
  CHECK(habitat.outliers(100, 155) == 255);
  CHECK(habitat.outliers(160, 80) == 0);
  CHECK(mean_of(habitat.outliers) < 0.003);  // the cloud with its margin covers 0.002
}

TEST_CASE("a line nobody annotated is shadow") {
  const Habitat habitat = find_habitat(disc_exemplar(false, true), {}, Rng(1), {});
  int hit = 0;
  for (int x = 90; x < 140; ++x) hit += habitat.shadow(x, 230) != 0;
  CHECK(hit > 40);
  CHECK(habitat.shadow_share < 0.02);
  CHECK_FALSE(habitat.shadow_is_texture);
  const Habitat bare = find_habitat(disc_exemplar(false, false), {}, Rng(1), {});
  CHECK(mean_of(bare.shadow) < 0.002);  // grain makes no lines
}

TEST_CASE("drawn regions win over what is found") {
  Exemplar e = disc_exemplar(false, false);
  Region region{RegionRole::Outside, {{0, 0}, {100, 0}, {100, 100}, {0, 100}}};
  e.annotation.regions.push_back(region);
  for (int y = 0; y < 100; ++y) {
    for (int x = 0; x < 100; ++x) e.regions(x, y) = static_cast<std::uint8_t>(RegionRole::Outside);
  }
  const Habitat habitat = find_habitat(e, {}, Rng(1), {});
  CHECK(habitat.outside(50, 50) == 255);
  CHECK(habitat.outside(kSide - 5, kSide - 5) == 0);
}

TEST_CASE("the plate has no branches and the ground's own tone and grain") {
  const Exemplar e = disc_exemplar(false, true);
  const Habitat habitat = find_habitat(e, {}, Rng(1), {});
  const Plate plate = make_plate(e, habitat, PlateKind::Thin, Rng(1), {});
  double sum = 0.0, square = 0.0, count = 0.0;
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) {
      if (!plate.hole(x, y)) {
        REQUIRE(plate.color(x, y) == e.photo.color(x, y));
        continue;
      }
      REQUIRE(in_disc(x, y));
      const double g = plate.color(x, y).g;
      CHECK(g > 0.33);  // a branch is at 0.2, the line at 0.28
      sum += g, square += g * g, count += 1.0;
      const auto& s = plate.source(x, y);
      if (!std::isnan(s.x())) REQUIRE(plate.hole(static_cast<int>(s.x()), static_cast<int>(s.y())) == 0);
    }
  }
  const double mean = sum / count, deviation = std::sqrt(square / count - mean * mean);
  CHECK(mean == Approx(0.40).margin(0.005));
  CHECK(deviation == Approx(0.01).margin(0.0025));
}

TEST_CASE("the plate of a glowing branch keeps nothing of its glow") {
  Exemplar e;
  e.polarity = Polarity::Glow;
  e.skeleton = Skeleton(Size{kSide, kSide});
  for (int k = 0; k < 30; ++k) e.skeleton.append({Vec3(160.0, 10.0 + 10.0 * k, 0.0), 4.0, k - 1, 0, 0});
  e.photo.color = ColorImage(kSide, kSide);
  Rng rng(2);
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) {
      const double d = std::abs(x - 160.0);
      const float v = static_cast<float>(0.2 + 0.01 * rng.normal() + (d < 4.0 ? 0.8 : 0.3 * std::exp(-(d - 4.0) / 8.0)));
      e.photo.color(x, y) = {v, v, v};
    }
  }
  e.regions = Image<std::uint8_t>(kSide, kSide, static_cast<std::uint8_t>(RegionRole::Habitat));
  HabitatOptions options;
  options.automatic = false;
  const Plate plate = make_plate(e, find_habitat(e, options, Rng(1), {}), PlateKind::Halo, Rng(1), {});
  const ColorImage slow = gaussian_blur(plate.color, 6.0);
  for (int x = 20; x < 300; ++x) {
    INFO("column " << x);
    CHECK(slow(x, 160).g == Approx(0.2).margin(0.02));
  }
  double square = 0.0;
  for (int y = 60; y < 260; ++y) square += std::pow(plate.color(160, y).g - slow(160, y).g, 2);
  CHECK(std::sqrt(square / 200.0) == Approx(0.01).margin(0.004));  // grain of the photo
}

TEST_CASE("dense lines in one place are no texture and all over are") {
  for (const int width : {90, 320}) {
    Exemplar e = disc_exemplar(false, false);
    for (int y = 0; y < kSide; ++y) {
      for (int x = 0; x < width; ++x) {
        if ((x + y / 9) % 24 < 2 && y % 40 != 0) e.photo.color(x, y) = {0.3f, 0.15f, 0.1f};
      }
    }
    HabitatOptions options;
    options.automatic = false;
    options.texture_share = 0.03;
    const Habitat habitat = find_habitat(e, options, Rng(1), {});
    INFO("lines over " << width << " px, share " << habitat.shadow_share);
    CHECK(habitat.shadow_is_texture == (width == 320));
  }
}

TEST_CASE("colours found beside branches only are theirs and reach as far as they do") {
  Exemplar e = disc_exemplar(false, false);
  const Mask none(e.photo.color.size(), 0);
  const Apron plain = measure_apron(e, none);
  CHECK(plain.reach == 0.0);
  constexpr double kSnow = 14.0;  // px beyond the edge
  const Mask near = branch_zone(e.skeleton, e.photo.color.size(), [](double r) { return r + kSnow; });
  for (std::size_t i = 0; i < near.pixels().size(); ++i) {
    if (near.pixels()[i]) e.photo.color.pixels()[i] = {0.2f, 0.3f, 0.8f};
  }
  const Apron snowy = measure_apron(e, none);
  CHECK(snowy.reach >= 12.0);
  CHECK(snowy.reach <= 20.0);
  int missed = 0, wrong = 0;
  const Mask far = invert(dilate(near, 4.0));
  for (std::size_t i = 0; i < near.pixels().size(); ++i) {
    missed += near.pixels()[i] && !snowy.own.pixels()[i];
    wrong += far.pixels()[i] && snowy.own.pixels()[i];
  }
  CHECK(missed < 0.2 * mean_of(near) * static_cast<double>(near.pixels().size()));
  CHECK(wrong == 0);
}

TEST_CASE("a blurred edge is no apron") {
  Exemplar e = disc_exemplar(false, false);
  const Mask none(e.photo.color.size(), 0);
  const Mask near = branch_zone(e.skeleton, e.photo.color.size(), [](double r) { return r + 5.0; });
  for (std::size_t i = 0; i < near.pixels().size(); ++i) {
    if (near.pixels()[i]) e.photo.color.pixels()[i] = {0.2f, 0.3f, 0.8f};
  }
  CHECK(measure_apron(e, none).reach == 0.0);
}

TEST_CASE("lines on wide things of the branches' colours are embedded and lines on ground are not") {
  Mask lines(120, 80, 0), own(120, 80, 0);
  const Mask branches(120, 80, 0);
  for (int y = 10; y < 70; ++y) {
    lines(30, y) = lines(31, y) = lines(90, y) = lines(91, y) = 255;
    for (int x = 20; x < 42; ++x) own(x, y) = 255;  // around the first line only
    own(90, y) = own(91, y) = 255;                  // the second has the colour, but is no wide thing
  }
  CHECK(embedded_share(lines, own, branches) == Approx(0.5));
  CHECK(embedded_share(lines, Mask(120, 80, 0), branches) == 0.0);
  CHECK(embedded_share(lines, own, own) == 0.0);  // what is annotated does not count
}
