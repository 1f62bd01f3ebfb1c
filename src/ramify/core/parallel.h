// SPDX-License-Identifier: GPL-3.0-or-later
// Loops over independent items on several threads. The result must not depend on the number of threads: a body writes
// only what belongs to its own index, and draws only from a child generator of its own.
#pragma once

#include <functional>

#include "ramify/core/monitor.h"

namespace ramify {

// How many threads the loops may use; 0 means one for every processor. Set once by the program, before any work.
void set_thread_count(int count);
int thread_count();

// While it lives, every parallel_for called on this thread, and every loop inside of that, looks for a cancel of `monitor`
// before each index. So filters that know of no monitor stop as fast as stages that do. Each public call that takes long
// and has a monitor opens one; it never changes a result.
class CancelScope {
 public:
  explicit CancelScope(const Monitor& monitor);
  ~CancelScope();
  CancelScope(const CancelScope&) = delete;
  CancelScope& operator=(const CancelScope&) = delete;

 private:
  Monitor monitor_;
  const Monitor* outer_;
};

// Throws Cancelled when the monitor of the innermost scope of this thread was cancelled: for long work between loops.
void check_cancel();

// body(i) for i = 0 … count-1, in any order, each once. Indices are handed out in runs of `grain`. If bodies throw, the
// exception of the lowest index that threw is thrown again here, after all threads have stopped. A loop inside a loop
// runs on the thread it is called from.
void parallel_for(int count, const std::function<void(int)>& body, int grain = 1);

}  // namespace ramify
