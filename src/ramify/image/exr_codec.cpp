// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/image/exr_codec.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfIO.h>
#include <OpenEXR/ImfInputPart.h>
#include <OpenEXR/ImfMultiPartInputFile.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfStandardAttributes.h>
#include <OpenEXR/ImfStringAttribute.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <new>

#include "ramify/core/error.h"
#include "ramify/image/color.h"
#include "ramify/image/image_container.h"

namespace ramify {
namespace {

class MemoryReader : public Imf::IStream {
 public:
  explicit MemoryReader(std::string_view bytes) : IStream("memory"), bytes_(bytes) {}
  bool read(char* to, int count) override {
    if (count < 0 || static_cast<std::size_t>(count) > bytes_.size() - at_)
      throw std::runtime_error("unexpected end of file");
    std::memcpy(to, bytes_.data() + at_, count);
    at_ += count;
    return at_ < bytes_.size();
  }
  std::uint64_t tellg() override { return at_; }
  void seekg(std::uint64_t to) override {
    if (to > bytes_.size()) throw std::runtime_error("unexpected end of file");
    at_ = to;
  }
  void clear() override {}

 private:
  std::string_view bytes_;
  std::size_t at_ = 0;
};

class MemoryWriter : public Imf::OStream {
 public:
  MemoryWriter() : OStream("memory") {}
  void write(const char* from, int count) override {
    if (at_ + count > bytes_.size()) bytes_.resize(at_ + count);
    std::memcpy(bytes_.data() + at_, from, count);
    at_ += count;
  }
  std::uint64_t tellp() override { return at_; }
  void seekp(std::uint64_t to) override { at_ = to; }
  std::string take() { return std::move(bytes_); }

 private:
  std::string bytes_;
  std::size_t at_ = 0;
};

// Where the channels of one picture are gathered: linear light, and alpha where the file has it.
struct Planes {
  ColorImage color;
  ScalarImage alpha;
  bool grey = false;
};

Imf::Slice slice_of(float* first, const Imath::Box2i& window, std::size_t stride, int width) {
  return Imf::Slice::Make(Imf::FLOAT, first, window, stride, stride * width);
}

std::string list_channels(const Imf::ChannelList& channels) {
  std::string names;
  for (auto it = channels.begin(); it != channels.end(); ++it)
    names += (names.empty() ? "" : ", ") + std::string(it.name());
  return printable(names);
}

// Points OpenEXR at the memory for R, G, B (or Y) and A.
Imf::FrameBuffer bind_channels(const Imf::Header& header, Planes& planes, const std::string& name) {
  const Imf::ChannelList& channels = header.channels();
  const Imath::Box2i& window = header.dataWindow();
  const int width = planes.color.width();
  Imf::FrameBuffer buffer;
  int bound = 0;
  const auto bind = [&](const char* channel, float* first, std::size_t stride) {
    const Imf::Channel* found = channels.findChannel(channel);
    if (!found) return;
    if (found->xSampling != 1 || found->ySampling != 1) {
      throw InputError(
          name, "stores its channel " + std::string(channel) + " at a lower resolution; convert it to plain RGB first");
    }
    buffer.insert(channel, slice_of(first, window, stride, width));
    ++bound;
  };
  Rgb& pixel = planes.color(0, 0);
  bind("R", &pixel.r, sizeof(Rgb));
  bind("G", &pixel.g, sizeof(Rgb));
  bind("B", &pixel.b, sizeof(Rgb));
  planes.grey = bound == 0;
  if (planes.grey) bind("Y", &pixel.r, sizeof(Rgb));
  if (bound == 0 || channels.findChannel("RY") || channels.findChannel("BY")) {
    throw InputError(name, "has no channels R, G, B or plain Y (it has: " + list_channels(channels) + ")");
  }
  if (channels.findChannel("A")) {
    planes.alpha = ScalarImage(planes.color.size(), 1.0f);
    bind("A", planes.alpha.row(0), sizeof(float));
  }
  return buffer;
}

void read_texts(const Imf::Header& header, LoadedImage& out) {
  for (auto it = header.begin(); it != header.end(); ++it) {
    const auto* text = dynamic_cast<const Imf::StringAttribute*>(&it.attribute());
    if (text) out.texts[printable(it.name())] = text->value();
  }
  if (Imf::hasChromaticities(header)) {
    const Imf::Chromaticities found = Imf::chromaticities(header), ours;
    const auto far = [](const Imath::V2f& a, const Imath::V2f& b) { return (a - b).length() > 0.002f; };
    if (far(found.red, ours.red) || far(found.green, ours.green) || far(found.blue, ours.blue)) {
      out.warnings.push_back("its primaries are not those of sRGB; they were taken as such");
    }
  }
}

// Reads line by line, so that a cut file gives what it has.
void read_lines(Imf::InputPart& part, const Imath::Box2i& window, bool allow_truncated, const std::string& name,
                LoadedImage& out) {
  for (int y = window.min.y; y <= window.max.y; ++y) {
    try {
      part.readPixels(y, y);
    } catch (const std::bad_alloc&) {
      throw;
    } catch (const std::exception& error) {
      if (!allow_truncated) throw InputError(name, "is damaged or cut off: " + printable(error.what()));
      out.warnings.push_back("it is cut off before its end; the missing part was filled");
      return;
    }
  }
}

// Linear, premultiplied, perhaps not finite -> what the rest of ramify sees.
void finish(Planes& planes, LoadedImage& out) {
  long long bad = 0;
  const auto clean = [&](float& value) {
    if (std::isfinite(value)) return;
    value = 0.0f;
    ++bad;
  };
  if (!planes.alpha.empty()) out.alpha = Mask(planes.color.size());
  for (std::size_t i = 0; i < planes.color.pixels().size(); ++i) {
    Rgb& pixel = planes.color.pixels()[i];
    for (int c = 0; c < (planes.grey ? 1 : 3); ++c) clean(pixel[c]);
    if (planes.grey) pixel = {pixel.r, pixel.r, pixel.r};
    if (!planes.alpha.empty()) {
      float& opacity = planes.alpha.pixels()[i];
      clean(opacity);
      opacity = std::clamp(opacity, 0.0f, 1.0f);
      out.alpha.pixels()[i] = static_cast<std::uint8_t>(std::lround(255.0f * opacity));
      if (opacity > 0.0f) {
        for (int c = 0; c < 3; ++c) pixel[c] /= opacity;
      }
    }
    for (int c = 0; c < 3; ++c) clean(pixel[c]);
  }
  if (bad > 0) out.warnings.push_back(std::to_string(bad) + " values were not finite and became 0");
  out.color = srgb_from_linear(planes.color);
}

}  // namespace

LoadedImage decode_exr(std::string_view bytes, bool allow_truncated, const std::string& name) {
  try {
    MemoryReader stream(bytes);
    Imf::MultiPartInputFile file(stream, 0);
    const Imf::Header& header = file.header(0);
    const Imath::Box2i& window = header.dataWindow();
    LoadedImage out;
    if (file.parts() > 1)
      out.warnings.push_back("it has " + std::to_string(file.parts()) + " parts; the first was used");
    if (window != header.displayWindow())
      out.warnings.push_back("it has a display window; the whole data window was used");
    Planes planes;
    planes.color = ColorImage(window.max.x - window.min.x + 1, window.max.y - window.min.y + 1);
    Imf::InputPart part(file, 0);
    part.setFrameBuffer(bind_channels(header, planes, name));
    read_texts(header, out);
    read_lines(part, window, allow_truncated, name, out);
    const Imf::Channel* first = header.channels().findChannel(planes.grey ? "Y" : "R");
    out.bits = first && first->type == Imf::HALF ? 16 : 32;
    finish(planes, out);
    return out;
  } catch (const Error&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {
    throw InputError(name, "cannot be read as OpenEXR: " + printable(error.what()));
  }
}

std::string encode_exr(const ColorImage& image, const Mask* alpha, int bits, const std::string& recipe) {
  ColorImage linear = linear_from_srgb(image);
  ScalarImage opacity;
  if (alpha) {
    opacity = ScalarImage(image.size());
    for (std::size_t i = 0; i < opacity.pixels().size(); ++i) {
      opacity.pixels()[i] = static_cast<float>(alpha->pixels()[i]) / 255.0f;
      linear.pixels()[i] = opacity.pixels()[i] * linear.pixels()[i];
    }
  }
  Imf::Header header(image.width(), image.height());
  header.compression() = Imf::ZIP_COMPRESSION;
  if (!recipe.empty()) header.insert(kRecipeKey, Imf::StringAttribute(recipe));
  const Imath::Box2i window = header.dataWindow();
  std::vector<Imath::half> halves;  // OpenEXR wants the buffer in the file's own type
  Imf::FrameBuffer buffer;
  const int planes = alpha ? 4 : 3;
  const std::size_t area = image.pixels().size();
  if (bits == 16) halves.resize(area * planes);
  for (int c = 0; c < planes; ++c) {
    const char* name = c == 0 ? "R" : c == 1 ? "G" : c == 2 ? "B" : "A";
    header.channels().insert(name, Imf::Channel(bits == 16 ? Imf::HALF : Imf::FLOAT));
    float* first = c < 3 ? &linear.pixels()[0].r + c : opacity.row(0);
    const std::size_t stride = c < 3 ? 3 : 1;
    if (bits == 32) {
      buffer.insert(name, slice_of(first, window, stride * sizeof(float), image.width()));
      continue;
    }
    for (std::size_t i = 0; i < area; ++i) {
      halves[area * c + i] = Imath::half(std::clamp(first[stride * i], -65504.0f, 65504.0f));
    }
    buffer.insert(name, Imf::Slice::Make(Imf::HALF, &halves[area * c], window, sizeof(Imath::half),
                                         sizeof(Imath::half) * image.width()));
  }
  MemoryWriter stream;
  {
    Imf::OutputFile file(stream, header, 0);
    file.setFrameBuffer(buffer);
    file.writePixels(image.height());
  }
  return stream.take();
}

}  // namespace ramify
