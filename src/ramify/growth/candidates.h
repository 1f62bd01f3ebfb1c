// SPDX-License-Identifier: GPL-3.0-or-later
// Which stretches of the exemplar may continue a branch, best first.
#pragma once

#include "ramify/growth/growth_state.h"

namespace ramify {

struct Candidate {
  int vertex = 0;         // of the exemplar: the window's last; what follows it is appended
  bool mirrored = false;
  double rotation = 0.0;  // rad, added to the first turn
  double score = 0.0;     // log
};

// What a step aims at.
struct StepAim {
  int count = 0;                     // vertices to append
  bool guided = false;
  std::optional<Vec2> toward;        // px, a place to go to: on the guide, or a branch to join
  double pull = 0.0;                 // how strongly
};

// The `most` best windows by shape, intended heading, remaining length, reuse and histogram, no two of them neighbours in
// the exemplar; best first.
std::vector<Candidate> find_candidates(const GrowthState& state, int number, const StepAim& aim, int most);

// The points a candidate would append: radii from the template, cut where the branch leaves the canvas.
Extension extend_by(const GrowthState& state, int number, const Candidate& candidate, int count);

// Ends an extension whose last point has left: straight on until its whole width is off the canvas. direction in rad.
void leave_frame(const Ground& ground, double direction, double step, Extension& extension);

// The direction the branch's chord from node `from` to `arc_ahead` px beyond its tip should have, if one is intended; rad.
std::optional<double> intended_direction(const GrowthState& state, const GrowingBranch& branch, int from, double arc_ahead);

}  // namespace ramify
