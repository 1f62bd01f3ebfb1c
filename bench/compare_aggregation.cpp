// SPDX-License-Identifier: GPL-3.0-or-later
// compare_aggregation [RUNS]: diffusion-limited aggregation beside its imitation by planned paths (Xu & Mould 2007, figure
// 11: 500 x 500, 25000 walkers), in turn, RUNS times with a seed each (default 3). Prints median processor times, ratios, and
// both fractal dimensions. Walkers: naive (from any free node) and fair (from a launching circle, on a canvas with room).
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <ctime>

#include "ramify/growth/aggregation.h"
#include "ramify/recipe/planning.h"
#include "ramify/skeleton/statistics.h"

using namespace ramify;

namespace {

struct Rival {
  const char* name;
  std::vector<double> seconds{}, mass{}, box{};
  std::size_t nodes = 0;
};

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

template <class Grow>
void run(Rival& rival, const Grow& grow) {
  const std::clock_t start = std::clock();
  const Skeleton skeleton = grow();
  rival.seconds.push_back(static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC);
  rival.nodes = static_cast<std::size_t>(skeleton.count());
  std::vector<Vec2> points;
  for (const Node& node : skeleton.nodes()) points.push_back(node.xy());
  rival.mass.push_back(mass_radius_dimension(points, {skeleton.size.width / 2, skeleton.size.height / 2}));
  rival.box.push_back(box_dimension(skeleton));
}

// On the paper's canvas.
Skeleton imitate(std::uint64_t seed) {
  DendriteRequest request;
  request.size = "500x500";
  request.roots = "250,250";
  apply_preset(*find_preset(dendrite_presets(), "dla"), describe(request));
  return dendrite_skeleton(grow_dendrite(load_dendrite(request, seed, {}), request.grow, Rng(seed), {}), 1.0,
                           request.thickness);
}

Skeleton walk(std::uint64_t seed, WalkerLaunch launch, int side) {
  return aggregate_skeleton(grow_aggregate({side, side}, {25000, launch}, Rng(seed), {}), 0.5);
}

}  // namespace

int main(int argc, char** argv) {
  const int runs = argc > 1 ? std::max(1, std::atoi(argv[1])) : 3;
  Rival rivals[3] = {{"planned paths, 500 x 500"}, {"walkers from any free node, 500 x 500"}, {"walkers from a circle, 1001 x 1001"}};
  for (int i = 0; i < runs; ++i) {
    const auto seed = static_cast<std::uint64_t>(i + 1);
    run(rivals[0], [&] { return imitate(seed); });
    run(rivals[1], [&] { return walk(seed, WalkerLaunch::AnyNode, 500); });
    run(rivals[2], [&] { return walk(seed, WalkerLaunch::Circle, 1001); });
  }
  for (const Rival& r : rivals) {
    std::printf("%-40s %6zu nodes  %7.3f s   paths / this 1/%-6.1f  dimension by mass %.2f, by boxes %.2f\n", r.name, r.nodes, median(r.seconds),
                median(r.seconds) / median(rivals[0].seconds), median(r.mass), median(r.box));
  }
}
