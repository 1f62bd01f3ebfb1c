// SPDX-License-Identifier: GPL-3.0-or-later
#include "ramify/graph/metric.h"

namespace ramify {

std::vector<OptionField> describe(MetricOptions& o) {
  return {
      choice("metric", o.metric, {"sum", "partial", "full", "power", "mix"}, "How the costs of edges make the cost of a path."),
      number("power", o.power, 1.0, 64.0, "", "Exponent of metric power: 1 gives sum, large ones come near full."),
      number("peak-share", o.peak_share, 0.0, 1e6, "", "Metric mix: factor of the dearest edge on the path."),
      number("sum-share", o.sum_share, 1e-3, 1e6, "", "Metric mix: factor of the sum over the path."),
  };
}

}  // namespace ramify
