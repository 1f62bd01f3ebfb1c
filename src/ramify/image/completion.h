// SPDX-License-Identifier: GPL-3.0-or-later
// Filling a hole of a picture from the rest of it, without a person (paper 002 section 5.3 left this to ten minutes of
// interactive work; ALGORITHMS 6, PICTURES 12.1-1/2). Large patches of the picture are quilted over the hole and blended
// in the gradient domain. Nothing outside the hole changes.
#pragma once

#include "ramify/core/monitor.h"
#include "ramify/core/options.h"
#include "ramify/core/random.h"
#include "ramify/image/image.h"
#include "ramify/image/quilt.h"

namespace ramify {

struct CompletionOptions {
  QuiltOptions quilt;
  double tone_reach = 60.0;  // px; tones slower than this follow the hole's surroundings instead of the patches
};
std::vector<OptionField> describe(CompletionOptions& options);

struct Completion {
  ColorImage color;
  VectorImage source;  // in the hole: the photo pixel shown (px), NaN where it was filled smoothly; outside: itself
};

// hole: 255 = to be filled. forbidden: 255 = never copied from (empty = nothing but the hole itself); both of the
// picture's size. Throws InputError when nothing may be copied, std::invalid_argument when sizes differ.
Completion complete(const ColorImage& image, const Mask& hole, const Mask& forbidden, const CompletionOptions& options,
                    Rng rng, const Monitor& monitor);

// The quilt's picture: patches side by side, their steps spread out. `tone` is a slow picture (canvas size) that the
// result's tones slower than tone_reach px are drawn to; empty = keep the patches' own. Pixels without a patch are filled
// with a membrane. keep_edges leaves large steps as they are (water beside land), if the photo has such: right for wide
// holes, wrong for thin ones, whose patches are to follow what surrounds them.
ColorImage blend_quilt(const QuiltJob& job, const Quilt& quilt, const ColorImage& tone, double tone_reach,
                       bool keep_edges, const Monitor& monitor);

// The slow tones around a hole continued smoothly through it (sigma in px).
ColorImage tone_through_hole(const ColorImage& image, const Mask& hole, double sigma, const Monitor& monitor);

}  // namespace ramify
