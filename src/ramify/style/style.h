// SPDX-License-Identifier: GPL-3.0-or-later
// How one exemplar's branches bend, taper and fork, learnt from its skeleton alone (paper 002, section 4). A style never
// sees a pixel. Its lengths are px of the exemplar; it saves as JSON.
#pragma once

#include <string>
#include <vector>

#include "ramify/core/monitor.h"
#include "ramify/core/options.h"
#include "ramify/skeleton/skeleton.h"
#include "ramify/style/bending.h"
#include "ramify/style/furcation.h"
#include "ramify/style/hierarchy.h"

namespace ramify {

struct LearnStyleOptions {
  double feature_size = 0.0;       // px, size of a typical bend; 0 = measured (PICTURES 12.2-1)
  int extension = 8;               // m, vertices per extension; the step is feature_size / m
  int history = 0;                 // k, vertices compared beside the tip; 0 = 3 m, the paper's rule
  bool mirror = true;              // learn every bend also mirrored
  bool signed_angles = false;      // furcations learn signed turning angles, as the paper
  bool platt_probabilities = false;  // furcation probabilities from five random folds, as the paper's libsvm
  bool paper_exact = false;        // both of these (ALGORITHMS 17)
};
std::vector<OptionField> describe(LearnStyleOptions& options);

struct Style {
  double step = 1.0;          // h, px of the exemplar
  double feature_size = 8.0;  // s, px
  double unit_radius = 1.0;   // px, mean radius of the exemplar
  bool mirror = true;         // bends may be used mirrored
  Size exemplar_size;         // px
  BendingModel bending;
  FurcationModel furcation;
  Hierarchy hierarchy;        // roots, template branches, orders, headings, lengths, tips, spacing
};

// places: one for every node; empty = all on the ground. Throws InputError when the skeleton is too small to learn from
// (it says how much is needed).
Style learn_style(const Skeleton& exemplar, const LearnStyleOptions& options, const Monitor& monitor,
                  const std::vector<NodePlace>& places = {});

// JSON. parse_style(style_text(s), name) equals s exactly, and throws InputError naming the path of what is wrong.
std::string style_text(const Style& style);
Style parse_style(const std::string& json, const std::string& name);

}  // namespace ramify
