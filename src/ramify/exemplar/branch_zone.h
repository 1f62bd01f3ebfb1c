// SPDX-License-Identifier: GPL-3.0-or-later
// The pixels near a skeleton's branches, as masks: the skeleton's body with other radii.
#pragma once

#include <functional>

#include "ramify/image/image.h"
#include "ramify/skeleton/skeleton.h"

namespace ramify {

// 255 where a pixel's centre lies in the skeleton's body when every radius r (px) is replaced by reach(r) (px, at least
// 0.1): what lies within reach(r) of a branch.
Mask branch_zone(const Skeleton& skeleton, Size size, const std::function<double(double)>& reach);

}  // namespace ramify
