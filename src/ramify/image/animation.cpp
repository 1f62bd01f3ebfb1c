// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/image/animation.h"

#include <webp/encode.h>
#include <webp/mux.h>

#include <cmath>
#include <memory>
#include <vector>

#include "ramify/core/error.h"
#include "ramify/image/recipe_xmp.h"

namespace ramify {
namespace {

constexpr int kMostSide = 16383;  // px, of the format

std::vector<std::uint8_t> bytes_of(const AnimationFrame& frame) {
  std::vector<std::uint8_t> out;
  out.reserve(4 * frame.color.pixels().size());
  const auto level = [](float v) { return static_cast<std::uint8_t>(!(v > 0.0f) ? 0 : v >= 1.0f ? 255 : std::lround(255.0f * v)); };
  for (std::size_t i = 0; i < frame.color.pixels().size(); ++i) {
    const Rgb& c = frame.color.pixels()[i];
    out.insert(out.end(), {level(c.r), level(c.g), level(c.b), frame.alpha.empty() ? std::uint8_t{255} : frame.alpha.pixels()[i]});
  }
  return out;
}

struct Picture {
  WebPPicture value;
  Picture() { WebPPictureInit(&value); }
  ~Picture() { WebPPictureFree(&value); }
  Picture(const Picture&) = delete;
  Picture& operator=(const Picture&) = delete;
};

// libwebp asks this now and then while it works on a frame; 0 stops it.
int go_on(int, const WebPPicture* picture) {
  return static_cast<const Monitor*>(picture->user_data)->cancelled() ? 0 : 1;
}

std::string with_recipe(const WebPData& file, const std::string& recipe) {
  const std::unique_ptr<WebPMux, void (*)(WebPMux*)> mux(WebPMuxCreate(&file, 0), WebPMuxDelete);
  const std::string xmp = xmp_of_recipe(recipe);
  const WebPData chunk{reinterpret_cast<const std::uint8_t*>(xmp.data()), xmp.size()};
  WebPData whole;
  WebPDataInit(&whole);
  if (!mux || (!xmp.empty() && WebPMuxSetChunk(mux.get(), "XMP ", &chunk, 0) != WEBP_MUX_OK) ||
      WebPMuxAssemble(mux.get(), &whole) != WEBP_MUX_OK) {
    throw OutputError("animation", "libwebp cannot put the file together");
  }
  std::string out(reinterpret_cast<const char*>(whole.bytes), whole.size);
  WebPDataClear(&whole);
  return out;
}

}  // namespace

std::string encode_animation(Size size, int count, const std::function<AnimationFrame(int)>& frame,
                             const AnimationOptions& options, const Monitor& monitor) {
  if (std::max(size.width, size.height) > kMostSide) {
    throw LimitError("an animated WebP has at most " + std::to_string(kMostSide) + " px a side; choose a smaller --scale");
  }
  WebPAnimEncoderOptions settings;
  WebPAnimEncoderOptionsInit(&settings);
  settings.anim_params.loop_count = options.loops;
  const std::unique_ptr<WebPAnimEncoder, void (*)(WebPAnimEncoder*)> encoder(
      WebPAnimEncoderNew(size.width, size.height, &settings), WebPAnimEncoderDelete);
  WebPConfig config;
  if (!encoder || !WebPConfigInit(&config)) throw OutputError("animation", "libwebp cannot start");
  config.quality = static_cast<float>(options.quality);
  config.lossless = options.quality >= 100 ? 1 : 0;
  config.method = 3;
  int at = 0;  // ms
  for (int i = 0; i < count; ++i) {
    monitor.report(static_cast<double>(i) / count);
    const AnimationFrame now = frame(i);
    const std::vector<std::uint8_t> bytes = bytes_of(now);
    Picture picture;
    picture.value.use_argb = 1;
    picture.value.width = size.width;
    picture.value.height = size.height;
    picture.value.progress_hook = go_on;
    picture.value.user_data = const_cast<Monitor*>(&monitor);
    const bool imported = WebPPictureImportRGBA(&picture.value, bytes.data(), 4 * size.width) != 0;
    const bool added = imported && WebPAnimEncoderAdd(encoder.get(), &picture.value, at, &config) != 0;
    monitor.check();
    if (!added) throw OutputError("animation", std::string("libwebp fails: ") + WebPAnimEncoderGetError(encoder.get()));
    at += now.milliseconds;
  }
  WebPData file;
  WebPDataInit(&file);
  if (!WebPAnimEncoderAdd(encoder.get(), nullptr, at, nullptr) || !WebPAnimEncoderAssemble(encoder.get(), &file)) {
    throw OutputError("animation", std::string("libwebp fails: ") + WebPAnimEncoderGetError(encoder.get()));
  }
  const std::unique_ptr<WebPData, void (*)(WebPData*)> guard(&file, WebPDataClear);
  return with_recipe(file, options.recipe);
}

}  // namespace ramify
