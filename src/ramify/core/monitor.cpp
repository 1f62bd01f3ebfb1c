// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/core/monitor.h"

#include <algorithm>
#include <chrono>
#include <mutex>

#include "ramify/core/error.h"

namespace ramify {

using Clock = std::chrono::steady_clock;

struct Monitor::Shared {
  Progress progress;
  std::atomic<bool> cancelled{false};
  std::atomic<Clock::rep> last_check{Clock::now().time_since_epoch().count()};
  std::mutex mutex;
  double furthest = 0.0;
  Clock::time_point last_call{};
  std::vector<std::string> notes;
  std::vector<StageTime> timings;
};

struct Monitor::Part {
  std::shared_ptr<Shared> shared;
  std::string name;
  double from = 0.0;
  double to = 1.0;
  Clock::time_point start = Clock::now();
  std::atomic<Clock::rep> longest_silence{0};

  // Takes note of how long nobody has looked for a cancel.
  void hear(Clock::rep silence) {
    Clock::rep known = longest_silence.load(std::memory_order_relaxed);
    while (silence > known && !longest_silence.compare_exchange_weak(known, silence, std::memory_order_relaxed)) {
    }
  }

  ~Part() {
    if (name.empty()) return;
    hear(Clock::now().time_since_epoch().count() - shared->last_check.load(std::memory_order_relaxed));
    const double seconds = std::chrono::duration<double>(Clock::now() - start).count();
    const std::lock_guard lock(shared->mutex);
    auto& rows = shared->timings;
    auto row = std::find_if(rows.begin(), rows.end(), [&](const StageTime& t) { return t.name == name; });
    if (row == rows.end()) row = rows.insert(rows.end(), StageTime{name, 0.0, 0, 0.0});
    row->seconds += seconds;
    row->calls += 1;
    row->longest_silence = std::max(row->longest_silence, std::chrono::duration<double>(Clock::duration(longest_silence.load())).count());
  }
};

Monitor::Monitor(Progress progress) : shared_(std::make_shared<Shared>()) {
  shared_->progress = std::move(progress);
}

Monitor Monitor::stage(std::string_view name, double from, double to) const {
  if (!shared_) return {};
  check();
  Monitor out;
  out.shared_ = shared_;
  out.part_ = std::make_shared<Part>();
  out.part_->shared = shared_;
  out.part_->name = part_ ? part_->name + "/" + std::string(name) : std::string(name);
  const double low = part_ ? part_->from : 0.0;
  const double high = part_ ? part_->to : 1.0;
  out.part_->from = low + (high - low) * std::clamp(from, 0.0, 1.0);
  out.part_->to = low + (high - low) * std::clamp(to, 0.0, 1.0);
  out.report(0.0);
  return out;
}

void Monitor::report(double fraction) const {
  if (!shared_) return;
  check();
  const double low = part_ ? part_->from : 0.0;
  const double high = part_ ? part_->to : 1.0;
  const double overall = low + (high - low) * std::clamp(fraction, 0.0, 1.0);
  const std::lock_guard lock(shared_->mutex);
  shared_->furthest = std::max(shared_->furthest, overall);
  const auto now = Clock::now();
  if (!shared_->progress || (fraction > 0.0 && now - shared_->last_call < std::chrono::milliseconds(30))) return;
  shared_->last_call = now;
  shared_->progress(shared_->furthest, part_ ? part_->name : std::string());
}

void Monitor::check() const {
  if (!shared_) return;
  if (shared_->cancelled.load(std::memory_order_relaxed)) throw Cancelled();
  const Clock::rep now = Clock::now().time_since_epoch().count();
  const Clock::rep before = shared_->last_check.exchange(now, std::memory_order_relaxed);
  if (part_) part_->hear(now - before);
}

void Monitor::cancel() const {
  if (shared_) shared_->cancelled.store(true, std::memory_order_relaxed);
}

bool Monitor::cancelled() const { return shared_ && shared_->cancelled.load(std::memory_order_relaxed); }

void Monitor::note(const std::string& message) const {
  if (!shared_) return;
  const std::lock_guard lock(shared_->mutex);
  auto& notes = shared_->notes;
  if (std::find(notes.begin(), notes.end(), message) == notes.end()) notes.push_back(message);
}

std::vector<std::string> Monitor::notes() const {
  if (!shared_) return {};
  const std::lock_guard lock(shared_->mutex);
  return shared_->notes;
}

std::vector<StageTime> Monitor::timings() const {
  if (!shared_) return {};
  const std::lock_guard lock(shared_->mutex);
  return shared_->timings;
}

}  // namespace ramify
