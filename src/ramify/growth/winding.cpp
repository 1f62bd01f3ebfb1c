// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/growth/winding.h"

#include <algorithm>

namespace ramify {

WindingBound::WindingBound(const Hierarchy& learnt, const GrowingBranch& branch)
    : learnt_(learnt), least_{0.0}, most_{0.0} {
  const int longest = learnt.lags.empty() ? 0 : learnt.lags.back();
  double wound = 0.0;
  for (int node = branch.count() - 2; node > 0 && static_cast<int>(least_.size()) <= longest; --node) {
    wound += branch.turns[static_cast<std::size_t>(node)];
    least_.push_back(std::min(least_.back(), wound));
    most_.push_back(std::max(most_.back(), wound));
  }
}

bool WindingBound::exceeded_by(const Extension& extension) const {
  constexpr double kSlack = 1e-9;  // rad: what is copied adds up in another order
  for (std::size_t l = 0; l < learnt_.lags.size(); ++l) {
    const std::size_t lag = static_cast<std::size_t>(learnt_.lags[l]);
    const double allowed = learnt_.lag_winding[l] + kSlack;
    double wound = 0.0, low = 0.0, high = 0.0;  // since the tip: now, and what came before of it
    for (std::size_t k = 0; k < extension.turns.size() && k < lag; ++k) {
      wound += extension.turns[k];
      if (wound - low > allowed || high - wound > allowed) return true;
      const std::size_t back = std::min(lag - 1 - k, least_.size() - 1);
      if (wound + most_[back] > allowed || wound + least_[back] < -allowed) return true;
      low = std::min(low, wound);
      high = std::max(high, wound);
    }
  }
  return false;
}

}  // namespace ramify
