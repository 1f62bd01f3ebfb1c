// SPDX-License-Identifier: GPL-3.0-or-later
#include "progress.h"

#include <unistd.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <memory>

namespace ramify::app {
namespace {

bool g_bar_on_screen = false;

void show_bar(double fraction, const std::string& stage, double elapsed) {
  constexpr int kWidth = 24;
  const int full = static_cast<int>(fraction * kWidth);
  std::string bar(static_cast<std::size_t>(kWidth), '-');
  for (int i = 0; i < full; ++i) bar[i] = '#';
  std::string left;
  if (fraction > 0.03 && elapsed > 0.5) left = "  " + duration_text(elapsed / fraction - elapsed) + " left";
  std::fprintf(stderr, "\r\x1b[K[%s] %3d %%  %.40s%s", bar.c_str(), static_cast<int>(100 * fraction), stage.c_str(), left.c_str());
  std::fflush(stderr);
  g_bar_on_screen = true;
}

}  // namespace

std::string duration_text(double seconds) {
  const long whole = std::lround(std::max(0.0, seconds));
  if (whole < 60) return std::to_string(whole) + " s";
  if (whole < 3600) return std::to_string(whole / 60) + " min " + std::to_string(whole % 60) + " s";
  return std::to_string(whole / 3600) + " h " + std::to_string(whole % 3600 / 60) + " min";
}

Monitor make_monitor(const SharedOptions& shared) {
  const char* term = std::getenv("TERM");
  const bool terminal = isatty(STDERR_FILENO) && !(term && std::string(term) == "dumb");
  const bool bar = shared.progress == "bar" || (shared.progress == "auto" && terminal && !shared.quiet && !shared.json);
  const auto start = std::make_shared<std::chrono::steady_clock::time_point>(std::chrono::steady_clock::now());
  const auto elapsed = [start] {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - *start).count();
  };
  if (bar) {
    return Monitor([elapsed](double f, const std::string& stage) { show_bar(f, stage, elapsed()); });
  }
  if (shared.progress == "json") {
    return Monitor([elapsed](double f, const std::string& stage) {
      const double seconds = elapsed();
      std::fprintf(stderr, "{\"progress\":%.4f,\"stage\":\"%s\",\"elapsed\":%.2f", f, stage.c_str(), seconds);
      if (f > 0.03) std::fprintf(stderr, ",\"eta\":%.1f", seconds / f - seconds);
      std::fprintf(stderr, "}\n");
    });
  }
  return Monitor([](double, const std::string&) {});
}

void end_progress() {
  if (!g_bar_on_screen) return;
  std::fprintf(stderr, "\r\x1b[K");
  std::fflush(stderr);
  g_bar_on_screen = false;
}

}  // namespace ramify::app
