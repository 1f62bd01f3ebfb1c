// SPDX-License-Identifier: GPL-3.0-or-later
// Wrong files: cut, flipped, lying, foreign. Never a crash, never half a picture, never more memory than allowed.
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfMultiPartOutputFile.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfOutputPart.h>
#include <OpenEXR/ImfPartType.h>
#include <sys/resource.h>

#include <catch2/catch.hpp>
#include <cmath>

#include "ramify/core/atomic_file.h"
#include "ramify/core/error.h"
#include "ramify/image/image_io.h"
#include "support/pictures.h"
#include "support/png_parts.h"
#include "support/temp_folder.h"

using namespace ramify;

namespace {

ColorImage smooth_picture(int width, int height) {
  ColorImage image(width, height);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x)
      image(x, y) = {x / float(width), y / float(height), 0.5f + 0.3f * std::sin(0.2f * x * y)};
  }
  return image;
}

// Reads and reports whether the bytes were refused as they should be: only InputError or LimitError may come out.
bool refused(const std::string& bytes, const LoadLimits& limits = {}) {
  try {
    decode_image(bytes, "a picture", limits);
    return false;
  } catch (const InputError&) {
    return true;
  } catch (const LimitError&) {
    return true;
  }
}

std::string message_of(const std::string& bytes) {
  try {
    decode_image(bytes, "a.png");
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

std::string little(std::uint64_t value, int bytes) {
  std::string out;
  for (int i = 0; i < bytes; ++i) out += static_cast<char>((value >> (8 * i)) & 0xFF);
  return out;
}

// Value of an EXR attribute, found by its name, replaced.
std::string with_attribute(std::string exr, const std::string& name, const std::string& value) {
  const std::size_t type = exr.find(name + '\0') + name.size() + 1;
  const std::size_t at = exr.find('\0', type) + 5;
  return exr.replace(at, value.size(), value);
}

}  // namespace

TEST_CASE("what is no picture is named") {
  CHECK(message_of("") == "a.png: is empty");
  CHECK_THAT(message_of("<!DOCTYPE html><html></html>"), Catch::Contains("an HTML page"));
  CHECK_THAT(message_of("PK\x03\x04 zip"), Catch::Contains("ZIP archive"));
  CHECK_THAT(message_of("GIF89a..."), Catch::Contains("a GIF picture"));
  CHECK_THAT(message_of("<?xml version=\"1.0\"?><svg/>"), Catch::Contains("an SVG drawing"));
  CHECK_THAT(message_of("%PDF-1.7"), Catch::Contains("a PDF document"));
  CHECK_THAT(message_of("hello, world\n"), Catch::Contains("is text"));
  CHECK_THAT(message_of("{\"format\": \"ramify-annotation\"}"), Catch::Contains("JSON"));
  CHECK_THAT(message_of(std::string("\x00\x01\x02\x03", 4)), Catch::Contains("unknown kind"));
  CHECK_THAT(message_of("BM......"), Catch::Contains("BMP"));
}

TEST_CASE("the right picture under a wrong name works with one warning") {
  const ColorImage image = level_noise(4, 4, 8);
  const LoadedImage read = decode_image(encode_image("a.png", image, nullptr, {}), "a.jpg");
  CHECK(read.color == image);
  CHECK(read.warnings == std::vector<std::string>{"it is a PNG file, whatever its name says"});
}

TEST_CASE("every prefix of a png is refused") {
  const ColorImage image = level_noise(6, 5, 8);
  const std::string png = encode_image("a.png", image, nullptr, {.recipe = "{}"});
  REQUIRE(png.size() > 190);
  for (std::size_t length = 0; length < png.size(); ++length) {
    if (!refused(png.substr(0, length))) FAIL("a PNG of " << length << " of " << png.size() << " bytes was read");
  }
  CHECK(decode_image(png, "a.png").color == image);
}

TEST_CASE("cut files of every format are refused unless allowed") {
  const ColorImage image = smooth_picture(90, 70);
  for (const char* name : {"a.png", "a.jpg", "a.tif", "a.exr", "a.webp"}) {
    CAPTURE(name);
    const std::string whole = encode_image(name, image, nullptr, {.bits = fitting_bits(name, 8)});
    for (int percent = 0; percent < 100; ++percent) {
      if (!refused(whole.substr(0, whole.size() * percent / 100))) FAIL(name << " cut to " << percent << " % was read");
    }
    for (int missing = 1; missing <= 3; ++missing) {
      if (!refused(whole.substr(0, whole.size() - missing)))
        FAIL(name << " without its last " << missing << " bytes was read");
    }
    for (int percent = 0; percent < 100; percent += 3)
      refused(whole.substr(0, whole.size() * percent / 100), {.allow_truncated = true});
    if (std::string(name) == "a.webp" || std::string(name) == "a.tif") continue;  // all or nothing in these
    const LoadedImage part = decode_image(whole.substr(0, whole.size() * 6 / 10), name, {.allow_truncated = true});
    const ColorImage full = decode_image(whole, name).color;
    CHECK(part.warnings.size() == 1);
    REQUIRE(part.color.size() == full.size());
    for (int x = 0; x < 90; ++x) CHECK(part.color(x, 3) == full(x, 3));
    CHECK(!(part.color(45, 69) == full(45, 69)));
  }
}

TEST_CASE("flipping any bit gives a picture or an error that names the file") {
  const ColorImage image = level_noise(5, 4, 8);
  for (const char* name : {"a.png", "a.tif", "a.exr", "a.webp", "a.jpg"}) {
    CAPTURE(name);
    const std::string whole = encode_image(
        name, image, nullptr, {.bits = fitting_bits(name, 8), .recipe = std::string(name) == "a.jpg" ? "" : "{}"});
    int errors = 0;
    for (std::size_t bit = 0; bit < 8 * whole.size(); ++bit) {
      std::string flipped = whole;
      flipped[bit / 8] = static_cast<char>(flipped[bit / 8] ^ (1 << (bit % 8)));
      errors += refused(flipped, {.pixels = 1e5});
    }
    CHECK(errors > 0);
    if (std::string(name) == "a.png") CHECK(errors == static_cast<int>(8 * whole.size()));  // checksums see every bit
  }
}

TEST_CASE("a wrong checksum is named with its place") {
  std::string png = encode_image("a.png", level_noise(4, 4, 8), nullptr, {});
  png[png.size() - 20] ^= 1;
  CHECK_THAT(message_of(png), Catch::Contains("checksum of its block 'IDAT' at byte"));
}

TEST_CASE("picture bombs end before they are decoded") {
  const std::string bomb = black_png(32000, 32000, 1);
  CHECK(bomb.size() < 200000);
  CHECK_THROWS_AS(decode_image(bomb, "bomb.png"), LimitError);
  CHECK_THROWS_AS(decode_image(black_png(2000, 2000, 8), "a.png", {.pixels = 1e6}), LimitError);
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
#ifndef __SANITIZE_ADDRESS__
  CHECK(usage.ru_maxrss < 100 * 1024);
#endif
}

TEST_CASE("compressed texts and profiles cannot blow up") {
  const std::string zeros = deflated_zeros(64u << 20);
  const std::string text = png_chunk("zTXt", std::string("k\0\0", 3) + zeros);
  const std::string international = png_chunk("iTXt", std::string("k\0\1\0\0\0", 6) + zeros);
  const std::string profile = png_chunk("iCCP", std::string("k\0\0", 3) + zeros);
  for (const std::string& chunk : {text, international, profile}) {
    const LoadedImage read = decode_image(black_png(3, 3, 8, chunk), "a.png");
    CHECK(read.color == ColorImage(3, 3));
    REQUIRE(read.warnings.size() == 1);
    CHECK_THAT(read.warnings[0], Catch::Contains("was ignored"));
  }
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
#ifndef __SANITIZE_ADDRESS__
  CHECK(usage.ru_maxrss < 100 * 1024);
#endif
  // An Exif block whose directory points at itself, beyond itself, or claims 65535 fields.
  for (const std::string& exif : {std::string("II*\0\4\0\0\0", 8), std::string("II*\0\xff\xff\xff\xff\0\0", 10),
                                  std::string("MM\0*\0\0\0\x08\xff\xff", 10) + std::string(50, '\1')}) {
    CHECK(decode_image(black_png(3, 3, 8, png_chunk("eXIf", exif)), "a.png").color.size() == Size{3, 3});
  }
}

TEST_CASE("sizes that overflow or are nothing are refused") {
  for (const auto& [w, h] : {std::pair{0x80000000u, 0x80000000u},
                             {0xFFFFFFFFu, 1u},
                             {0x7FFFFFFFu, 0x7FFFFFFFu},
                             {0u, 0u},
                             {5u, 0u},
                             {0u, 5u}}) {
    CHECK(refused(png_header(w, h, 8, 2) + png_chunk("IDAT", deflated_zeros(10)) + png_chunk("IEND", "")));
  }
  const std::string exr = encode_image("a.exr", level_noise(4, 4, 8), nullptr, {.bits = 16});
  for (const std::string& window :
       {little(0, 8) + little(0x7FFFFFFF, 4) + little(0x7FFFFFFF, 4), little(5, 8) + little(0, 8),
        little(0x80000000, 4) + little(0x80000000, 4) + little(0x7FFFFFFF, 4) + little(0x7FFFFFFF, 4),
        little(0, 8) + little(15999, 4) + little(15999, 4)}) {
    CHECK(refused(with_attribute(exr, "dataWindow", window)));
  }
  std::string jpeg = encode_image("a.jpg", level_noise(4, 4, 8), nullptr, {});
  const std::size_t frame = jpeg.find("\xff\xc0");
  REQUIRE(frame != std::string::npos);
  CHECK(refused(jpeg.replace(frame + 5, 4, std::string(4, '\0'))));
  CHECK_THROWS_AS(decode_image(jpeg.replace(frame + 5, 4, std::string(4, '\xff')), "a.jpg", {.pixels = 256e6}),
                  LimitError);
}

TEST_CASE("tiff directories that circle or lie end with an error") {
  const auto field = [](unsigned tag, unsigned type, unsigned count, unsigned value) {
    return little(tag, 2) + little(type, 2) + little(count, 4) + little(value, 4);
  };
  const auto tiff = [&](unsigned strip, unsigned bytes, unsigned next) {
    const std::string fields = field(256, 3, 1, 4) + field(257, 3, 1, 4) + field(258, 3, 1, 8) + field(259, 3, 1, 1) +
                               field(262, 3, 1, 1) + field(273, 4, 1, strip) + field(277, 3, 1, 1) +
                               field(278, 3, 1, 4) + field(279, 4, 1, bytes);
    return std::string("II*\0", 4) + little(8, 4) + little(9, 2) + fields + little(next, 4) + std::string(16, '\x40');
  };
  const unsigned pixels = 8 + 2 + 9 * 12 + 4;
  CHECK(decode_image(tiff(pixels, 16, 0), "a.tif").color(3, 3).r == 0x40 / 255.0f);
  CHECK_THAT(message_of(tiff(pixels, 16, 8)), Catch::Contains("in a circle"));
  CHECK(refused(tiff(pixels + 1, 16, 0)));
  CHECK(refused(tiff(0xFFFFFFF0, 16, 0)));
  CHECK(refused(tiff(pixels, 0xFFFFFFFF, 0)));
  std::string many = tiff(pixels, 16, pixels + 16);
  for (unsigned page = 0; page < 1000000; ++page) {
    many += little(0, 2) + little(many.size() + 6, 4);
  }
  CHECK_THAT(message_of(many), Catch::Contains("more than 10000 pages"));
}

TEST_CASE("deep and multi-part and odd exr files") {
  const TempFolder folder;
  const int width = 6, height = 5;
  std::vector<float> values(width * height, 0.25f);
  values[7] = std::nanf(""), values[8] = INFINITY, values[9] = 1e38f;
  const auto write = [&](const std::string& path, const std::vector<std::string>& channels, int parts) {
    std::vector<Imf::Header> headers;
    for (int i = 0; i < parts; ++i) {
      Imf::Header header(width, height);
      header.setName("part" + std::to_string(i));
      header.setType(Imf::SCANLINEIMAGE);
      for (const std::string& channel : channels) header.channels().insert(channel, Imf::Channel(Imf::FLOAT));
      headers.push_back(header);
    }
    Imf::MultiPartOutputFile file(path.c_str(), headers.data(), parts);
    for (int i = 0; i < parts; ++i) {
      Imf::OutputPart part(file, i);
      Imf::FrameBuffer buffer;
      for (const std::string& channel : channels) {
        buffer.insert(channel, Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(values.data()), 4, 4 * width));
      }
      part.setFrameBuffer(buffer);
      part.writePixels(height);
    }
  };
  write(folder / "two.exr", {"R", "G", "B"}, 2);
  write(folder / "grey.exr", {"Y"}, 1);
  write(folder / "depth.exr", {"Z", "id"}, 1);
  const LoadedImage two = load_image(folder / "two.exr");
  REQUIRE(two.warnings.size() == 2);
  CHECK(two.warnings[0] == "it has 2 parts; the first was used");
  CHECK(two.warnings[1] == "6 values were not finite and became 0");
  const LoadedImage grey = load_image(folder / "grey.exr");
  CHECK(grey.warnings == std::vector<std::string>{"2 values were not finite and became 0"});
  CHECK(grey.color(0, 0).b == Approx(0.5371f).margin(1e-3));  // 0.25 linear
  CHECK(grey.color(1, 1) == Rgb{0, 0, 0});
  CHECK(std::isfinite(grey.color(3, 1).r));
  CHECK_THROWS_WITH(load_image(folder / "depth.exr"), Catch::Contains("it has: Z, id"));
  std::string deep = read_file(folder / "grey.exr", 1 << 20);
  deep[5] = static_cast<char>(deep[5] | 0x08);
  CHECK_THAT(message_of(deep), Catch::Contains("deep"));
}

TEST_CASE("thin and large pictures work") {
  for (const auto& [w, h] : {std::pair{1, 1}, {1, 20000}, {20000, 1}}) {
    for (const char* name : {"a.png", "a.tif", "a.exr", "a.jpg"}) {
      CAPTURE(name, w, h);
      const ColorImage image(w, h, {1, 1, 1});
      const ColorImage read =
          decode_image(encode_image(name, image, nullptr, {.bits = fitting_bits(name, 8)}), name).color;
      CHECK(read.size() == image.size());
      CHECK(read(w - 1, h - 1).g == Approx(1.0f).margin(1e-3));
    }
  }
  CHECK(decode_image(encode_image("a.jpg", ColorImage(65500, 1), nullptr, {}), "a.jpg").color.width() == 65500);
  CHECK_THROWS_AS(encode_image("a.jpg", ColorImage(65501, 1), nullptr, {}), OutputError);
}
