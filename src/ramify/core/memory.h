// SPDX-License-Identifier: GPL-3.0-or-later
// Some libraries end or crash the program when memory is short (glib, FFTW's planner, libsvm). Before they are called,
// this makes sure that they will find what they need.
#pragma once

#include <cstddef>

namespace ramify {

// Throws std::bad_alloc when the process may not take `bytes` more of address space (ulimit -v). Costs microseconds.
void require_memory(std::size_t bytes);

// Whether the process has a limit of its address space (ulimit -v).
bool memory_is_limited();

// Under such a limit: lets all threads share one heap, since each of their own would set 64 MiB aside.
// Call it before the first thread.
void share_heap_if_limited();

}  // namespace ramify
