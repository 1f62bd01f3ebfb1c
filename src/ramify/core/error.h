// SPDX-License-Identifier: GPL-3.0-or-later
// What can go wrong, as exceptions a program can act on and a person can read: what, where, why, what to do.
// The library throws these and nothing else on bad input; anything else that escapes is a bug of ours.
#pragma once

#include <stdexcept>
#include <string>

namespace ramify {

// The exit code each kind of error ends the program with (docs/cli.md).
enum class ExitCode { Ok = 0, Bug = 1, Usage = 2, Input = 3, Output = 4, Limit = 5, BatchFailed = 6, Drained = 75,
                      Interrupted = 130, Terminated = 143 };

class Error : public std::runtime_error {
 public:
  Error(ExitCode code, const std::string& message) : std::runtime_error(message), code_(code) {}
  ExitCode code() const { return code_; }

 private:
  ExitCode code_;
};

// An input that cannot be used. `where` is a file name, with a line, field or JSON path when there is one.
class InputError : public Error {
 public:
  InputError(const std::string& where, const std::string& reason)
      : Error(ExitCode::Input, where.empty() ? reason : where + ": " + reason) {}
};

// An output that cannot be written.
class OutputError : public Error {
 public:
  OutputError(const std::string& where, const std::string& reason) : Error(ExitCode::Output, where + ": " + reason) {}
};

// An option whose value is out of range, or has no effect with the others given.
class OptionError : public Error {
 public:
  OptionError(const std::string& name, const std::string& value, const std::string& reason)
      : Error(ExitCode::Usage, "--" + name + (value.empty() ? "" : " " + value) + ": " + reason) {}
};

// More pixels, memory or time than allowed.
class LimitError : public Error {
 public:
  explicit LimitError(const std::string& message) : Error(ExitCode::Limit, message) {}
};

// The caller asked to stop (Monitor::cancel).
class Cancelled : public Error {
 public:
  Cancelled() : Error(ExitCode::Interrupted, "stopped on request") {}
};

// Text from a file or a name, made safe to print on a terminal: control bytes and broken UTF-8 become \xNN, and
// anything longer than `limit` bytes is cut with an ellipsis.
std::string printable(const std::string& text, std::size_t limit = 200);

}  // namespace ramify
