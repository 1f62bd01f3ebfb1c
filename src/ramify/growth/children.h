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
  double width_factor = 1.0;      // of the radius the template would have here
  int followed = kNone;           // a course to follow instead of a heading
  bool spur = false;              // it may end in the open even in a net
};

// Starts and grows a child. Returns its number, or kNone when there is no room (then nothing has changed).
int place_child(GrowthState& state, const ChildPlan& plan, Rng& rng);

struct WantedChild {
  int source = 0;      // template
  double place = 0.5;  // 0..1 along the parent, where the exemplar's branch has it
  double spread = 0.2; // of the parent's length, about the place
  int side = 1;        // the side it leaves to in the exemplar: +1 clockwise, -1
  bool spur = false;   // it may end in the open even in a net
};

// The children a branch should have, as templates, longest first: its own template's, some swapped for similar ones.
// share: of the template's children that are wanted.
std::vector<WantedChild> list_children(const GrowthState& state, int branch, double share, Rng& rng);

// Tries to place one child at the best places of the branch; kNone when none would do.
int settle_child(GrowthState& state, int branch, const WantedChild& wanted, Rng& rng);

// One child at the vertex of the highest furcation probability that is free, with the template that fits there best
// (paper 002, section 4.3); kNone when none of the best vertices has room.
int fork_at_likeliest(GrowthState& state, int branch, Rng& rng);

// log Q of the branch around a node against the template's parent around its furcation, both sides (non-causal).
double junction_likeness(const GrowthState& state, const GrowingBranch& parent, int node, int source, bool mirrored);

// The branch's direction around a node, rad.
double tangent_at(const GrowingBranch& branch, int node);

// Where the branch's tree begins, px.
Vec2 tree_root(const GrowthState& state, int branch);

// Whether another child stands too near for one that leaves to `side` (+1, -1, or 0 = any).
bool fork_blocked(const GrowthState& state, const GrowingBranch& branch, int node, int side);

}  // namespace ramify
