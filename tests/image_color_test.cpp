// SPDX-License-Identifier: GPL-3.0-or-later
// Orientation and colour profiles are applied once, to the values that outside references give.
#include <lcms2.h>

#include <array>
#include <catch2/catch.hpp>
#include <cmath>

#include "ramify/core/atomic_file.h"
#include "ramify/image/color.h"
#include "ramify/image/image_io.h"
#include "support/pictures.h"
#include "support/png_parts.h"
#include "support/temp_folder.h"

using namespace ramify;

namespace {

std::string bytes_of(cmsHPROFILE profile) {
  cmsUInt32Number size = 0;
  cmsSaveProfileToMem(profile, nullptr, &size);
  std::string bytes(size, '\0');
  cmsSaveProfileToMem(profile, bytes.data(), &size);
  cmsCloseProfile(profile);
  return bytes;
}

std::string rgb_profile(cmsCIExyY white, cmsCIExyYTRIPLE primaries, cmsToneCurve* curve) {
  cmsToneCurve* curves[3] = {curve, curve, curve};
  const std::string bytes = bytes_of(cmsCreateRGBProfile(&white, &primaries, curves));
  cmsFreeToneCurve(curve);
  return bytes;
}

cmsToneCurve* srgb_curve() {
  const double parameters[5] = {2.4, 1 / 1.055, 0.055 / 1.055, 1 / 12.92, 0.04045};
  return cmsBuildParametricToneCurve(nullptr, 4, parameters);
}

const cmsCIExyY kD65{0.3127, 0.3290, 1.0}, kD50{0.3457, 0.3585, 1.0};
const cmsCIExyYTRIPLE kP3{{0.680, 0.320, 1}, {0.265, 0.690, 1}, {0.150, 0.060, 1}};
const cmsCIExyYTRIPLE kProPhoto{{0.734699, 0.265301, 1}, {0.159597, 0.840403, 1}, {0.036598, 0.000105, 1}};
const cmsCIExyYTRIPLE kSrgb{{0.64, 0.33, 1}, {0.30, 0.60, 1}, {0.15, 0.06, 1}};

std::string profile_chunk(const std::string& profile) {
  std::string packed(compressBound(profile.size()), '\0');
  uLongf size = packed.size();
  compress(reinterpret_cast<Bytef*>(packed.data()), &size, reinterpret_cast<const Bytef*>(profile.data()),
           profile.size());
  return png_chunk("iCCP", std::string("test\0\0", 6) + packed.substr(0, size));
}

LoadedImage load_with(const std::string& profile, const ColorImage& image) {
  // Our own sRGB chunk stays behind; the profile is what says more.
  return decode_image(with_chunk(encode_image("a.png", image, nullptr, {.bits = 16}), profile_chunk(profile)), "a.png");
}

void check_color(const Rgb& got, const std::array<double, 3>& wanted, double margin) {
  for (int c = 0; c < 3; ++c) CHECK(got[c] == Approx(wanted[c]).margin(margin));
}

}  // namespace

TEST_CASE("the eight orientations come upright with their alpha") {
  const TempFolder folder;
  REQUIRE(run_python("make_orientations.py", folder.path()));
  for (int orientation = 1; orientation <= 8; ++orientation) {
    CAPTURE(orientation);
    const std::string stem = folder / std::to_string(orientation);
    const LoadedImage upright = load_image(stem + "_upright.png");
    REQUIRE(upright.color.width() == (orientation < 5 ? 8 : 5));
    for (const char* extension : {".png", ".tif", ".webp"}) {
      CAPTURE(extension);
      const LoadedImage read = load_image(stem + extension);
      CHECK(read.color == upright.color);
      CHECK(read.alpha == upright.alpha);
    }
    CHECK(load_image(stem + ".jpg").color == load_image(stem + "_jpg_upright.png").color);
  }
}

TEST_CASE("display p3 becomes the published srgb values without clipping") {
  ColorImage image(4, 1);
  image(0, 0) = {1, 0, 0}, image(1, 0) = {0, 1, 0}, image(2, 0) = {0, 0, 1}, image(3, 0) = {1, 1, 1};
  const LoadedImage read = load_with(rgb_profile(kD65, kP3, srgb_curve()), image);
  CHECK(read.warnings.empty());
  check_color(read.color(0, 0), {1.0930, -0.2267, -0.1501}, 3e-3);  // CSS Color 4
  check_color(read.color(1, 0), {-0.5116, 1.0183, -0.3107}, 3e-3);
  check_color(read.color(2, 0), {0.0, 0.0, 1.0420}, 1e-2);
  check_color(read.color(3, 0), {1, 1, 1}, 1e-3);
}

TEST_CASE("prophoto greys stay grey with their gamma of 1.8 undone") {
  ColorImage image(9, 1);
  for (int x = 0; x < 9; ++x) image(x, 0) = {x / 8.0f, x / 8.0f, x / 8.0f};
  const LoadedImage read = load_with(rgb_profile(kD50, kProPhoto, cmsBuildGamma(nullptr, 1.8)), image);
  for (int x = 0; x < 9; ++x) {
    const double value = srgb_from_linear(static_cast<float>(std::pow(x / 8.0, 1.8)));
    check_color(read.color(x, 0), {value, value, value}, 2e-3);
  }
}

TEST_CASE("a grey profile applies to grey pictures") {
  const TempFolder folder;
  cmsToneCurve* linear = cmsBuildGamma(nullptr, 1.0);
  const std::string profile = bytes_of(cmsCreateGrayProfile(&kD50, linear));
  cmsFreeToneCurve(linear);
  Mask ramp(256, 1);
  for (int x = 0; x < 256; ++x) ramp(x, 0) = static_cast<std::uint8_t>(x);
  save_mask(folder / "a.png", ramp);
  const std::string file = with_chunk(read_file(folder / "a.png", 1 << 20), profile_chunk(profile));
  const LoadedImage read = decode_image(file, "a.png");
  for (int x = 0; x < 256; x += 5) CHECK(read.color(x, 0).g == Approx(srgb_from_linear(x / 255.0f)).margin(2e-3));
}

TEST_CASE("an srgb profile leaves the values exactly as they are") {
  const ColorImage image = level_noise(40, 10, 16);
  const LoadedImage read = load_with(rgb_profile(kD65, kSrgb, srgb_curve()), image);
  CHECK(read.color == image);
  CHECK(read.warnings.empty());
}

TEST_CASE("broken profiles and profiles of another kind are left out with a warning") {
  const ColorImage image = level_noise(6, 4, 16);
  const std::string good = rgb_profile(kD65, kP3, srgb_curve());
  cmsToneCurve* linear = cmsBuildGamma(nullptr, 1.0);
  const std::string grey = bytes_of(cmsCreateGrayProfile(&kD50, linear));
  cmsFreeToneCurve(linear);
  for (const std::string& profile : {std::string("not a profile"), good.substr(0, good.size() / 2), grey}) {
    const LoadedImage read = load_with(profile, image);
    CHECK(read.color == image);
    REQUIRE(read.warnings.size() == 1);
    CHECK(read.warnings[0].find("profile") != std::string::npos);
  }
}
