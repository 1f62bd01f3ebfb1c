// SPDX-License-Identifier: GPL-3.0-or-later
// The one grey picture in which the branches stand out best (ALGORITHMS 3.3-1).
#pragma once

#include "ramify/core/monitor.h"
#include "ramify/exemplar/annotation.h"
#include "ramify/image/image.h"

namespace ramify {

enum class Channel { Auto, Luminance, GreenRed, BlueYellow, Red, Green, Blue, Principal1, Principal2 };

// Values about 0..1 (Lab axes scaled alike); the principal axes are those of the photo's own colours.
ScalarImage channel_picture(const ColorImage& photo, Channel channel);

struct ChannelChoice {
  Channel channel = Channel::Luminance;
  Polarity polarity = Polarity::Dark;
  double score = 0.0;
};

// Tries every channel and both polarities on a reduced picture. The score compares the ridge response of the strongest
// 3 % of the pixels with the median one. `channel` and `polarity`, where given, are kept. Bright lines in a photo whose
// strongest lines are nearly white count as glow.
ChannelChoice choose_channel(const ColorImage& photo, const Mask& excluded, double max_radius, Channel channel,
                             const Polarity* polarity, const Monitor& monitor = {});

// (picture - local mean) / (local standard deviation + its median): evens out slow changes of tone and contrast.
ScalarImage flattened(const ScalarImage& picture, double sigma);

}  // namespace ramify
