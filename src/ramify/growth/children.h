// SPDX-License-Identifier: GPL-3.0-or-later
// Children: which, where on the parent, and how they start (paper 002, section 4.3; PICTURES 12.2-4).
#pragma once

#include "ramify/growth/growth_state.h"

namespace ramify {

struct ChildPlan {
  int parent = 0;                 // branch
  int node = 0;                   // of the parent
  int source = 0;                 // template: a branch of the exemplar that is a child
  bool mirrored = false;
  std::optional<double> heading;  // rad; drawn when empty
  double most_length = 0.0;       // px; 0 = the template's
  double length_factor = 1.0;
};

// Starts and grows a child. Returns its number, or kNone when there is no room (then nothing has changed).
int place_child(GrowthState& state, const ChildPlan& plan, Rng& rng);

// The children a branch should have, as templates, longest first: its own template's, some swapped for similar ones.
// share: of the template's children that are wanted.
std::vector<int> list_children(const GrowthState& state, int branch, double share, Rng& rng);

// Tries to place one child with template `source` at the best places of the branch; kNone when none would do.
int settle_child(GrowthState& state, int branch, int source, Rng& rng);

// log Q of the branch around a node against the template's parent around its furcation, both sides (non-causal).
double junction_likeness(const GrowthState& state, const GrowingBranch& parent, int node, int source, bool mirrored);

// The branch's direction around a node, rad.
double tangent_at(const GrowingBranch& branch, int node);

// Where the branch's tree begins, px.
Vec2 tree_root(const GrowthState& state, int branch);

bool fork_blocked(const GrowthState& state, const GrowingBranch& branch, int node);

}  // namespace ramify
