// SPDX-License-Identifier: GPL-3.0-or-later
// Which of several overlapping pictures each pixel is taken from: labels by alpha expansion with graph cuts (Boykov,
// Veksler and Zabih 2001; Kwatra et al. 2003, "Graphcut textures"). An expansion move offers one label to a rectangle and
// decides exactly, by one minimum cut, where it pays. With a single move over a uniform labelling this is the optimal
// cut between two pictures. Seams already there count as Kwatra's old seams: replacing one is rewarded.
#pragma once

#include <cstdint>
#include <functional>
#include <span>

#include "ramify/core/monitor.h"
#include "ramify/image/image.h"

namespace ramify {

// A data cost of this or more means never.
inline constexpr int kForbiddenCost = 100'000'000;

// Costs are integers (scale yours by about 1000), so that equal inputs give equal cuts everywhere. Both functions are
// called from several threads at once.
struct SeamCosts {
  // Cost of label `label` at pixel (x, y), 0 … kForbiddenCost.
  std::function<int(int label, int x, int y)> data;
  // Cost of a seam between the neighbours (x, y) and (x+dx, y+dy) where the pictures a and b (a != b) meet; symmetric in
  // a and b. Diagonal pairs are weighted down here, not by the caller.
  std::function<int(int a, int b, int x, int y, int dx, int dy)> pair;
};

// One label and the rectangle [left, right) x [top, bottom) it is offered to.
struct SeamMove {
  int label = kNone;
  int left = 0, top = 0, right = 0, bottom = 0;  // px
};

struct SeamOptions {
  int sweeps = 2;               // how often every move is made; two suffice (PICTURES 12.1-5)
  bool eight_neighbours = true; // else four
  bool old_seams = true;        // false: seams already there are ignored (paper 002)
};

// Makes the moves in the order given, `sweeps` times, and returns the labelling. With old_seams no move ever raises
// seam_cost(), except where the costs are no metric (E00 > E01 + E10 is cut down to the sum, PICTURES 12.1-5). Moves
// whose rectangles do not touch run in parallel, with the result of the sequential order.
LabelImage expand_labels(LabelImage labels, std::span<const SeamMove> moves, const SeamCosts& costs,
                         const SeamOptions& options, const Monitor& monitor);

// Sum of all data and pair costs of a labelling.
std::int64_t seam_cost(const LabelImage& labels, const SeamCosts& costs, bool eight_neighbours = true);

}  // namespace ramify
