// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/core/memory.h"

#include <malloc.h>
#include <sys/mman.h>
#include <sys/resource.h>

#include <new>

namespace ramify {

void require_memory(std::size_t bytes) {
  void* space = mmap(nullptr, bytes, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  if (space == MAP_FAILED) throw std::bad_alloc();
  munmap(space, bytes);
}

bool memory_is_limited() {
  struct rlimit limit {};
  return getrlimit(RLIMIT_AS, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY;
}

void share_heap_if_limited() {
  if (memory_is_limited()) mallopt(M_ARENA_MAX, 1);
}

}  // namespace ramify
