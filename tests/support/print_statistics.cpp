// SPDX-License-Identifier: GPL-3.0-or-later
// print_statistics A.swc [B.swc]: the figures of A as JSON, and the distances from A to B, for comparison with numpy.
#include <cstdio>
#include <exception>

#include "ramify/core/json.h"
#include "ramify/skeleton/distribution.h"
#include "ramify/skeleton/edit.h"
#include "ramify/skeleton/skeleton_io.h"
#include "ramify/skeleton/statistics.h"

using namespace ramify;

namespace {

template <class Values>
Json list(const Values& values) {
  Json::Array items;
  for (const auto v : values) items.push_back(Json(v));
  return items;
}

}  // namespace

int main(int argc, char** argv) try {
  if (argc < 2) return 2;
  const Skeleton a = load_skeleton(argv[1]).skeleton;
  const SkeletonStatistics s = measure_statistics(a);
  const auto angles = pooled(s.bends.angles), radii = pooled(s.bends.radii);
  Json::Object out{{"step", s.bends.step}, {"length", s.bends.length}, {"total", s.total_length}, {"angles", list(angles)},
                   {"radii", list(radii)}, {"runs", static_cast<int>(s.bends.angles.size())}, {"furcations", s.furcations},
                   {"tips", s.tips}, {"box", s.box_dimension}, {"crossings", s.crossings}, {"heading", s.heading.strength},
                   {"direction", s.heading.direction}, {"strahler", list(strahler_orders(a))},
                   {"tortuosity90", quantile(s.tortuosity, 0.9)}};
  if (argc > 2) {
    const SkeletonStatistics t = measure_statistics(load_skeleton(argv[2]).skeleton, s.bends.step);
    const auto others = pooled(t.bends.angles);
    const HistogramPair pair = make_histograms(angles, others);
    out.push_back({"tv", total_variation(pair.first, pair.second)});
    out.push_back({"js", jensen_shannon(pair.first, pair.second)});
    out.push_back({"emd", earth_movers_distance(angles, others)});
  }
  std::fputs(json_text(out).c_str(), stdout);
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
