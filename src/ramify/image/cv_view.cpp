// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/image/cv_view.h"

#include <opencv2/core/utility.hpp>

namespace ramify {

void settle_opencv() {
  static const bool settled = [] {
    cv::setNumThreads(1);
    cv::setUseOptimized(false);
    return true;
  }();
  static_cast<void>(settled);
}

}  // namespace ramify
