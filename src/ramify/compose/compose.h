// SPDX-License-Identifier: GPL-3.0-or-later
// Dresses a skeleton with fragments of a photo (paper 002, section 5; PICTURES 3 to 7, 12.1, 12.3).
#pragma once

#include <string>
#include <vector>

#include "ramify/core/monitor.h"
#include "ramify/core/options.h"
#include "ramify/core/random.h"
#include "ramify/exemplar/exemplar.h"
#include "ramify/image/image.h"
#include "ramify/skeleton/skeleton.h"

namespace ramify {

enum class CompositeMode { Auto, Paste, Emit, Absorb };
enum class BackgroundMode { Auto, Keep, Vary, New };

struct ComposeOptions {
  CompositeMode composite = CompositeMode::Auto;
  BackgroundMode background = BackgroundMode::Auto;
  double fragment_radius_factor = 3.0;  // disc radius in units of the branch radius (before the clamp of PICTURES 4)
  double leave_out = 0.0;               // px; sources nearer than this to their own place are banned (a test's tool)
  bool paper_exact = false;
};
std::vector<OptionField> describe(ComposeOptions& options);

// Where a pixel of the result comes from.
enum class Origin : std::uint8_t { Background, Fragment, Completion };

struct Composite {
  ColorImage color;                 // sRGB
  ColorImage plate;                 // the background that was used, without branches
  LabelImage owner;                 // fragment index of every pixel, kNone for background
  Image<Eigen::Vector2f> source;    // photo pixel every pixel was taken from (px), NaN where there is none
  CompositeMode composite = CompositeMode::Paste;     // what Auto chose
  BackgroundMode background = BackgroundMode::Keep;
  struct DebugImage { std::string name; ColorImage image; };
  std::vector<DebugImage> debug;    // intermediates, filled only when asked for
};

// Throws InputError when the exemplar offers no fragment for the skeleton.
Composite compose_image(const Exemplar& exemplar, const Skeleton& skeleton, const ComposeOptions& options, Rng rng,
                        const Monitor& monitor);

}  // namespace ramify
