// SPDX-License-Identifier: GPL-3.0-or-later
// What a planned drawing came from, as pictures for --debug-dir and for the figures of Long & Mould 2009.
#pragma once

#include <string>
#include <vector>

#include "ramify/core/monitor.h"
#include "ramify/graph/metric.h"
#include "ramify/recipe/planning.h"

namespace ramify {

// In which order a search from the sources comes to the nodes (figure 5 of the paper): white = at once, dark = last, with a
// line after every sixteenth of the nodes; forbidden and unreached nodes are black. By the cost under the metric, ties by
// the sum.
ColorImage contour_picture(const Lattice& lattice, const std::vector<int>& sources, const MetricOptions& metric, const Monitor& monitor);

// A round of a drawing (figures 6 and 11): what was there before it, its seed, in green, or black with `done`, which adds
// the round's own paths; without `done` the round's endpoints in red instead. round: 0 …
ColorImage round_picture(const Structure& structure, Size size, int round, bool done);

// Writes what stylize_picture found on its way: importance.tiff and stipple_cost.tiff (what the front of the endpoints'
// search paid; drawings only), weights.tiff, cost.tiff, endpoints.csv, contours.png and, for every round k, seed_k.png and
// drawn_k.png.
void save_stylize_intermediates(const std::string& folder, const StylizedPicture& made, const MetricOptions& metric, const Monitor& monitor);

}  // namespace ramify
