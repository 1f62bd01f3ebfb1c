// SPDX-License-Identifier: GPL-3.0-or-later
#include "run.h"

#include <signal.h>
#include <sys/resource.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdio>
#include <mutex>
#include <new>
#include <nlohmann/json.hpp>
#include <thread>

#include "progress.h"
#include "ramify/core/atomic_file.h"
#include "ramify/core/parallel.h"

namespace ramify::app {
namespace {

Monitor g_monitor;                     // the running verb's, for the signal handler
std::atomic<int> g_signal{0};
std::atomic<bool> g_timed_out{false};

extern "C" void handle_stop(int signal) {
  if (g_signal.exchange(signal) != 0) {
    remove_unfinished_files();
    _exit(128 + signal);
  }
  g_monitor.cancel();
}

void install_handlers() {
  struct sigaction action {};
  action.sa_handler = handle_stop;
  sigemptyset(&action.sa_mask);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) sigaction(signal, &action, nullptr);
  struct sigaction ignore {};
  ignore.sa_handler = SIG_IGN;
  sigaction(SIGPIPE, &ignore, nullptr);
  sigaction(SIGXFSZ, &ignore, nullptr);  // a file size limit then fails like a full disk, with a message
}

// Cancels the monitor when the time is up; ends with the verb.
class Watchdog {
 public:
  Watchdog(double seconds, const Monitor& monitor) {
    if (!(seconds > 0.0)) return;
    thread_ = std::thread([this, seconds, monitor] {
      std::unique_lock lock(mutex_);
      const bool ended = done_.wait_for(lock, std::chrono::duration<double>(seconds), [this] { return over_; });
      if (ended) return;
      g_timed_out = true;
      monitor.cancel();
    });
  }
  ~Watchdog() {
    if (!thread_.joinable()) return;
    {
      const std::lock_guard lock(mutex_);
      over_ = true;
    }
    done_.notify_all();
    thread_.join();
  }

 private:
  std::mutex mutex_;
  std::condition_variable done_;
  bool over_ = false;
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
    rows.push_back({{"stage", row.name}, {"seconds", row.seconds}, {"calls", row.calls}});
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
  install_handlers();
  set_thread_count(shared.threads);
  limit_memory(shared.limit_memory);
  try {
    const Watchdog watchdog(shared.timeout, g_monitor);
    const Outcome outcome = work(g_monitor);
    end_progress();
    if (!shared.timings.empty()) write_timings(shared.timings, g_monitor);
    print_outcome(shared, outcome, g_monitor,
                  std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
    return 0;
  } catch (const Cancelled&) {
    if (g_timed_out) {
      return report_error(shared, ExitCode::Limit, "stopped after --timeout " + number_text(shared.timeout) + " s; nothing was written");
    }
    const int signal = g_signal;
    return report_error(shared, static_cast<ExitCode>(128 + (signal == SIGHUP ? SIGTERM : signal)), "stopped; nothing was written");
  } catch (const Error& error) {
    return report_error(shared, error.code(), error.what());
  } catch (const std::bad_alloc&) {
    return report_error(shared, ExitCode::Limit, "not enough memory; choose a smaller --size, or raise --limit-memory");
  } catch (const std::exception& error) {
    return report_error(shared, ExitCode::Bug, std::string("internal error: ") + error.what() + "; please report it with the command");
  }
}

}  // namespace ramify::app
