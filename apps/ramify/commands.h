// SPDX-License-Identifier: GPL-3.0-or-later
// The verbs. Each add_… adds a subcommand with its options; when it is chosen on the command line, it leaves the work to
// do in `chosen`.
#pragma once

#include <functional>

#include "arguments.h"
#include "run.h"

namespace ramify::app {

struct Chosen {
  SharedOptions shared;
  std::function<Outcome(const Monitor&)> work;
};

// commands_picture.cpp
void add_synth(CLI::App& root, Chosen& chosen);
void add_grow(CLI::App& root, Chosen& chosen);
void add_render(CLI::App& root, Chosen& chosen);
void add_replay(CLI::App& root, Chosen& chosen);

// commands_paint.cpp
void add_paint(CLI::App& root, Chosen& chosen);
void add_figure(CLI::App& root, Chosen& chosen);

// commands_plan.cpp
void add_dendrite(CLI::App& root, Chosen& chosen);
void add_stylize(CLI::App& root, Chosen& chosen);
void add_moss(CLI::App& root, Chosen& chosen);

// commands_annotate.cpp
void add_trace(CLI::App& root, Chosen& chosen);
void add_rectify(CLI::App& root, Chosen& chosen);
void add_complete(CLI::App& root, Chosen& chosen);
void add_exemplar(CLI::App& root, Chosen& chosen);

// commands_inspect.cpp
void add_compare(CLI::App& root, Chosen& chosen);
void add_convert(CLI::App& root, Chosen& chosen);
void add_info(CLI::App& root, Chosen& chosen);

}  // namespace ramify::app
