// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/core/ordered_tasks.h"

#include <condition_variable>
#include <mutex>
#include <queue>

#include "ramify/core/parallel.h"

namespace ramify {
namespace {

class Tasks {
 public:
  explicit Tasks(const std::vector<std::vector<int>>& after)
      : waits_for_(after.size()), next_(after.size()), left_(after.size()) {
    for (std::size_t i = 0; i < after.size(); ++i) {
      waits_for_[i] = after[i].size();
      for (const int j : after[i]) next_[static_cast<std::size_t>(j)].push_back(static_cast<int>(i));
      if (after[i].empty()) ready_.push(static_cast<int>(i));
    }
  }

  // Works until nothing is left, or a task of any thread has thrown.
  void work(const std::function<void(int)>& body) {
    std::unique_lock lock(mutex_);
    while (left_ > 0 && !failed_) {
      if (ready_.empty()) {
        changed_.wait(lock);
        continue;
      }
      const int i = ready_.top();
      ready_.pop();
      lock.unlock();
      try {
        check_cancel();
        body(i);
      } catch (...) {
        lock.lock();
        failed_ = true;
        changed_.notify_all();
        throw;
      }
      lock.lock();
      --left_;
      for (const int k : next_[static_cast<std::size_t>(i)]) {
        if (--waits_for_[static_cast<std::size_t>(k)] == 0) ready_.push(k);
      }
      changed_.notify_all();
    }
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<std::size_t> waits_for_;  // how many that have not ended
  std::vector<std::vector<int>> next_;  // who waits for a task
  std::priority_queue<int, std::vector<int>, std::greater<>> ready_;
  std::size_t left_;
  bool failed_ = false;
};

}  // namespace

void run_in_order(const std::vector<std::vector<int>>& after, const std::function<void(int)>& body) {
  Tasks tasks(after);
  parallel_for(thread_count(), [&](int) { tasks.work(body); });
}

}  // namespace ramify
