// SPDX-License-Identifier: GPL-3.0-or-later
// Tasks on several threads of which some must wait for others.
#pragma once

#include <functional>
#include <vector>

namespace ramify {

// body(i) for i = 0 … after.size() - 1, each once, and only when body(j) has ended for all j in after[i], which must be
// lower than i. What is ready is begun in the order of the indices. Cancels and exceptions are parallel_for's.
void run_in_order(const std::vector<std::vector<int>>& after, const std::function<void(int)>& body);

}  // namespace ramify
