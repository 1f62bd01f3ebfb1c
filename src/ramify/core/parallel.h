// SPDX-License-Identifier: GPL-3.0-or-later
// Loops over independent items on several threads. The result must not depend on the number of threads: a body writes
// only what belongs to its own index, and draws only from a child generator of its own.
#pragma once

#include <functional>

namespace ramify {

// How many threads the loops may use; 0 means one for every processor. Set once by the program, before any work.
void set_thread_count(int count);
int thread_count();

// body(i) for i = 0 … count-1, in any order, each once. Indices are handed out in runs of `grain`. If bodies throw, the
// exception of the lowest index that threw is thrown again here, after all threads have stopped. A loop inside a loop
// runs on the thread it is called from.
void parallel_for(int count, const std::function<void(int)>& body, int grain = 1);

}  // namespace ramify
