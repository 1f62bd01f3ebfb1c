// SPDX-License-Identifier: GPL-3.0-or-later
// Where in a photo branches live, and what in it must not be taken for background (PICTURES 5, 12.1-7/9, 12.3-2). Users
// give only a skeleton: the black surround of an eye photo, the paper around a leaf, the sea beside mountains, clouds,
// town lights and the many branches nobody annotated are found here.
#pragma once

#include <vector>

#include "ramify/core/monitor.h"
#include "ramify/core/options.h"
#include "ramify/core/random.h"
#include "ramify/exemplar/exemplar.h"

namespace ramify {

struct HabitatOptions {
  bool automatic = true;          // false: only the annotation's regions say what is outside
  int classes = 5;                // kinds of ground looked for
  double outside_density = 0.1;   // a kind with less skeleton than this share of the mean is not lived on
  double outside_area = 0.02;     // … if it covers more than this share of the photo
  double texture_share = 0.12;    // more ridges off the skeleton than this share of the ground are its texture
};
std::vector<OptionField> describe(HabitatOptions& options);

struct Habitat {
  Image<std::uint8_t> role;  // RegionRole of every pixel: the annotation's, and Outside where it was found
  Mask outside;              // 255: growth leaves it like the frame, nothing is copied across its border
  Mask outliers;             // 255: clouds, lights, dust, and ignored regions: never copied into texture
  Mask shadow;               // 255: branch-like ridges off the skeleton; none where they are parts of wider things
  Mask own;                  // 255: colours that belong to branches, on and off them (Apron)
  double apron = 0.0;        // px beside branches that these reach (Apron)
  double shadow_share = 0.0; // of the ground off the branches
  bool shadow_is_texture = false;  // then `shadow` may be copied and stays in the plate
};

Habitat find_habitat(const Exemplar& exemplar, const HabitatOptions& options, Rng rng, const Monitor& monitor);

// The steps, each of use by itself.
Mask find_outside(const ColorImage& photo, const Skeleton& skeleton, const HabitatOptions& options, Rng rng,
                  const Monitor& monitor);
// Blobs off the branches and what lies right beside them, and blobs within branches more than 16 px wide (clouds over
// water).
Mask find_outliers(const ColorImage& photo, const Mask& branches, const Mask& beside, const Mask& outside);
Mask find_shadow(const ColorImage& photo, Polarity polarity, const Mask& branches, const Mask& outside);
// Share of these lines that lie in wide things of the branches' own colours (ribs of a snowy mountain): such cannot be
// lifted by themselves, because a ragged rest of the mountain would stay.
double embedded_share(const Mask& lines, const Mask& own, const Mask& branches);

}  // namespace ramify
