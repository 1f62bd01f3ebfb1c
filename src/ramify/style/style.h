// SPDX-License-Identifier: GPL-3.0-or-later
// How one exemplar's branches bend, taper and fork, learnt from its skeleton alone (paper 002, section 4). A style never
// sees a pixel. It is scale-free (lengths in units of the exemplar's step h, which is kept) and saves as JSON.
#pragma once

#include <string>

#include "ramify/core/monitor.h"
#include "ramify/core/options.h"
#include "ramify/skeleton/skeleton.h"
#include "ramify/style/bending.h"
#include "ramify/style/furcation.h"
#include "ramify/style/hierarchy.h"

namespace ramify {

struct LearnStyleOptions {
  double feature_size = 0.0;  // px, size of a typical bend; 0 = measured (PICTURES 12.2-1)
  bool mirror = true;         // learn every bend also mirrored
  bool paper_exact = false;   // ALGORITHMS 17
};
std::vector<OptionField> describe(LearnStyleOptions& options);

struct Style {
  double step = 1.0;          // h, px of the exemplar
  double feature_size = 8.0;  // s, px
  double unit_radius = 1.0;   // px, mean radius of the exemplar
  Size exemplar_size;         // px
  BendingModel bending;
  FurcationModel furcation;
  Hierarchy hierarchy;        // roots, template branches, orders, headings, lengths, tips, spacing
};

// Throws InputError when the skeleton is too small to learn from (it says how much is needed).
Style learn_style(const Skeleton& exemplar, const LearnStyleOptions& options, const Monitor& monitor);

std::string style_text(const Style& style);  // JSON
Style parse_style(const std::string& json, const std::string& name);

}  // namespace ramify
