// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/image/vips_library.h"

#include <dlfcn.h>

#include "ramify/core/error.h"
#include "ramify/core/memory.h"

namespace ramify {
namespace {

// glib ends the program when one of its small blocks cannot be had: while it starts it takes some MiB, more or less by
// where the system lays the libraries out.
constexpr std::size_t kStart = std::size_t{24} << 20;  // bytes

void keep_silent(const char*, GLogLevelFlags, const char*, void*) {}

// The handle stays open until the program ends; glib's own functions are found through libvips' dependencies.
VipsLibrary load() {
  void* handle = dlopen(RAMIFY_VIPS_SONAME, RTLD_NOW | RTLD_LOCAL);
  const auto fail = [] {
    const std::string why = dlerror();
    const bool memory = why.find("failed to map") != std::string::npos || why.find("allocate memory") != std::string::npos;
    if (memory) throw LimitError("not enough memory to load libvips (" + printable(why) + "); raise the limit of the address space");
    throw Error(ExitCode::Bug, "libvips cannot be loaded: " + printable(why) + "; install it");
  };
  if (!handle) fail();
  VipsLibrary library;
#define RAMIFY_VIPS_FIND(name)                                              \
  library.name = reinterpret_cast<decltype(&::name)>(dlsym(handle, #name)); \
  if (!library.name) fail();
  RAMIFY_VIPS_FUNCTIONS(RAMIFY_VIPS_FIND)
#undef RAMIFY_VIPS_FIND
  return library;
}

VipsLibrary start() {
  const VipsLibrary library = load();
  require_memory(kStart);
  for (const char* domain : {"VIPS", "GModule"}) {
    library.g_log_set_handler(domain,
                              static_cast<GLogLevelFlags>(G_LOG_LEVEL_MASK | G_LOG_FLAG_FATAL | G_LOG_FLAG_RECURSION),
                              keep_silent, nullptr);
  }
  if (library.vips_init("ramify") != 0) {
    throw Error(ExitCode::Bug, "libvips cannot be started: " + printable(library.vips_error_buffer()));
  }
  library.vips_block_untrusted_set(TRUE);
  library.vips_concurrency_set(1);
  library.vips_cache_set_max(0);
  return library;
}

}  // namespace

const VipsLibrary& vips_library() {
  static const VipsLibrary library = start();
  return library;
}

std::string take_vips_error() {
  std::string text = vips_library().vips_error_buffer();
  vips_library().vips_error_clear();
  while (!text.empty() && text.back() == '\n') text.pop_back();
  for (char& c : text) c = c == '\n' ? ';' : c;
  for (const char* sign : {"Error creating thread", "out of memory", "Cannot allocate memory"}) {
    if (text.find(sign) != std::string::npos) throw LimitError("not enough memory for a picture: " + printable(text));
  }
  return printable(text);
}

}  // namespace ramify
