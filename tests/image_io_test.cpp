// SPDX-License-Identifier: GPL-3.0-or-later
// Right files: every kind is read to the right values, and what we write others read.
#include <catch2/catch.hpp>
#include <fstream>
#include <string>

#include "ramify/core/atomic_file.h"
#include "ramify/core/error.h"
#include "ramify/image/image_io.h"
#include "support/pictures.h"
#include "support/temp_folder.h"

using namespace ramify;

namespace {

struct Case {
  const char* file;
  int channels;  // 1 = grey
  int bits;
  float scale = 1.0f, offset = 0.0f;  // value = level * scale + offset
  int warnings = 0;
};

float largest_difference(const ColorImage& a, const ColorImage& b) {
  REQUIRE(a.size() == b.size());
  float largest = 0.0f;
  for (std::size_t i = 0; i < a.pixels().size(); ++i) {
    for (int c = 0; c < 3; ++c) largest = std::max(largest, std::abs(a.pixels()[i][c] - b.pixels()[i][c]));
  }
  return largest;
}

ColorImage made_picture(const Case& made) {
  ColorImage image(12, 9);
  for (int y = 0; y < 9; ++y) {
    for (int x = 0; x < 12; ++x) {
      for (int c = 0; c < 3; ++c)
        image(x, y)[c] = made_level(x, y, made.channels == 1 ? 0 : c) * made.scale + made.offset;
    }
  }
  return image;
}

}  // namespace

TEST_CASE("sha256 gives the published digests") {
  CHECK(sha256_hex("") == "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  CHECK(sha256_hex("abc") == "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
}

TEST_CASE("kinds of pictures made by others are read to the right values") {
  const TempFolder folder;
  REQUIRE(run_python("make_pictures.py", folder.path()));
  const Case cases[] = {
      {"lossless.webp", 3, 8},
      {"lzw.tif", 3, 8},
      {"rgb16.tif", 3, 16},
      {"big_endian16.tif", 3, 16},
      {"bigtiff.tif", 3, 8},
      {"tiled.tif", 3, 8},
      {"planar.tif", 3, 8},
      {"alpha.tif", 3, 8},
      {"alpha.webp", 3, 8},
      {"grey_alpha.png", 1, 8},
      {"float.tif", 3, 32, 3.0f, -1.0f},
      {"float_grey.tif", 1, 32, 3.0f, -1.0f},
      {"pages.tif", 3, 8, 1.0f, 0.0f, 1},
  };
  for (const Case& made : cases) {
    CAPTURE(made.file);
    const LoadedImage read = load_image(folder / made.file);
    CHECK(read.bits == made.bits);
    CHECK(largest_difference(read.color, made_picture(made)) < 1e-6f);
    CHECK(static_cast<int>(read.warnings.size()) == made.warnings);
  }
  for (const auto& [file, channel] : {std::pair{"grey_alpha.png", 1}, {"alpha.tif", 3}, {"alpha.webp", 3}}) {
    const Mask alpha = load_image(folder / file).alpha;
    REQUIRE(alpha.size() == Size{12, 9});
    for (int i = 0; i < 12 * 9; ++i) CHECK(alpha.pixels()[i] == std::lround(255 * made_level(i % 12, i / 12, channel)));
  }
  CHECK(load_image(folder / "palette.png").color == load_image(folder / "palette_as_rgb.png").color);
  for (int i = 0; i < 12 * 9; ++i) {
    CHECK(load_mask(folder / "bit.png").pixels()[i] == (made_level(i % 12, i / 12, 0) * 255.0f > 127.5f ? 255 : 0));
  }
  CHECK(largest_difference(load_image(folder / "progressive.jpg").color, made_picture({"", 3, 8})) < 0.5f);

  // Colours that were multiplied with alpha are divided by it again.
  const LoadedImage associated = load_image(folder / "associated.tif");
  float off = 0.0f;
  for (int i = 0; i < 12 * 9; ++i) {
    const float wanted = made_level(i % 12, i / 12, 3) == 0.0f ? 0.0f : made_level(i % 12, i / 12, 1);
    off = std::max(off, std::abs(associated.color.pixels()[i].g - wanted));
  }
  CHECK(off < 1e-5f);

  const LoadedImage cleaned = load_image(folder / "not_finite.tif");
  REQUIRE(cleaned.warnings.size() == 1);
  CHECK(cleaned.warnings[0] == "3 values were not finite and became 0");
  CHECK(cleaned.color(3, 2).g == 0.0f);
  CHECK(cleaned.color(5, 4).r == 0.0f);

  // CMYK goes through a profile: no ink is paper white, magenta and yellow make a red.
  const Rgb white = load_image(folder / "white_cmyk.jpg").color(4, 4);
  for (int c = 0; c < 3; ++c) CHECK(white[c] == Approx(1.0f).margin(0.02));
  const Rgb red = load_image(folder / "red_cmyk.jpg").color(4, 4);
  CHECK(red.r > 0.8f);
  CHECK(red.g < 0.3f);
  CHECK(red.b < 0.3f);

  for (const char* refused : {"signed.tif", "complex.tif", "double.tif", "gif.png"}) {
    CAPTURE(refused);
    CHECK_THROWS_AS(load_image(folder / refused), InputError);
  }
}

TEST_CASE("what we write other libraries read") {
  const TempFolder folder;
  const ColorImage image = level_noise(12, 9, 8);
  const Mask alpha = mask_noise(12, 9);
  std::string expected;
  Image<std::uint16_t> labels(12, 9);
  ScalarImage field(12, 9);
  for (int i = 0; i < 12 * 9; ++i) {
    const Rgb& c = image.pixels()[i];
    const float values[4] = {c.r, c.g, c.b, static_cast<float>(alpha.pixels()[i]) / 255.0f};
    expected.append(reinterpret_cast<const char*>(values), sizeof values);
    labels.pixels()[i] = static_cast<std::uint16_t>(600 * i);
    field.pixels()[i] = c.r * 9.0f - 4.0f;
  }
  write_file(folder / "expected.f32", expected);
  for (const int bits : {8, 16}) {
    SaveOptions options{.bits = bits, .recipe = "{\"é\": 1}"};
    save_image(folder / ("rgba" + std::to_string(bits) + ".png"), image, alpha, options);
    save_image(folder / ("rgba" + std::to_string(bits) + ".tif"), image, alpha, options);
  }
  save_image(folder / "rgb32.tif", image, {.bits = 32});
  save_image(folder / "rgb.jpg", image, {.quality = 100});
  save_image(folder / "rgb.webp", image, {.quality = 100});
  save_mask16(folder / "labels.png", labels);
  save_scalar(folder / "field.tif", field);
  CHECK(run_python("check_pictures.py", folder.path()));
}

TEST_CASE("every format gives back what was written with its recipe") {
  const TempFolder folder;
  struct Format {
    const char* name;
    int bits;
    bool alpha;
    float tolerance;
  };
  const std::string recipe = "{\"a\": [1, 2], \"text\": \"é <&> \\n \\u0041\"}";
  for (const Format& format : {Format{"a.png", 8, true, 0},
                               {"a.png", 16, true, 0},
                               {"a.tif", 8, true, 0},
                               {"a.tiff", 16, true, 0},
                               {"a.tif", 32, true, 0},
                               {"a.exr", 16, false, 2e-3f},
                               {"a.exr", 32, false, 2e-6f},
                               {"a.jpg", 8, false, 0.06f},
                               {"a.JPEG", 8, false, 0.06f},
                               {"a.webp", 8, true, 0}}) {
    CAPTURE(format.name, format.bits);
    const ColorImage image = level_noise(17, 9, std::min(format.bits, 16));
    const Mask alpha = mask_noise(17, 9);
    const SaveOptions options{.bits = format.bits, .quality = 100, .recipe = recipe};
    const std::string path = folder / format.name;
    format.alpha ? save_image(path, image, alpha, options) : save_image(path, image, options);
    const LoadedImage read = load_image(path);
    if (std::string(format.name) == "a.webp") {  // forgets the colour of what cannot be seen
      for (int i = 0; i < 17 * 9; ++i) CHECK((alpha.pixels()[i] == 0 || read.color.pixels()[i] == image.pixels()[i]));
    } else {
      CHECK(largest_difference(read.color, image) <= format.tolerance);
    }
    CHECK(read.bits == format.bits);
    CHECK(read.texts.at("ramify-recipe") == recipe);
    CHECK(read.warnings == std::vector<std::string>{});
    CHECK(read.sha256 == sha256_hex(read_file(path, 1 << 20)));
    if (format.alpha) CHECK(read.alpha == alpha);
    if (!format.alpha) CHECK(read.alpha.empty());
    CHECK(encode_image(path, image, nullptr, options) == encode_image(path, image, nullptr, options));
  }
}

TEST_CASE("exr holds linear light beyond white and divides alpha out") {
  ColorImage image(2, 1);
  image(0, 0) = {4.0f, -0.5f, 0.5f};
  image(1, 0) = {0.25f, 0.5f, 0.75f};
  Mask alpha(2, 1, 255);
  alpha(1, 0) = 51;
  const LoadedImage read = decode_image(encode_image("a.exr", image, &alpha, {.bits = 32}), "a.exr");
  CHECK(largest_difference(read.color, image) < 1e-5f);
  CHECK(read.alpha == alpha);
  image(0, 0).g = std::nanf("");
  const LoadedImage cleaned = decode_image(encode_image("a.exr", image, nullptr, {.bits = 32}), "a.exr");
  CHECK(cleaned.color(0, 0).g == 0.0f);
  REQUIRE(cleaned.warnings.size() == 1);
  CHECK(cleaned.warnings[0] == "1 values were not finite and became 0");
}

TEST_CASE("masks and labels and fields come back exactly") {
  const TempFolder folder;
  const Mask mask = mask_noise(9, 4);
  save_mask(folder / "m.png", mask);
  CHECK(load_mask(folder / "m.png") == mask);
  ScalarImage field(9, 4);
  for (int i = 0; i < 36; ++i) field.pixels()[i] = 0.37f * i - 5.0f;
  save_scalar(folder / "f.tif", field);
  CHECK(load_scalar(folder / "f.tif") == field);
  CHECK_THROWS_AS(save_mask(folder / "m.jpg", mask), OutputError);
  CHECK(folder.entries() == std::vector<std::string>{"f.tif", "m.png"});
}

TEST_CASE("eight bits are rounded and dithered only on request") {
  ColorImage ramp(256, 64);
  for (int y = 0; y < 64; ++y) {
    for (int x = 0; x < 256; ++x) ramp(x, y) = {(10.0f + x / 256.0f) / 255.0f, -0.2f, 1.7f};
  }
  const ColorImage plain = decode_image(encode_image("a.png", ramp, nullptr, {}), "a.png").color;
  CHECK(plain(100, 0) == Rgb{10 / 255.0f, 0, 1});
  CHECK(plain(200, 0) == Rgb{11 / 255.0f, 0, 1});
  const ColorImage dithered = decode_image(encode_image("a.png", ramp, nullptr, {.dither = true}), "a.png").color;
  double mean = 0.0;
  for (int y = 0; y < 64; ++y) {
    for (int x = 64; x < 128; ++x) mean += dithered(x, y).r * 255.0 / (64 * 64);
  }
  CHECK(mean == Approx(10.0 + 95.5 / 256.0).margin(0.03));  // plain rounding would give 10
  CHECK(dithered(0, 0).b == 1.0f);
}

TEST_CASE("names and depths a format cannot hold are refused before any work") {
  const TempFolder folder;
  const ColorImage image = level_noise(3, 3, 8);
  for (const char* name : {"a", "a.gif", "a.png/", "png", "a.png.txt", ""})
    CHECK_THROWS_AS(check_image_name(name), OptionError);
  for (const char* name : {"a.png", "b.JPG", "/x/y.z/c.tiff", "d.exr", "e.webp"}) CHECK_NOTHROW(check_image_name(name));
  CHECK_THROWS_AS(save_image(folder / "a.jpg", image, {.bits = 16}), OptionError);
  CHECK_THROWS_AS(save_image(folder / "a.png", image, {.bits = 32}), OptionError);
  CHECK_THROWS_AS(save_image(folder / "a.exr", image, {.bits = 8}), OptionError);
  CHECK_THROWS_AS(save_image(folder / "a.jpg", image, Mask(3, 3)), OutputError);
  CHECK_THROWS_AS(save_image(folder / "a.png", ColorImage()), OutputError);
  CHECK_THROWS_AS(save_image(folder / "a.webp", ColorImage(16384, 1)), OutputError);
  CHECK(folder.entries().empty());
  CHECK(fitting_bits("a.png", 32) == 16);
  CHECK(fitting_bits("a.exr", 8) == 16);
  CHECK(fitting_bits("a.jpg", 16) == 8);
  CHECK(fitting_bits("a.tif", 32) == 32);
}
