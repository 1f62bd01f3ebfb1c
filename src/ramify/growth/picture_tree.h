// SPDX-License-Identifier: GPL-3.0-or-later
// Painted trees, and pictures hidden in their twigs (Long & Mould 2009, section 5): a trunk by plain sums, then rounds of
// ever shorter and more gnarled branches; with a picture, the later rounds follow it on one side of the trunk.
#pragma once

#include <optional>
#include <vector>

#include "ramify/core/monitor.h"
#include "ramify/core/options.h"
#include "ramify/core/random.h"
#include "ramify/growth/dendrite.h"
#include "ramify/image/image.h"
#include "ramify/skeleton/skeleton.h"

namespace ramify {

// What makes a branch thick.
enum class TreeThickness {
  Rounds,      // the earlier its round, the thicker (section 5.1)
  Distance,    // the nearer to the trunk (section 5.2)
  Importance,  // the more the picture asks for it (section 5.2)
  Endpoints,   // the more ends it carries
};

struct PictureTreeOptions {
  int rounds = 3;              // 1 = trunk and limbs only
  int limbs = 5;               // endpoints of the first round beside the trunk's
  double trunk = 0.45;         // top of the trunk above the root, share of the canvas's height
  int twigs = 150;             // endpoints of the second round
  double branching = 4.0;      // every later round has so many times as many
  double reach = 0.22;         // how far the second round's ends lie from the tree, share of the canvas's height
  double shrink = 0.45;        // every later round's reach is so many times the one before
  double roughness = 10.0;     // random share of weights (paper 001's r)
  double gnarl = 1000.0;       // weight of the dearest edge against 1 for the sum, from the second round on
  double hidden = 0.5;         // where the picture rules, from the right: 0.5 = the right half; 1 = everywhere
  int hops = 120;              // ends lie at most so many edges from the tree; in the picture's part
  double random_share = 0.1;   // random ends in the picture's part, of the picture's
  double thin = 0.5, thick = 6.0;  // px, radii of the last twigs and of the trunk
  TreeThickness thickness = TreeThickness::Rounds;
};
std::vector<OptionField> describe(PictureTreeOptions& options);

struct PictureTree {
  Lattice lattice;             // of the last round
  Structure structure;
  Skeleton skeleton;
};

// importance: empty = a tree that hides nothing, on a canvas of `size`; else its size is the canvas. root: px, empty = the
// middle of the bottom. trunk: given = keep this structure's first round (stacked layers share their trunk) and grow the
// rest anew. Deterministic in (inputs, rng). Throws InputError when the root lies outside or the canvas is smaller than
// 16 x 16 px, OptionError for options out of range.
PictureTree grow_picture_tree(const ScalarImage& importance, Size size, std::optional<Vec2> root, const PictureTree* trunk,
                              const PictureTreeOptions& options, Rng rng, const Monitor& monitor);

}  // namespace ramify
