// SPDX-License-Identifier: GPL-3.0-or-later
// libvips, loaded with the first picture instead of with the program: with its hundred libraries it would take two thirds
// of the time that `ramify --version` may take (docs/decisions/0004). Private to this layer.
#pragma once

#include <vips/vips.h>

#include <memory>
#include <string>

namespace ramify {

// The functions we call, under their own names.
// clang-format off
#define RAMIFY_VIPS_FUNCTIONS(X)                                                                                     \
  X(vips_init) X(vips_error_buffer) X(vips_error_clear) X(vips_block_untrusted_set) X(vips_concurrency_set)          \
  X(vips_cache_set_max) X(vips_pngload_buffer) X(vips_jpegload_buffer) X(vips_tiffload_buffer)                       \
  X(vips_webpload_buffer) X(vips_pngsave_buffer) X(vips_jpegsave_buffer) X(vips_tiffsave_buffer)                     \
  X(vips_webpsave_buffer) X(vips_image_get_format) X(vips_image_get_interpretation) X(vips_image_get_width)          \
  X(vips_image_get_height) X(vips_image_get_bands) X(vips_image_get_n_pages) X(vips_image_write_to_memory)           \
  X(vips_image_new_from_memory) X(vips_image_set_blob_copy) X(vips_linear1) X(vips_profile_load) X(vips_blob_get)    \
  X(vips_area_unref) X(g_object_unref) X(g_free) X(g_log_set_handler)
// clang-format on

struct VipsLibrary {
#define RAMIFY_VIPS_MEMBER(name) decltype(&::name) name = nullptr;
  RAMIFY_VIPS_FUNCTIONS(RAMIFY_VIPS_MEMBER)
#undef RAMIFY_VIPS_MEMBER
};

// Loaded and started on the first call: one thread and no cache, because the threads are ours and every picture is read
// once; untrusted loaders blocked, messages silenced. Throws Error when the system has no libvips.
const VipsLibrary& vips_library();

struct ReleaseVips {
  void operator()(VipsImage* image) const { vips_library().g_object_unref(image); }
  void operator()(void* memory) const { vips_library().g_free(memory); }
};
using VipsPointer = std::unique_ptr<VipsImage, ReleaseVips>;
using GlibMemory = std::unique_ptr<void, ReleaseVips>;

// What libvips said last, on one line, and forgotten. Throws LimitError when it was about memory.
std::string take_vips_error();

}  // namespace ramify
