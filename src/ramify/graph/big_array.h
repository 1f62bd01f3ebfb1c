// SPDX-License-Identifier: GPL-3.0-or-later
// Arrays with one entry a node. Private to the layer.
#pragma once

#include <cstddef>
#include <vector>

#ifdef __linux__
#include <sys/mman.h>
#endif

namespace ramify {

// Fills the array anew. Large ones ask for large pages: a search's front lies scattered over all rows, and with small
// pages much of its time goes into finding them.
template <class T>
void assign_big(std::vector<T>& array, std::size_t count, T value) {
  array.clear();
  array.reserve(count);
#ifdef __linux__
  constexpr std::size_t kLargePage = std::size_t{1} << 21;
  const std::size_t start = (reinterpret_cast<std::size_t>(array.data()) + kLargePage - 1) / kLargePage * kLargePage;
  const std::size_t end = (reinterpret_cast<std::size_t>(array.data()) + count * sizeof(T)) / kLargePage * kLargePage;
  if (start < end) madvise(reinterpret_cast<void*>(start), end - start, MADV_HUGEPAGE);  // a hint: may fail
#endif
  array.assign(count, value);
}

}  // namespace ramify
