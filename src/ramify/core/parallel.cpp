// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/core/parallel.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace ramify {
namespace {

std::atomic<int> g_thread_count{0};
thread_local bool t_inside_loop = false;
thread_local const Monitor* t_monitor = nullptr;  // of the innermost CancelScope

}  // namespace

void set_thread_count(int count) { g_thread_count = std::max(0, count); }

int thread_count() {
  const int asked = g_thread_count;
  return asked > 0 ? asked : std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

CancelScope::CancelScope(const Monitor& monitor) : monitor_(monitor), outer_(t_monitor) { t_monitor = &monitor_; }

CancelScope::~CancelScope() { t_monitor = outer_; }

void check_cancel() {
  if (t_monitor) t_monitor->check();
}

void parallel_for(int count, const std::function<void(int)>& body, int grain) {
  grain = std::max(1, grain);
  const int workers = std::min(thread_count(), (count + grain - 1) / grain);
  if (workers <= 1 || t_inside_loop) {
    for (int i = 0; i < count; ++i) {
      check_cancel();
      body(i);
    }
    return;
  }
  std::atomic<int> next{0};
  std::atomic<bool> failed{false};
  std::mutex mutex;
  std::exception_ptr error;
  int error_index = count;
  const Monitor* const monitor = t_monitor;
  const auto work = [&] {
    t_inside_loop = true;
    t_monitor = monitor;
    while (!failed) {
      const int begin = next.fetch_add(grain);
      if (begin >= count) break;
      for (int i = begin; i < std::min(begin + grain, count) && !failed; ++i) {
        try {
          check_cancel();
          body(i);
        } catch (...) {
          const std::lock_guard lock(mutex);
          failed = true;
          if (i < error_index) {
            error_index = i;
            error = std::current_exception();
          }
        }
      }
    }
    t_inside_loop = false;
  };
  std::vector<std::thread> threads;
  try {
    for (int t = 1; t < workers; ++t) threads.emplace_back(work);
  } catch (const std::exception&) {
    // The system gives no more threads, or no memory for one: go on with those we have, which must be joined.
  }
  work();
  for (std::thread& thread : threads) thread.join();
  if (error) std::rethrow_exception(error);
}

}  // namespace ramify
