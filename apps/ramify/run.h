// SPDX-License-Identifier: GPL-3.0-or-later
// Runs one verb: signals, time and memory limits, errors to exit codes.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "arguments.h"
#include "ramify/core/monitor.h"

namespace ramify::app {

// What a verb reports when it is done: printed as sentences on standard error, or as one JSON object on standard output.
struct Outcome {
  std::vector<std::string> outputs;   // files written
  std::vector<std::string> skipped;   // files left alone (--no-clobber)
  std::string data;                   // text for standard output (info); JSON when --json
};

// Runs `work` and returns the program's exit code. Ctrl-C and SIGTERM cancel the monitor; a second one removes temporary
// files and ends at once.
int run_verb(const SharedOptions& shared, const std::function<Outcome(const Monitor&)>& work);

// Prints a one-line error on standard error (as JSON with --json) and returns the exit code.
int report_error(const SharedOptions& shared, ExitCode code, const std::string& message);

}  // namespace ramify::app
