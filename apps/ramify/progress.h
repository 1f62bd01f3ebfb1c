// SPDX-License-Identifier: GPL-3.0-or-later
// Shows a Monitor's progress on standard error: a bar with the time left on a terminal, or JSON lines.
#pragma once

#include <string>

#include "arguments.h"
#include "ramify/core/monitor.h"

namespace ramify::app {

// A monitor that shows progress as the shared options ask for.
Monitor make_monitor(const SharedOptions& shared);

// Clears the bar, if one is on the screen.
void end_progress();

// "1 min 20 s" for a number of seconds.
std::string duration_text(double seconds);

}  // namespace ramify::app
