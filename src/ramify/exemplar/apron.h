// SPDX-License-Identifier: GPL-3.0-or-later
// What in a photo belongs to its branches though the annotation leaves it out: the snow below a crest and its shaded
// side, the twigs of a limb. Found by colour alone: colours at least as common on branches as off them, and rare away
// from all of them.
#pragma once

#include "ramify/exemplar/exemplar.h"

namespace ramify {

struct Apron {
  Mask own;            // 255: a colour met beside branches several times as often as away from them
  double reach = 0.0;  // px beyond the annotated edge that such colours reach; 0 where they are rare beside branches
};

// outside: 255 where the photo is no habitat. `own` is empty of pixels where the photo has too little ground away from
// branches to compare with.
Apron measure_apron(const Exemplar& exemplar, const Mask& outside);

}  // namespace ramify
