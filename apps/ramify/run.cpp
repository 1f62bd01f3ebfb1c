// SPDX-License-Identifier: GPL-3.0-or-later
#include "run.h"

#include <semaphore.h>
#include <signal.h>
#include <sys/resource.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <new>
#include <nlohmann/json.hpp>
#include <system_error>
#include <thread>

#include "progress.h"
#include "ramify/core/atomic_file.h"
#include "ramify/core/memory.h"
#include "ramify/core/parallel.h"

namespace ramify::app {
namespace {

constexpr char kNoMemory[] = "not enough memory; choose a smaller --size, or raise --limit-memory or the system's limit";
Monitor g_monitor;                     // the running verb's, for the signal handler
std::atomic<int> g_signal{0};
std::atomic<bool> g_timed_out{false};

std::atomic<sem_t*> g_wake{nullptr};   // the watchdog's

extern "C" void handle_stop(int signal) {
  const int error = errno;
  if (g_signal.exchange(signal) != 0) {
    remove_unfinished_files();
    _exit(signal == SIGXCPU ? static_cast<int>(ExitCode::Limit) : 128 + signal);
  }
  g_monitor.cancel();
  if (sem_t* wake = g_wake) sem_post(wake);
  errno = error;
}

// Under a limit of memory: glib aborts or traps when one of its small blocks cannot be had, wherever that is. A bug would
// come here as well, so the message names both.
extern "C" void handle_abort(int) {
  constexpr char kAborted[] = "ramify: a library gave up, most likely for want of memory; raise --limit-memory or the system's limit\n";
  remove_unfinished_files();
  [[maybe_unused]] const ssize_t written = write(STDERR_FILENO, kAborted, sizeof kAborted - 1);
  _exit(static_cast<int>(ExitCode::Limit));
}

// A verb was stopped by a signal, by --timeout or by a limit of processor time.
int report_stop(const SharedOptions& shared) {
  const std::string kept = "; no file was left unfinished";
  if (g_timed_out) return report_error(shared, ExitCode::Limit, "stopped after --timeout " + number_text(shared.timeout) + " s" + kept);
  if (g_signal == SIGXCPU) return report_error(shared, ExitCode::Limit, "stopped by the system's limit of processor time (ulimit -t)" + kept);
  return report_error(shared, g_signal == SIGINT ? ExitCode::Interrupted : ExitCode::Terminated, "stopped" + kept);
}

void install_handlers() {
  struct sigaction action {};
  action.sa_handler = handle_stop;
  sigemptyset(&action.sa_mask);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGXCPU}) sigaction(signal, &action, nullptr);
  struct sigaction ignore {};
  ignore.sa_handler = SIG_IGN;
  sigaction(SIGPIPE, &ignore, nullptr);
  sigaction(SIGXFSZ, &ignore, nullptr);  // a file size limit then fails like a full disk, with a message
  if (!memory_is_limited()) return;
  action.sa_handler = handle_abort;
  for (const int signal : {SIGABRT, SIGTRAP}) sigaction(signal, &action, nullptr);
}

// Ends a verb that does not end by itself: cancels the monitor when the time is up; and if the verb has not stopped a
// moment after any cancel (some libraries' calls cannot be interrupted), ends the program. Files appear under their names
// whole or not at all, so ending anywhere leaves nothing half written.
class Watchdog {
 public:
  Watchdog(const SharedOptions& shared, const Monitor& monitor) {
    sem_init(&wake_, 0, 0);
    g_wake = &wake_;
    try {
      thread_ = std::thread([this, shared, monitor] { watch(shared, monitor); });
    } catch (const std::system_error&) {
      if (shared.timeout > 0.0) monitor.note("the system gives no thread to watch the time: --timeout has no effect");
    }
  }
  ~Watchdog() {
    over_ = true;
    sem_post(&wake_);
    if (thread_.joinable()) thread_.join();
    g_wake = nullptr;  // the semaphore lives on its last moments in a handler at most: it holds nothing to free
  }
  Watchdog(const Watchdog&) = delete;
  Watchdog& operator=(const Watchdog&) = delete;

 private:
  // False when the time was up before anybody woke us.
  bool woken_within(double seconds) {
    timespec until{};
    clock_gettime(CLOCK_MONOTONIC, &until);
    const double whole = std::floor(std::min(seconds, 1e9));
    const long nanoseconds = until.tv_nsec + static_cast<long>(1e9 * (std::min(seconds, 1e9) - whole));
    until.tv_sec += static_cast<time_t>(whole) + nanoseconds / 1000000000;
    until.tv_nsec = nanoseconds % 1000000000;
    int result;
    do result = sem_clockwait(&wake_, CLOCK_MONOTONIC, &until);
    while (result != 0 && errno == EINTR);
    return result == 0;
  }

  void watch(const SharedOptions& shared, const Monitor& monitor) {
    constexpr double kGrace = 0.12;  // s; a stop then takes less than 0.2 s in any stage
    if (!woken_within(shared.timeout > 0.0 ? shared.timeout : 1e9)) {
      g_timed_out = true;
      monitor.cancel();
    }
    if (over_ || woken_within(kGrace)) return;
    remove_unfinished_files();
    _exit(report_stop(shared));
  }

  sem_t wake_{};
  std::atomic<bool> over_{false};
  std::thread thread_;
};

void limit_memory(double mebibytes) {
  if (!(mebibytes > 0.0)) return;
  const auto bytes = static_cast<rlim_t>(mebibytes * 1048576.0);
  struct rlimit limit {bytes, bytes};
  setrlimit(RLIMIT_AS, &limit);
}

void write_timings(const std::string& path, const Monitor& monitor) {
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  for (const StageTime& row : monitor.timings()) {
    rows.push_back({{"stage", row.name}, {"seconds", row.seconds}, {"calls", row.calls}, {"longest_silence", row.longest_silence}});
  }
  write_file(path, rows.dump(1) + "\n");
}

void print_outcome(const SharedOptions& shared, const Outcome& outcome, const Monitor& monitor, double seconds) {
  if (!outcome.data.empty()) {
    std::fwrite(outcome.data.data(), 1, outcome.data.size(), stdout);
  } else if (shared.json) {
    nlohmann::ordered_json object{{"outputs", outcome.outputs}, {"skipped", outcome.skipped},
                                  {"notes", monitor.notes()}, {"seconds", seconds}};
    std::printf("%s\n", object.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace).c_str());
  }
  std::fflush(stdout);
  if (shared.quiet || shared.json) return;
  for (const std::string& note : monitor.notes()) std::fprintf(stderr, "note: %s\n", note.c_str());
  for (const std::string& path : outcome.skipped) std::fprintf(stderr, "kept %s (it exists already)\n", printable(path, 300).c_str());
  for (const std::string& path : outcome.outputs) std::fprintf(stderr, "wrote %s\n", printable(path, 300).c_str());
  if (!shared.verbose) return;
  for (const StageTime& row : monitor.timings()) std::fprintf(stderr, "%9.3f s  %s\n", row.seconds, row.name.c_str());
  std::fprintf(stderr, "%9.3f s  in all\n", seconds);
}

}  // namespace

int report_error(const SharedOptions& shared, ExitCode code, const std::string& message) {
  end_progress();
  if (shared.json) {
    const nlohmann::ordered_json object{{"error", message}, {"exit", static_cast<int>(code)}};
    std::fprintf(stderr, "%s\n", object.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace).c_str());
  } else {
    std::fprintf(stderr, "ramify: %s\n", message.c_str());
  }
  return static_cast<int>(code);
}

int run_verb(const SharedOptions& shared, const std::function<Outcome(const Monitor&)>& work) {
  const auto start = std::chrono::steady_clock::now();
  g_monitor = make_monitor(shared);
  limit_memory(shared.limit_memory);
  install_handlers();
  set_thread_count(shared.threads);
  share_heap_if_limited();
  try {
    const Outcome outcome = [&] {
      const Watchdog watchdog(shared, g_monitor);
      return work(g_monitor);
    }();
    end_progress();
    if (!shared.timings.empty()) write_timings(shared.timings, g_monitor);
    print_outcome(shared, outcome, g_monitor,
                  std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
    return 0;
  } catch (const Cancelled&) {
    return report_stop(shared);
  } catch (const Error& error) {
    return report_error(shared, error.code(), error.what());
  } catch (const std::bad_alloc&) {
    return report_error(shared, ExitCode::Limit, kNoMemory);
  } catch (const std::exception& error) {
    // OpenCV has an exception of its own for this.
    if (std::string(error.what()).find("Insufficient memory") != std::string::npos) return report_error(shared, ExitCode::Limit, kNoMemory);
    return report_error(shared, ExitCode::Bug, std::string("internal error: ") + error.what() + "; please report it with the command");
  }
}

}  // namespace ramify::app
