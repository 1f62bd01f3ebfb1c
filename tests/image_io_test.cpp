// SPDX-License-Identifier: GPL-3.0-or-later
#include <catch2/catch.hpp>

#include "ramify/core/atomic_file.h"
#include "ramify/core/error.h"
#include "ramify/core/random.h"
#include "ramify/image/image_io.h"
#include "support/temp_folder.h"

using namespace ramify;

namespace {

// Random levels of the given depth, so that writing at that depth loses nothing.
ColorImage noise(int width, int height, int bits, std::uint64_t seed = 1) {
  ColorImage image(width, height);
  Rng rng(seed);
  const int top = (1 << bits) - 1;
  for (Rgb& pixel : image.pixels()) {
    for (int c = 0; c < 3; ++c) pixel[c] = static_cast<float>(rng.below(top + 1)) / static_cast<float>(top);
  }
  return image;
}

Mask mask_noise(int width, int height) {
  Mask mask(width, height);
  Rng rng(2);
  for (auto& value : mask.pixels()) value = static_cast<std::uint8_t>(rng.below(256));
  return mask;
}

}  // namespace

TEST_CASE("sha256 gives the published digests") {
  CHECK(sha256_hex("") == "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  CHECK(sha256_hex("abc") == "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
}

TEST_CASE("png keeps 8 and 16 bits and alpha and recipe") {
  const TempFolder folder;
  for (const int bits : {8, 16}) {
    const ColorImage image = noise(7, 5, bits);
    const Mask alpha = mask_noise(7, 5);
    save_image(folder / "a.png", image, alpha, {.bits = bits, .recipe = "{\"a\": \"é\"}"});
    const LoadedImage read = load_image(folder / "a.png");
    CHECK(read.color == image);
    CHECK(read.alpha == alpha);
    CHECK(read.bits == bits);
    CHECK(read.texts.at("ramify-recipe") == "{\"a\": \"é\"}");
    CHECK(read.warnings.empty());
  }
}

TEST_CASE("masks and labels come back exactly") {
  const TempFolder folder;
  const Mask mask = mask_noise(9, 4);
  save_mask(folder / "m.png", mask);
  CHECK(load_mask(folder / "m.png") == mask);
}

TEST_CASE("every prefix of a png is refused") {
  const std::string png = encode_image("a.png", noise(5, 4, 8), nullptr, {.recipe = "x"});
  REQUIRE(png.size() < 300);
  for (std::size_t length = 0; length < png.size(); ++length) {
    CHECK_THROWS_AS(decode_image(png.substr(0, length), "a.png"), InputError);
  }
  CHECK(decode_image(png, "a.png").color == noise(5, 4, 8));
}
