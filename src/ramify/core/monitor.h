// SPDX-License-Identifier: GPL-3.0-or-later
// Progress, cancelling and timing of long work. Every stage takes a Monitor (cheap to copy), reports or checks at least
// every 100 ms of work (bench/silences measures it) and so stops within 200 ms of a cancel by throwing Cancelled.
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace ramify {

struct StageTime {
  std::string name;       // nested stages are written "outer/inner"
  double seconds = 0.0;   // wall clock, summed over calls
  int calls = 0;
  double longest_silence = 0.0;  // s, most that passed between two looks for a cancel; what a stop may have to wait for
};

class Monitor {
 public:
  // progress: overall fraction 0..1 (never falls) and the name of the current stage. May be called from any thread, one
  // call at a time.
  using Progress = std::function<void(double fraction, const std::string& stage)>;

  Monitor() = default;  // silent, never cancelled, no timings: costs nothing
  explicit Monitor(Progress progress);

  // A part of this work that covers [from, to] of it. The returned monitor reports 0..1 within that range, and its
  // time is booked under its name until its last copy dies.
  Monitor stage(std::string_view name, double from = 0.0, double to = 1.0) const;

  void report(double fraction) const;  // 0..1 of this part; also checks for a cancel
  void check() const;                  // throws Cancelled after cancel()
  void cancel() const;                 // async-signal-safe; from any thread
  bool cancelled() const;

  void note(const std::string& message) const;  // one sentence a user should read: a fallback taken, a repair made
  std::vector<std::string> notes() const;
  std::vector<StageTime> timings() const;

 private:
  struct Shared;
  struct Part;
  std::shared_ptr<Shared> shared_;
  std::shared_ptr<Part> part_;
};

}  // namespace ramify
