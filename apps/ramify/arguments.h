// SPDX-License-Identifier: GPL-3.0-or-later
// How described options (core/options.h) become command-line flags, and the options every verb shares.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "ramify/core/options.h"
#include "ramify/image/image_io.h"

namespace ramify::app {

struct SharedOptions {
  std::uint64_t seed = 1;
  int threads = 0;               // 0 = all processors
  bool json = false;
  std::string progress = "auto"; // auto, bar, json, none
  bool quiet = false;
  bool verbose = false;
  bool no_clobber = false;
  double limit_pixels = 256e6;   // px
  double limit_memory = 0.0;     // MiB of address space; 0 = no limit
  double timeout = 0.0;          // s; 0 = none
  std::string timings;           // file for the stage table
  std::string debug_dir;         // folder for intermediates
  bool allow_other_photo = false;
  bool allow_truncated = false;

  LoadLimits load_limits() const;
};

void add_shared(CLI::App& app, SharedOptions& shared);

// One flag for each described field. Fields of several structs that share a name share the flag.
class FieldFlags {
 public:
  void add(CLI::App& app, const std::vector<OptionField>& fields, const std::string& group);

 private:
  std::map<std::string, std::shared_ptr<std::vector<OptionField>>> fields_;
};

// "1600x1076" in px. Throws OptionError.
Size parse_size(const std::string& name, const std::string& text);

// The known word nearest to `word` by edit distance, if it is near enough to be meant; else "".
std::string nearest_word(const std::string& word, const std::vector<std::string>& known);

}  // namespace ramify::app
